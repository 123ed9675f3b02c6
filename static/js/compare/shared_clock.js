/** One clock for both plans: it runs in real time to the end of the longer one. */

export class SharedClock extends EventTarget {
  constructor() {
    super();
    this.t_s = 0;
    this.end_s = 0;
    this.isRunning = false;
    /** @type {number|undefined} */
    this.frame = undefined;
    this.last = 0;
  }

  /** @param {number} end_s */
  reach(end_s) {
    this.end_s = end_s;
    this.go(Math.min(this.t_s, end_s));
  }

  /** @param {number} t_s */
  go(t_s) {
    this.t_s = t_s;
    this.dispatchEvent(new Event("tick"));
  }

  /** Play from here, or from the beginning where this is the end; or stop. */
  toggle() {
    if (this.isRunning) this.stop();
    else this.start();
  }

  start() {
    if (this.end_s <= 0) return;
    if (this.t_s >= this.end_s) this.t_s = 0;
    this.isRunning = true;
    this.last = performance.now();
    this.frame = requestAnimationFrame((now) => this.run(now));
    this.go(this.t_s);
  }

  stop() {
    this.isRunning = false;
    if (this.frame !== undefined) cancelAnimationFrame(this.frame);
    this.go(this.t_s);
  }

  /** @param {number} now (ms) */
  run(now) {
    const t_s = Math.min(this.t_s + Math.max(now - this.last, 0) / 1000, this.end_s);
    this.last = now;
    if (t_s >= this.end_s) this.isRunning = false;
    else this.frame = requestAnimationFrame((then) => this.run(then));
    this.go(t_s);
  }
}
