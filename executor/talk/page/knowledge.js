// What was learned, to be looked through.

import {make, rebuild, setText} from "./make.js";
import {legend} from "./words.js";

export class KnowledgeCard {
  /** @param {HTMLElement} element  the card */
  constructor(element) {
    this.summary = make("p", {}, "Nothing yet.");
    this.open = make("button", {type: "button", id: "look", disabled: true, on: {click: () => this.dialog.showModal()}},
      "Look through");
    this.tabs = make("div", {className: "tabs", role: "tablist", aria: {label: "Parts of what was learned"}});
    this.body = make("div", {className: "learned", id: "learned", role: "tabpanel", tabIndex: 0});
    this.dialog = make("dialog", {id: "knowledge", aria: {labelledby: "title-knowledge"}},
      make("div", {className: "row"}, make("h2", {id: "title-knowledge"}, "What was learned"),
        make("button", {type: "button", id: "close-knowledge", on: {click: () => this.dialog.close()}}, "Close")),
      this.tabs, this.body);
    this.dialog.addEventListener("keydown", (event) => event.stopPropagation()); // keys here drive nothing
    this.tabs.addEventListener("keydown", (event) => this.step(event));
    element.append(make("h2", {id: "title-learned"}, "Knowledge"),
      make("div", {className: "row"}, this.summary, this.open), legend());
    element.hidden = false;
    document.body.append(this.dialog);
    this.sections = [];
    this.chosen = "words";
  }

  show({demos, sentences, concepts, actions, sections}) {
    const many = (count, name) => `${count} ${name}${count === 1 ? "" : "s"}`;
    setText(this.summary, [many(demos, "demo"), many(sentences, "sentence"), many(concepts, "concept"),
      many(actions, "action")].join(", "));
    this.open.disabled = false;
    this.sections = sections;
    if (!sections.some(({name}) => name === this.chosen)) this.chosen = "words";
    this.choose(this.chosen);
  }

  choose(chosen) {
    this.chosen = chosen;
    rebuild(this.tabs, [this.sections.map(({name}) => name), chosen], () => this.sections.map(({name, title}) => make(
      "button", {type: "button", role: "tab", id: `tab-${name}`, tabIndex: name === chosen ? 0 : -1,
        aria: {selected: String(name === chosen), controls: "learned"}, on: {click: () => this.choose(name)}}, title)));
    this.body.setAttribute("aria-labelledby", `tab-${chosen}`);
    // Written by the server out of escaped words and drawings of its own; the page's policy lets no script in it run.
    this.body.innerHTML = this.sections.find(({name}) => name === chosen)?.html ?? "";
    this.body.scrollTop = 0;
  }

  step(event) {
    const by = {ArrowRight: 1, ArrowLeft: -1}[event.key];
    if (!by) return;
    const names = this.sections.map(({name}) => name);
    this.choose(names[(names.indexOf(this.chosen) + by + names.length) % names.length]);
    this.tabs.querySelector("[aria-selected=true]").focus();
    event.preventDefault();
  }
}
