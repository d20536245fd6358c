// Gamepad, keys and sticks on the screen, all as one W3C standard gamepad: four axes, seventeen buttons.

import {Alive} from "./alive.js";

export const AXES = ["left_x", "left_y", "right_x", "right_y"];
export const BUTTONS = ["a", "b", "x", "y", "left_bumper", "right_bumper", "left_trigger", "right_trigger", "back",
  "start", "left_stick", "right_stick", "up", "down", "left", "right", "guide"];
const BROKEN = 99; // JSON has no NaN
const KEEP_MS = 16; // an unchanged state is said again this often, so that its end is noticed

/** Read "-left_y", "back + up" or "0.5 * right_x" into [control, factor] pairs. */
export function parseSum(text) {
  const terms = [];
  for (const [, sign, factor, name] of text.matchAll(/([+-]?)\s*(?:([\d.]+)\s*\*\s*)?([a-z_]+)/g)) {
    terms.push([name, (sign === "-" ? -1 : 1) * (factor ? Number(factor) : 1)]);
  }
  return terms;
}

/** Name a key as mapping files do. */
export function keyName(event) {
  return event.key === " " ? "space" : event.key.toLowerCase();
}

/** What is pressed now, from all sources. */
export class Operator {
  /**
   * @param {(state: {axes: number[], buttons: number[], at: number, silence: number}) => void} send
   *   is given every change at once, and what did not change 60 times a second.
   */
  constructor(send) {
    this.send = send;
    this.keys = new Map();
    this.slow = 0.4;
    this.held = new Map(); // by physical key, so that a shift in between releases what was pressed
    this.shift = false;
    this.touch = new Map();
    this.pad = "";
    this.last = "";
    this.sent = 0;
    this.since = 0;
    this.alive = new Alive();
    this.worker = new Worker("ticker.js");
    this.worker.onmessage = () => this.tick();
  }

  setKeys(keys, slow) {
    this.keys = new Map(Object.entries(keys).map(([key, text]) => [key, parseSum(text)]));
    this.slow = slow;
  }

  keyDown(event) {
    this.shift = event.shiftKey;
    const terms = this.keys.get(keyName(event));
    if (!terms || event.ctrlKey || event.altKey || event.metaKey) return false;
    if (!event.repeat) this.note(() => this.held.set(event.code, terms));
    return true;
  }

  keyUp(event) {
    this.shift = event.shiftKey;
    if (this.held.has(event.code)) this.note(() => this.held.delete(event.code));
    else this.tick();
  }

  /** Let go of everything, as when the window loses the focus. */
  release() {
    this.note(() => {
      this.held.clear();
      this.touch.clear();
      this.shift = false;
    });
  }

  setTouch(name, value) {
    this.note(() => (value ? this.touch.set(name, value) : this.touch.delete(name)));
  }

  /** Change something and send it without waiting for the clock. */
  note(change) {
    if (!this.since) this.since = performance.now();
    change();
    this.tick();
  }

  tick() {
    const now = performance.now();
    const state = this.read();
    const key = JSON.stringify(state);
    if (key === this.last && now - this.sent < KEEP_MS) return;
    const at = performance.timeOrigin + (key === this.last ? now : this.since || now);
    this.last = key;
    this.sent = now;
    this.since = 0;
    this.send({...state, at, silence: this.alive.silence(now)});
  }

  read() {
    const axes = new Array(AXES.length).fill(0);
    const buttons = new Array(BUTTONS.length).fill(0);
    const pad = choosePad();
    this.pad = !pad ? "" : pad.mapping === "standard" ? pad.id : `${pad.id}: this browser does not know its layout`;
    if (pad?.mapping === "standard") {
      axes.forEach((_, i) => (axes[i] = checked(pad.axes[i] ?? 0, -1)));
      buttons.forEach((_, i) => (buttons[i] = checked(pad.buttons[i]?.value ?? 0, 0)));
    }
    const add = (name, value) => {
      const axis = AXES.indexOf(name);
      if (axis >= 0) axes[axis] = clamp(axes[axis] + value, -1);
      else buttons[BUTTONS.indexOf(name)] = clamp(buttons[BUTTONS.indexOf(name)] + value, 0);
    };
    for (const terms of this.held.values()) {
      for (const [name, factor] of terms) {
        const analog = AXES.includes(name) || name.endsWith("trigger");
        add(name, analog && this.shift ? factor * this.slow : factor);
      }
    }
    for (const [name, value] of this.touch) add(name, value);
    return {axes, buttons, shift: this.shift};
  }
}

/** A gamepad in the standard layout, or else any. */
function choosePad() {
  const pads = [...(navigator.getGamepads?.() ?? [])].filter((each) => each && each.connected !== false);
  return pads.find((each) => each.mapping === "standard") ?? pads[0] ?? null;
}

/** Rounding is cut off; what no gamepad can send goes on as it is, and the robot stops on it. */
function checked(value, least) {
  if (!Number.isFinite(value)) return BROKEN;
  return value > least - 1e-3 && value < 1 + 1e-3 ? Math.min(1, Math.max(least, value)) : value;
}

/** Added sources stay in range; a broken one stays broken. */
function clamp(value, least) {
  return Math.abs(value) > 4 ? value : Math.min(1, Math.max(least, value));
}

/** A stick on the screen: dragging its knob gives two axes. */
export function touchStick(element, operator, across, down) {
  const knob = element.querySelector("b");
  let pointer = null;
  const show = (x, y) => {
    knob.style.transform = `translate(${x * 32}px, ${y * 32}px)`;
    operator.setTouch(across, x);
    operator.setTouch(down, y);
  };
  const move = (event) => {
    const box = element.getBoundingClientRect();
    let x = (event.clientX - box.left - box.width / 2) / (box.width / 2);
    let y = (event.clientY - box.top - box.height / 2) / (box.height / 2);
    const length = Math.max(1, Math.hypot(x, y));
    show(x / length, y / length);
  };
  const end = (event) => {
    if (event.pointerId === pointer) {
      pointer = null;
      show(0, 0);
    }
  };
  element.addEventListener("pointerdown", (event) => {
    pointer = event.pointerId;
    element.setPointerCapture(pointer);
    event.preventDefault();
    move(event);
  });
  element.addEventListener("pointermove", (event) => event.pointerId === pointer && move(event));
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) element.addEventListener(name, end);
}
