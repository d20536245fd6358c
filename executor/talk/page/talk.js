// Telling and doing, beside driving and recording: the guide, the command line, rings in the picture, knowledge.

import {CommandLine} from "./command.js";
import {Guide, stepNow} from "./guide.js";
import {KnowledgeCard} from "./knowledge.js";
import {make, setText} from "./make.js";
import {Overlay} from "./overlay.js";

const FEW = 5; // demos, before which words are mostly guessed
const MORE = " More demos, with other things and places, tell what each word means.";
const byId = (name) => document.getElementById(name);

export class Talk {
  /** @param {{send: (message: object) => void, stage: object, state: object}} page  the page that drives */
  constructor({send, stage, state}) {
    document.head.append(make("link", {rel: "stylesheet", href: "talk.css"}));
    this.send = send;
    this.page = state;
    this.talk = null;
    this.knowledge = null;
    this.guide = new Guide(byId("guide"));
    this.overlay = new Overlay(byId("marks"), stage);
    this.card = new KnowledgeCard(byId("learned-card"));
    this.line = new CommandLine(byId("dock"), {
      say: (action, more = {}) => send({type: "talk", action, ...more}),
      show: (sentence) => {
        send({type: "do", action: "describe", text: sentence});
        send({type: "do", action: "record"});
        byId("view").focus({preventScroll: true});
      },
      stop: () => send({type: "stop"}),
      release: () => send({type: "release"}),
      end: () => send({type: "do", action: "stop"}),
      learn: () => this.learnThis(),
      take: () => send({type: "control", action: "take"}),
    });
    this.learn = make("button", {type: "button", id: "learn", className: "primary", hidden: true,
      on: {click: () => this.learnThis()}}, "Keep and learn");
    byId("keep").before(this.learn);
    byId("keep").classList.remove("primary");
    setText(byId("keep"), "Only keep");
    this.again = make("button", {type: "button", id: "learn-demo", on: {click: () => send({type: "talk", action: "learn",
      demo: byId("demos").value})}}, "Learn it");
    byId("replay").after(this.again);
    addEventListener("keydown", (event) => {
      const typing = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName);
      if (event.key !== "/" || typing || byId("knowledge").open) return;
      this.line.input.focus();
      event.preventDefault();
    });
    this.show();
  }

  hear(message) {
    if (message.type === "knowledge") {
      this.knowledge = message;
      this.line.known = message.words;
      this.card.show(message);
    } else {
      this.talk = message;
      this.overlay.show(message.marks);
      this.line.hear(message);
    }
    this.show();
  }

  /** Take where the marks are in the picture. */
  place(places) {
    this.overlay.place(places);
  }

  /** What stands in the sentence's line is told first, so that one click does for both. */
  learnThis() {
    const sentence = byId("sentence");
    if (sentence.value.trim()) this.send({type: "do", action: "describe", text: sentence.value.trim()});
    sentence.value = "";
    this.send({type: "talk", action: "learn"});
  }

  show() {
    const {status, yours} = this.page;
    if (!status) return;
    const {deck, lent} = status;
    const {talk} = this;
    const review = deck.mode === "review" && !lent;
    this.learn.hidden = !review;
    this.learn.disabled = !yours || Boolean(talk?.learning);
    this.again.disabled = !yours || deck.mode !== "idle" || Boolean(lent || talk?.learning) || !byId("demos").options.length;
    this.line.show(yours, deck.mode !== "idle" || Boolean(lent), status.stopped, deck.mode);
    this.guide.show(stepNow({mode: deck.mode, said: deck.sentences || byId("sentence").value.trim(),
      learning: talk?.learning, knows: this.knowledge?.demos, talk}));
    const {learning, lesson} = talk ?? {};
    const said = learning ? `Learning ${learning} …` : !lesson ? "" : lesson.error ? `Not learned: ${lesson.error}` :
      lesson.before ? `${lesson.demo} was learned before: it counts once.` :
      `${lesson.demo} is learned. Now type a command below the picture.${this.knowledge?.demos < FEW ? MORE : ""}`;
    byId("lesson").hidden = !said;
    byId("lesson").dataset.tone = learning ? "busy" : lesson?.error ? "bad" : lesson ? "good" : "";
    setText(byId("lesson"), said);
  }
}
