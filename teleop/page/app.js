// The page: one WebSocket to the server, the picture, and what a person does with buttons, keys and sticks.

import {Operator, touchStick, keyName, BUTTONS} from "./gamepad.js";
import {keysFor, shownControls} from "./legend.js";
import {Stage} from "./stage.js";

const RETRY_MS = 1500;
const SPEED_MS = 60;
const TOKEN_KEY = "showtell-token";
const HOLD_KEY = "f";
const HOLD_BUTTON = BUTTONS.indexOf("left_stick");
const SHOWN_NOTICES = 8;
const RELEASE_AFTER_MS = 700; // a stop that two hands press at once, or one twice, is not released by the second press
const DECK_BUTTONS = ["record", "stop-deck", "keep", "discard", "redo", "success", "failure"];
const byId = (name) => document.getElementById(name);
const state = {socket: null, opened: false, yours: false, free: true, wanted: true, status: null, setup: null,
  seq: 0, noticed: 0, holding: false, blind: false, enabled: true, speedTimer: 0,
  stoppedAt: 0, releases: false};
// What the page adds for telling and doing, where the server has it: teleop itself knows nothing of words.
const talk = {part: null, loading: false, waiting: []};

// The token is in the address once; from then on only this tab knows it.
const given = new URLSearchParams(location.hash.slice(1)).get("token");
if (given) {
  sessionStorage.setItem(TOKEN_KEY, given);
  history.replaceState(null, "", location.pathname);
}
const token = sessionStorage.getItem(TOKEN_KEY) ?? "";

const canvas = byId("view");
const stage = new Stage(canvas, showViews);
const operator = new Operator(sendInput);

// --- the connection

function connect() {
  if (!token) {
    setLink("bad", "no token");
    showSafety("stopped", "open the address that showtell serve printed: it carries the token");
    return;
  }
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  const socket = new WebSocket(`${scheme}://${location.host}/socket`, ["showtell.v1", `showtell.token.${token}`]);
  socket.binaryType = "arraybuffer";
  state.socket = socket;
  socket.onopen = () => {
    state.opened = true;
    setLink("good", "connected");
  };
  socket.onmessage = ({data}) => (typeof data === "string" ? hearText(JSON.parse(data)) : hearBytes(data));
  socket.onclose = ({reason}) => {
    state.socket = null;
    state.yours = false;
    setLink("bad", "not connected");
    showSafety("stopped", reason || (state.opened ? "the connection is lost: the robot stops" :
      "the server does not answer, or the token is not the right one"));
    showControl();
    setTimeout(connect, RETRY_MS);
  };
}

function send(message) {
  if (state.socket?.readyState === WebSocket.OPEN) state.socket.send(JSON.stringify(message));
}

function sendInput({axes, buttons, at, silence}) {
  if (!state.yours) return;
  const sent = [...buttons];
  const pressed = state.holding || buttons[HOLD_BUTTON] > 0.5 || operator.touch.size > 0;
  if (byId("hold").checked) sent[HOLD_BUTTON] = 0; // it holds motion on here, and means nothing else
  state.enabled = !byId("hold").checked || pressed;
  state.seq += 1;
  send({type: "input", seq: state.seq, at, silence, axes, buttons: sent, enabled: state.enabled,
    camera: stage.seen});
}

function hearBytes(data) {
  const kind = String.fromCharCode(new Uint8Array(data, 0, 1)[0]);
  if (kind === "G") stage.call("setGeometry", data);
  else if (kind === "P") stage.call("setPoses", data);
}

function hearText(message) {
  if (message.type === "status") showStatus(message);
  else if (message.type === "setup") showSetup(message);
  else if (message.type === "talk" || message.type === "knowledge") {
    if (talk.part) talk.part.hear(message);
    else talk.waiting.push(message);
  }
  else if (message.type === "control") {
    Object.assign(state, {yours: message.yours, free: message.free, pages: message.pages});
    if (message.free && state.wanted) send({type: "control", action: "take"});
    if (message.yours) state.wanted = false; // taken on its own once; later only by the button
    showControl();
  } else if (message.type === "refused") notice("error", message.reason);
}

// --- what is shown

function setLink(tone, text) {
  byId("link").dataset.tone = tone;
  byId("link").textContent = text;
}

function setText(name, text) {
  const element = byId(name);
  if (element.textContent !== text) element.textContent = text;
}

function showSafety(kind, reason) {
  byId("safety").dataset.state = kind;
  setText("safety-state", kind);
  setText("safety-reason", reason);
}

function showControl() {
  const {yours, free} = state;
  setText("role", yours ? "You hold control." : free ? "Nobody holds control." : "Another page holds control.");
  setText("control", yours ? "Give back" : "Take control");
  byId("control").disabled = !state.socket;
  document.body.dataset.control = yours ? "yours" : "watching";
  showDeck();
}

function showStatus(status) {
  if (status.stopped && !state.status?.stopped) state.stoppedAt = performance.now();
  state.status = status;
  const {deck} = status;
  setText("scene", `${state.setup?.robot ?? ""} · ${deck.scene} ${deck.seed}`);
  const free = {ok: status.moving ? "moving" : "ready"}[status.state];
  showSafety(status.state, status.reason || `${free}: ${status.manner}`);
  const stop = byId("stop");
  stop.setAttribute("aria-pressed", String(status.stopped));
  state.releases = status.stopped && performance.now() - state.stoppedAt > RELEASE_AFTER_MS;
  stop.firstChild.textContent = state.releases ? "Release" : "Stop";
  setText("figure-time", `${status.time.toFixed(1)} s`);
  setText("figure-speed", `${(1000 * status.executed).toFixed(0)} mm/s`);
  const {latency} = status;
  if (latency) setText("figure-latency", `${latency.median_ms.toFixed(1)} ms, 99 %: ${latency.p99_ms.toFixed(1)}`);
  for (const button of byId("arms").children) {
    button.setAttribute("aria-checked", String(button.dataset.arm === status.chosen));
  }
  if (!state.speedTimer && document.activeElement !== byId("speed")) {
    byId("speed").value = String(Math.round(100 * status.speed));
  }
  setText("speed-shown", `${byId("speed").value} %`);
  setText("pad", operator.pad || "No gamepad: press one of its buttons to connect it.");
  const demos = byId("demos");
  const names = JSON.stringify(status.demos);
  if (demos.dataset.names !== names) {
    const chosen = status.demos.length > (demos.options.length || 0) ? "" : demos.value;
    demos.replaceChildren(...status.demos.map((name) => new Option(name, name, false, name === chosen)));
    demos.dataset.names = names;
  }
  for (const [number, level, text] of status.notices) {
    if (number > state.noticed) {
      state.noticed = number;
      notice(level, text);
    }
  }
  showDeck();
}

async function startTalk() {
  if (talk.loading) return;
  talk.loading = true;
  const {Talk} = await import("./talk.js");
  talk.part = new Talk({send, stage, state, canvas});
  for (const message of talk.waiting.splice(0)) talk.part.hear(message);
  showDeck();
}

function showDeck() {
  const deck = state.status?.deck;
  if (!deck) return;
  const mode = state.status.lent ? "lent" : deck.mode;
  byId("deck").dataset.mode = mode;
  const said = `${deck.sentences} sentence${deck.sentences === 1 ? "" : "s"}`;
  setText("deck", {
    idle: "Nothing is recorded. Recording starts the scene anew.",
    recording: `Recording ${deck.file}: ${deck.seconds.toFixed(1)} s, ${said}`,
    review: `${deck.file} ${deck.outcome ? `(${deck.outcome}) ` : ""}waits, ${said}: describe, keep or discard it.`,
    replaying: `Replaying, ${deck.seconds.toFixed(1)} of ${deck.duration.toFixed(1)} s`,
    lent: `Driving is locked: ${state.status.lent}.`,
  }[mode]);
  const can = {
    record: mode === "idle", "stop-deck": mode === "recording" || mode === "replaying", keep: mode === "review",
    discard: mode === "recording" || mode === "review", redo: mode === "recording" || mode === "review",
    describe: mode !== "replaying" && mode !== "lent", success: mode === "review", failure: mode === "review",
    replay: mode === "idle" && byId("demos").options.length > 0, reset: mode === "idle", another: mode === "idle",
  };
  for (const [name, possible] of Object.entries(can)) {
    byId(name).disabled = !(possible && state.yours);
    if (DECK_BUTTONS.includes(name)) byId(name).hidden = !possible;
  }
  byId("speed").disabled = !state.yours;
  for (const button of byId("arms").children) button.disabled = !state.yours;
  document.body.dataset.lent = state.status.lent ? "yes" : "no";
  talk.part?.show();
}

function showSetup(setup) {
  state.setup = setup;
  if (setup.talks) startTalk();
  operator.setKeys(setup.keys, setup.slow);
  byId("arm-field").hidden = setup.choices.length < 2;
  byId("arms").replaceChildren(...setup.choices.map((arm) => {
    const button = radio(arm, () => send({type: "set", arm}));
    button.dataset.arm = arm;
    return button;
  }));
  byId("legend").replaceChildren(...setup.controls.map(([does, controls]) => {
    const row = document.createElement("tr");
    row.append(cell("th", does), cell("td", shownControls(controls)), cell("td", keysFor(controls, setup.keys)));
    row.firstChild.scope = "row";
    return row;
  }));
  const used = setup.controls.map(([, controls]) => controls).join(" ");
  byId("stick-right").hidden = !/right_[xy]/.test(used);
  byId("pad-buttons").replaceChildren(...[["right_trigger", "Up"], ["left_trigger", "Down"], ["a", "Close"],
    ["b", "Open"]].map(([name, text]) => {
    const button = document.createElement("button");
    button.textContent = text;
    button.tabIndex = -1;
    const press = (on) => (event) => {
      event.preventDefault();
      operator.setTouch(name, on ? 1 : 0);
    };
    button.addEventListener("pointerdown", press(true));
    for (const kind of ["pointerup", "pointercancel", "pointerleave"]) button.addEventListener(kind, press(false));
    return button;
  }));
}

function showViews() {
  document.body.dataset.pictures = String(stage.frames);
  talk.part?.place(stage.marks);
  const names = stage.views;
  const box = byId("views");
  if (box.dataset.names !== names.join()) {
    box.replaceChildren(...names.map((name) => radio(name, () => stage.call("look", name))));
    box.dataset.names = names.join();
  }
  if (!stage.works && !state.blind) {
    state.blind = true;
    notice("error", "This browser cannot draw the picture (WebGL2 in a worker); everything else works.");
  }
  [...box.children].forEach((each, i) => each.setAttribute("aria-checked", String(names[i] === stage.view)));
}

function radio(text, chosen) {
  const button = document.createElement("button");
  button.type = "button";
  button.setAttribute("role", "radio");
  button.textContent = text;
  button.addEventListener("click", chosen);
  return button;
}

function cell(kind, text) {
  const element = document.createElement(kind);
  element.textContent = text;
  return element;
}

function notice(level, text) {
  const last = byId("notices").firstChild;
  if (last && last.dataset.level === level && last.dataset.text === text) { // one line for what happens again and again
    last.dataset.times = Number(last.dataset.times) + 1;
    last.textContent = `${text} (${last.dataset.times} times)`;
    return;
  }
  const item = cell("li", text);
  Object.assign(item.dataset, {level, text, times: 1});
  byId("notices").prepend(item);
  while (byId("notices").children.length > SHOWN_NOTICES) byId("notices").lastChild.remove();
}

// --- what a person does

function toggleStop() {
  send({type: state.releases ? "release" : "stop"}); // as the button says
}

byId("stop").addEventListener("click", toggleStop);
byId("control").addEventListener("click", () => send({type: "control", action: state.yours ? "release" : "take"}));
for (const [name, action] of [["record", "record"], ["stop-deck", "stop"], ["keep", "keep"], ["discard", "discard"],
  ["redo", "redo"], ["success", "success"], ["failure", "failure"], ["reset", "reset"], ["another", "another"]]) {
  byId(name).addEventListener("click", () => send({type: "do", action}));
}
byId("replay").addEventListener("click", () => send({type: "do", action: "replay", demo: byId("demos").value}));
byId("describe-form").addEventListener("submit", (event) => {
  event.preventDefault();
  const text = byId("sentence").value.trim();
  if (text && !byId("describe").disabled) {
    send({type: "do", action: "describe", text});
    byId("sentence").value = "";
  }
});
byId("speed").addEventListener("input", () => {
  setText("speed-shown", `${byId("speed").value} %`);
  if (!state.speedTimer) {
    state.speedTimer = setTimeout(() => {
      state.speedTimer = 0;
      send({type: "set", speed: Number(byId("speed").value) / 100});
    }, SPEED_MS);
  }
});
byId("touch").checked = matchMedia("(pointer: coarse)").matches;
const showPads = () => (byId("pads").hidden = !byId("touch").checked);
byId("touch").addEventListener("change", showPads);
showPads();
touchStick(byId("stick-left"), operator, "left_x", "left_y");
touchStick(byId("stick-right"), operator, "right_x", "right_y");

// Keys drive only while no control has the focus, so that the page can be used by keyboard alone.
const drives = (target) => target === canvas || target === document.body;
addEventListener("keydown", (event) => {
  if (event.key === "Escape" || (drives(event.target) && event.key === " ")) {
    send({type: "stop"});
    event.preventDefault();
    canvas.focus({preventScroll: true});
    return;
  }
  if (!drives(event.target)) return;
  if (keyName(event) === HOLD_KEY) {
    if (!state.holding) operator.note(() => (state.holding = true));
    operator.last = "";
  } else if (operator.keyDown(event)) event.preventDefault();
});
addEventListener("keyup", (event) => {
  if (keyName(event) === HOLD_KEY) {
    operator.last = "";
    operator.note(() => (state.holding = false));
  } else operator.keyUp(event);
});
const letGo = () => {
  state.holding = false;
  operator.release();
};
addEventListener("blur", letGo);
addEventListener("pagehide", () => state.socket?.close()); // a page kept in the browser's cache would keep control
document.addEventListener("visibilitychange", () => document.hidden && letGo());
document.addEventListener("focusin", (event) => !drives(event.target) && letGo());
// A click with the mouse does not keep the focus on a button: the keys go on driving.
document.addEventListener("click", (event) => {
  if (event.detail > 0 && event.target.closest("button, summary, input[type=checkbox], input[type=range]")) {
    canvas.focus({preventScroll: true});
  }
});

showViews();
document.body.dataset.ready = "yes";
showControl();
connect();
