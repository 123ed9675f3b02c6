/** How long planning has been going on, as far as it matters to who waits: not at all, noticeably, long. */

const NOTICED_MS = 200;
const LONG_MS = 1000;

/** @typedef {""|"short"|"noticed"|"long"} Wait */

export class Planning extends EventTarget {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    super();
    this.store = store;
    /** @type {Wait} */
    this.wait = "";
    /** @type {number[]} */
    this.timers = [];
    for (const name of ["document", "plan", "connection"]) store.addEventListener(name, () => this.look());
  }

  /** Whether the plan that is shown is not that of the drawing. */
  get isGoingOn() {
    const { isLive, plan, state } = this.store;
    return Boolean(isLive && plan && state && (plan.status === "planning" || plan.version < state.version));
  }

  look() {
    if (!this.isGoingOn) this.end();
    else if (!this.wait) this.begin();
  }

  begin() {
    this.wait = "short";
    /** @param {Wait} wait @param {number} millis */
    const after = (wait, millis) => setTimeout(() => this.become(wait), millis);
    this.timers = [after("noticed", NOTICED_MS), after("long", LONG_MS)];
  }

  end() {
    for (const timer of this.timers) clearTimeout(timer);
    this.become("");
  }

  /** @param {Wait} wait */
  become(wait) {
    if (wait === this.wait) return;
    this.wait = wait;
    this.dispatchEvent(new Event("change"));
  }
}

/**
 * Whether a quicker plan is still looked for while one is on show, as soon as that has lasted long enough to be worth a
 * word: mostly it is over in no time.
 */
export class Refining extends EventTarget {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    super();
    this.store = store;
    this.isLong = false;
    /** @type {string|null} the plan that may be replaced */
    this.id = null;
    for (const name of ["document", "plan", "connection"]) store.addEventListener(name, () => this.look());
  }

  /** The plan on show, if the drawing has it and a quicker one may come. @returns {string|null} */
  get unfinished() {
    const { isLive, plan: message, state } = this.store;
    const plan = message?.plan;
    const isOfDrawing = plan && message.status === "solved" && plan.version === state?.version;
    return isLive && isOfDrawing && !plan.is_final ? plan.id : null;
  }

  look() {
    const id = this.unfinished;
    if (id === this.id) return;
    this.id = id;
    clearTimeout(this.timer);
    this.become(false);
    if (id !== null) this.timer = setTimeout(() => this.become(true), LONG_MS);
  }

  /** @param {boolean} isLong */
  become(isLong) {
    if (isLong === this.isLong) return;
    this.isLong = isLong;
    this.dispatchEvent(new Event("change"));
  }
}
