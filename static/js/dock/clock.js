/** The document's clock, run on between the server's messages. */

export class Clock extends EventTarget {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    super();
    /** @type {{t_s: number, duration_s: number, playing: boolean, speed: number}} */
    this.told = { t_s: 0, duration_s: 0, playing: false, speed: 1 };
    this.toldAt = 0;
    this.isRunning = false;
    store.addEventListener("playback", () => store.playback && this.set(store.playback));
  }

  /** @param {{t_s: number, duration_s: number, playing: boolean, speed: number}} told by the server */
  set(told) {
    this.told = told;
    this.toldAt = performance.now();
    this.dispatchEvent(new Event("change"));
    this.tick();
  }

  /** The time in the plan now (s). */
  get now() {
    const { t_s, duration_s, playing, speed } = this.told;
    const ran = playing ? (speed * (performance.now() - this.toldAt)) / 1000 : 0;
    return Math.min(t_s + ran, duration_s);
  }

  tick() {
    this.dispatchEvent(new Event("tick"));
    if (!this.told.playing || this.isRunning) return;
    this.isRunning = true;
    requestAnimationFrame(() => {
      this.isRunning = false;
      this.tick();
    });
  }
}
