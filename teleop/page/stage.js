// The picture's place on the page: its size, the pointer on it, and the worker that draws it.

export class Stage {
  /** @param {HTMLCanvasElement} canvas  @param {() => void} changed is called when views change or drawing fails. */
  constructor(canvas, changed) {
    this.canvas = canvas;
    this.views = [];
    this.view = "";
    this.frames = 0;
    this.seen = null; // orientation of the picture, for driving along its axes
    this.marks = []; // where what is marked is in the picture, as placed() has it
    this.works = true;
    this.pointers = new Map();
    if (!canvas.transferControlToOffscreen) {
      this.works = false;
      return;
    }
    this.worker = new Worker("view_worker.js", {type: "module"});
    this.worker.onmessage = ({data}) => {
      Object.assign(this, data);
      changed();
    };
    const offscreen = canvas.transferControlToOffscreen();
    this.worker.postMessage(["start", offscreen], [offscreen]);
    new ResizeObserver(() => this.frame()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.frame());
    this.listen();
  }

  /** Have a method of the viewer called. */
  call(...message) {
    this.worker?.postMessage(message, message.filter((each) => each instanceof ArrayBuffer));
  }

  frame() {
    const sky = getComputedStyle(this.canvas).getPropertyValue("--sky").trim().split(/\s+/).map(Number);
    this.call("setFrame", this.canvas.clientWidth, this.canvas.clientHeight, devicePixelRatio, sky);
  }

  listen() {
    const {canvas, pointers} = this;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    for (const name of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(name, (event) => pointers.delete(event.pointerId));
    }
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("dblclick", () => this.call("look", "overview"));
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.call("zoom", Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100) * 0.002));
    }, {passive: false});
  }

  /** One pointer turns, the right button moves, two pointers move and zoom. */
  drag(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - last[0], now[1] - last[1]];
    const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1];
    this.pointers.set(event.pointerId, now);
    if (other) {
      const apart = ([x, y]) => Math.max(1, Math.hypot(x - other[0], y - other[1]));
      this.call("zoom", apart(last) / apart(now));
      this.call("pan", dx / 2, dy / 2);
    } else this.call(event.buttons & 6 || event.ctrlKey ? "pan" : "turn", dx, dy);
  }
}
