// What sticks, buttons and keys are called on the page.

import {AXES} from "./gamepad.js";

const KEYS_SHOWN = {" ": "Space", space: "Space", arrowup: "↑", arrowdown: "↓", arrowleft: "←", arrowright: "→",
  enter: "Enter", escape: "Esc", backspace: "⌫"};
const CONTROLS_SHOWN = {left_x: "left stick ↔", left_y: "left stick ↕", right_x: "right stick ↔",
  right_y: "right stick ↕", left_trigger: "LT", right_trigger: "RT", left_bumper: "LB", right_bumper: "RB",
  left_stick: "press left stick", right_stick: "press right stick", up: "D-pad ↑", down: "D-pad ↓",
  left: "D-pad ←", right: "D-pad →", a: "A", b: "B", x: "X", y: "Y", back: "Back", start: "Start", guide: "Guide"};

/** Controls of a gamepad as people call them. */
export function shownControls(text) {
  return text.split("|").map((part) => part.trim().replace(/^-/, "").split(/\s*[+-]\s*/).map(
    (each) => CONTROLS_SHOWN[each.trim()] ?? each.trim()).join(part.includes("-") ? ", " : " + ")).join(" or ");
}

/** Keys that play any of the controls of an action; a chord needs a key that plays the whole of it. */
export function keysFor(controls, keys) {
  const wanted = controls.split("|").flatMap((each) => {
    const names = each.match(/[a-z_]+/g) ?? [];
    return names.some((name) => AXES.includes(name)) || each.includes("-") ? names : [names.join("+")];
  });
  const found = Object.entries(keys).filter(([, plays]) => {
    const names = (plays.match(/[a-z_]+/g) ?? []).join("+");
    return wanted.includes(names);
  });
  return found.map(([key]) => KEYS_SHOWN[key] ?? key.toUpperCase()).join(" ");
}
