// Whether the browser behind this page is alive. Keys and gamepads come through its main process, while the page runs in
// another one: when only the main process hangs, the page would go on to say that a key is held that was long let go.

/** Sends a message to itself through the browser's main process, and knows how long that one is out. */
export class Alive {
  constructor() {
    const name = `showtell-alive-${Math.random()}`;
    this.since = 0; // when the message was sent that is not back yet
    if (!("BroadcastChannel" in window)) return;
    this.out = new BroadcastChannel(name);
    this.back = new BroadcastChannel(name);
    this.back.onmessage = () => (this.since = 0);
  }

  /** How long the browser has said nothing [ms]; asked again and again. */
  silence(now) {
    if (this.since) return now - this.since;
    if (this.out) {
      this.since = now;
      this.out.postMessage(0);
    }
    return 0;
  }
}
