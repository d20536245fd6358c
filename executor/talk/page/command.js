// The line in which commands are typed, and the answer to them.

import {make, rebuild, setText} from "./make.js";
import {typedWords, wordElement} from "./words.js";

const TITLES = {
  done: "Done", failed: "That did not work", uncertain: "I cannot tell whether it worked", stopped: "Stopped",
  planned: "I would do this", refused: "I do not understand", ambiguous: "Which one?", "unknown-word": "New to me",
  impossible: "I cannot do that here", undone: "Undone",
};
const WAITS_MS = 5000; // what was said too early and could not be heard for so long is forgotten
const TONES = {done: "good", planned: "plain", undone: "plain", ambiguous: "ask", "unknown-word": "ask"};

/** Give an element these buttons; those that stay are left in place, so that a click under way is not lost. */
function arrange(element, wanted) {
  const there = new Map([...element.children].map((button) => [button.id, button]));
  const names = wanted.map(([id]) => id);
  for (const [id, button] of there) if (!names.includes(id)) button.remove();
  wanted.forEach(([id, text, does, enabled, className = ""], i) => {
    const button = there.get(id) ?? make("button", {type: "button", id});
    setText(button, text);
    Object.assign(button, {className, disabled: !enabled, onclick: does});
    if (element.children[i] !== button) element.insertBefore(button, element.children[i] ?? null);
  });
}

export class CommandLine {
  /** @param {{say: (action: string, more?: object) => void, show: (sentence: string) => void, stop: () => void,
   *           release: () => void, end: () => void, learn: () => void, take: () => void}} does  what the line asks for */
  constructor(element, does) {
    this.does = does;
    this.known = {};
    this.talk = null;
    this.free = false;
    this.waiting = ""; // what was said too early
    this.input = make("input", {type: "text", id: "command", maxLength: 500, autocomplete: "off", dir: "auto",
      placeholder: "say it as you would to a person"});
    this.go = make("button", {type: "submit", id: "go", className: "primary"}, "Show plan");
    this.at_once = make("input", {type: "checkbox", id: "at-once"});
    this.said = make("div", {className: "said", id: "said", role: "group", hidden: true,
      aria: {label: "The words, with what they mean"}});
    this.answer = make("div", {className: "answer", id: "answer", role: "status", aria: {live: "polite"}, hidden: true});
    this.acts = make("div", {className: "buttons acts", id: "acts"});
    this.plan = make("ol", {className: "plan", id: "plan", tabIndex: 0, aria: {label: "Plan"}, hidden: true});
    const form = make("form", {className: "inline", id: "command-form"},
      make("label", {className: "grow"}, make("span", {className: "label", id: "title-dock"}, "Tell the robot what to do",
        make("kbd", {className: "key", title: "This key goes here"}, "/")), this.input),
      make("label", {className: "check"}, this.at_once, make("span", {}, "at once")), this.go);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.submit();
    });
    this.input.addEventListener("input", () => this.showWords());
    element.append(form, this.said, make("div", {className: "outcome"},
      make("div", {className: "told"}, this.answer, this.acts), this.plan));
    element.hidden = false;
  }

  get text() {
    return this.input.value.trim().replace(/\s+/g, " ");
  }

  /** Whether the plan that is shown is that of what stands in the line. */
  get planned() {
    return this.talk?.answer?.kind === "planned" && this.talk.sentence === this.text;
  }

  submit() {
    if (!this.text) return;
    if (!this.yours) this.does.take(); // it was lost as the page was silent, or never held; where another holds it, that is told
    if (!this.free) { // what is said a moment too early is heard as soon as it can be; not while the arm moves
      this.waiting = this.talk?.phase === "moving" ? "" : this.text;
      this.since = performance.now();
      return;
    }
    this.waiting = "";
    const does = this.planned || this.at_once.checked;
    this.does.say(does ? "do" : "read", {text: this.text, choice: this.planned ? this.talk.choice : null});
  }

  hear(talk) {
    this.talk = talk;
    this.show();
  }

  show(yours = this.yours, busy = this.busy, stopped = this.stopped, mode = this.mode) {
    Object.assign(this, {yours, busy, stopped, mode});
    const {talk} = this;
    if (!talk) return;
    const free = yours && !busy && talk.phase === "idle";
    this.free = free;
    this.go.setAttribute("aria-disabled", String(!free)); // a button that is disabled would swallow an early Enter
    setText(this.go, this.planned || this.at_once.checked ? "Do it" : "Show plan");
    this.showWords();
    this.showAnswer(free);
    this.showPlan();
    if (free && this.waiting) {
      if (this.waiting === this.text && performance.now() - this.since < WAITS_MS) this.submit();
      this.waiting = "";
    }
  }

  showWords() {
    const own = this.talk?.words.length && (this.talk.sentence === this.text || !this.text);
    const words = own ? this.talk.words : typedWords(this.text, this.known);
    rebuild(this.said, words, () => words.map(wordElement));
    this.said.hidden = !words.length;
    setText(this.go, this.planned || this.at_once.checked ? "Do it" : "Show plan");
  }

  showAnswer(free) {
    const {phase, answer, sentence, undo} = this.talk;
    const waits = {thinking: ["Looking and thinking", ""], moving: ["Doing it", `“${sentence}”`]}[phase];
    const note = answer?.note ? `${answer.note}. ` : "";
    const told = answer?.kind === "planned" ? `${note}Enter, or “Do it”, has it done.` : answer?.text;
    const [title, text] = waits ?? (answer ? [TITLES[answer.kind] ?? answer.kind, told] : ["", ""]);
    this.answer.hidden = !title;
    this.answer.dataset.tone = waits ? "busy" : TONES[answer?.kind] ?? "bad";
    this.answer.dataset.kind = waits ? phase : answer?.kind ?? "";
    rebuild(this.answer, [title, text], () => [make("strong", {}, title), make("span", {}, text)]);
    arrange(this.acts, this.buttons(phase, answer ?? {}, sentence, undo, free));
  }

  /** What can be done now: id, text, what it does, whether it can be pressed, class. */
  buttons(phase, answer, sentence, undo, free) {
    const found = [];
    if (phase === "moving") found.push(["halt", "Stop", () => this.does.stop(), true, "danger"]);
    if (phase !== "idle") return found;
    // Where the page is narrow, the card with these buttons is far below the picture.
    if (this.mode === "recording") found.push(["end-here", "End the recording", () => this.does.end(), this.yours, "primary narrow"]);
    if (this.mode === "review") {
      found.push(["learn-here", "Keep and learn", () => this.does.learn(), this.yours && !this.talk.learning, "primary narrow"]);
    }
    (answer.options ?? []).forEach(([thing, name], i) => found.push([`option-${i + 1}`, `${i + 1}. ${name}`,
      () => this.does.say(this.at_once.checked ? "do" : "read", {text: sentence, choice: thing}), free]));
    (answer.spellings ?? []).forEach(([word, meant], i) => found.push([`spelling-${i + 1}`, `“${word}”`, () => {
      this.input.value = meant;
      this.does.say(this.at_once.checked ? "do" : "read", {text: meant, choice: null});
    }, free]));
    if (answer.kind === "unknown-word") {
      found.push(["show-it", "Show it what you mean", () => this.does.show(sentence), free, "record"]);
    }
    if (answer.can_be_wrong) found.push(["wrong", "That was wrong", () => this.does.say("wrong"), free]);
    if (undo) found.push(["undo", "Undo", () => this.does.say("undo"), free]);
    // It goes when it is pressed: as the last one, so that no other comes under the mouse.
    if (this.stopped) found.push(["go-on", "Release the stop", () => this.does.release(), this.yours]);
    return found;
  }

  showPlan() {
    const {plan, done, phase, answer} = this.talk;
    this.plan.hidden = !plan.length;
    const now = phase === "moving" ? done - 1 : answer?.kind === "done" ? plan.length : phase === "idle" && answer?.kind !==
      "planned" ? done - 1 : -1;
    rebuild(this.plan, [plan, now], () => plan.map(({text, heading}, i) => make("li", {className: heading ? "heading" : "",
      data: {state: i < now ? "past" : i === now ? "now" : "next"}}, text)));
    const item = this.plan.children[now];
    if (item) this.plan.scrollTop = item.offsetTop - this.plan.clientHeight / 2;
    else if (now < 0) this.plan.scrollTop = 0;
  }
}
