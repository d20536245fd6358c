// Words with what they mean: by colour, by the kind of line under them, and by a label.

import {make} from "./make.js";

/** Kinds of meaning, as executor/word_kinds.py has them: what each is called here. */
export const KINDS = {
  action: "action", colour: "colour", shape: "shape", size: "size", place: "place", which: "which", it: "it",
  function: "no meaning", unsure: "unsure", unknown: "unknown",
};

export function wordElement({text, kind, meaning = ""}) {
  const label = make("small", {}, KINDS[kind] ?? kind);
  return make("span", {className: "word", data: {kind}, dir: "auto", title: meaning}, make("b", {}, text), label);
}

/** The words that are being typed, as each is known by itself. */
export function typedWords(text, known) {
  const words = text.toLowerCase().match(/[\p{L}\p{N}\p{M}'’-]+/gu) ?? [];
  return words.map((word) => ({text: word, kind: known[word]?.[0] ?? "unknown"}));
}

export function legend() {
  return make("ul", {className: "kinds", aria: {label: "Kinds of meaning"}}, ...Object.entries(KINDS).map(([kind, name]) =>
    make("li", {}, make("span", {className: "word", data: {kind}}, make("b", {}, name)))));
}
