/**
 * Sends changes to the server one after the other, each made to what the one before led to.
 *
 * A change that comes too late, because somebody else changed the drawing, is made again to the newer drawing. Of the
 * previews that wait only the newest is sent, and none once their gesture is committed or cancelled. A change that finds
 * no server is kept, and sent again when there is one.
 */

import { sayable } from "./dom.js";
import { inEnglish, say } from "./language/say.js";
import { RefusedError, UnreachableError } from "./live.js";

/** @import { Command, DocumentState, Drawing } from "pleat" */

const TRIES = 3;
const RETRY_MS = 1000;
const CONFLICT = 409;
const OFFLINE = say("server.nothing_changed");
const KEPT = say("server.change_kept");

/** @typedef {(drawing: Drawing) => Drawing|void} Change alters the drawing it is given, or returns another one */
/** @typedef {{drawing: Drawing, version: number}} Base what a change is made to */
/**
 * A change of the drawing, as it is asked for. Work that is none has the phase "none".
 * @typedef {object} Wanted
 * @property {string} label the name of the step
 * @property {Change|null} change
 * @property {"preview"|"commit"|"cancel"|"none"} phase
 * @property {string|null} coalesce
 * @property {string|null} gesture
 */
/** @typedef {(job: Job) => Promise<DocumentState|null>} Run */
/**
 * Work that waits for its turn.
 * @typedef {object} Waiting
 * @property {Run} run
 * @property {boolean} isRepeated whether it has been sent before, perhaps in vain
 * @property {string|null} after the step that undo would have taken when it was sent
 * @property {Promise<DocumentState|null>} promise
 * @property {(state: DocumentState|null) => void} resolve
 */
/** @typedef {Wanted & Waiting} Job */

/** @type {Wanted} */
const NO_CHANGE = { label: "", change: null, phase: "none", coalesce: null, gesture: null };

export class EditQueue {
  /** @param {import("./store.js").Store} store */
  constructor(store) {
    this.store = store;
    /** @type {Job[]} */
    this.waiting = [];
    this.isBusy = false;
    /** @type {(Base & {key: string})|null} the gesture going on, the drawing before it, its last answer's version */
    this.gesture = null;
    /** Whether changes wait for a server. */
    this.isHeld = false;
    store.addEventListener("connection", () => this.resume());
  }

  /** @param {Wanted} wanted see Store.edit */
  edit(wanted) {
    this.drop((other) => other.phase === "preview" && wanted.gesture && other.gesture === wanted.gesture);
    const last = this.waiting.at(-1);
    const isWaiting = last && !(this.isBusy && last === this.waiting[0]);
    if (isWaiting && wanted.coalesce && last.coalesce === wanted.coalesce) return this.joined(last, wanted.change);
    return this.push((job) => this.put(job), wanted);
  }

  /**
   * A change that goes along with one of the same run that has not been sent yet.
   * @param {Job} job
   * @param {Change|null} change
   * @returns {Promise<DocumentState|null>}
   */
  joined(job, change) {
    const first = job.change;
    job.change = (drawing) => {
      const between = first?.(drawing) ?? drawing;
      return change?.(between) ?? between;
    };
    return job.promise;
  }

  /** @param {string} gesture */
  cancel(gesture) {
    this.drop((other) => other.gesture === gesture);
    return this.push((job) => this.put(job), {
      ...NO_CHANGE,
      phase: "cancel",
      label: inEnglish("step.cancel"),
      gesture,
    });
  }

  /**
   * Any other change, in its turn.
   * @param {Command} command
   * @param {(before: Drawing|undefined) => void} [done] called once it is made
   */
  change(command, done) {
    return this.push(async () => {
      const before = this.store.state?.drawing;
      await this.store.ask(command);
      done?.(before);
      return this.store.state;
    });
  }

  /** @param {(job: Job) => unknown} isUnwanted */
  drop(isUnwanted) {
    const [first] = this.isBusy ? this.waiting : []; // on its way
    const dropped = this.waiting.filter((job) => job !== first && isUnwanted(job));
    for (const job of dropped) job.resolve(null);
    this.waiting = this.waiting.filter((job) => !dropped.includes(job));
  }

  /**
   * @param {Run} run
   * @param {Wanted} wanted
   * @returns {Promise<DocumentState|null>} the state after it; null for none
   */
  push(run, wanted = NO_CHANGE) {
    /** @type {Waiting["resolve"]} */
    let resolve = () => {};
    /** @type {Waiting["promise"]} */
    const promise = new Promise((settle) => (resolve = settle));
    this.waiting.push({ ...wanted, run, isRepeated: false, after: null, promise, resolve });
    this.work();
    return promise;
  }

  async work() {
    if (this.isBusy) return;
    this.isBusy = true;
    while (!this.isHeld && this.waiting.length) await this.done(this.waiting[0]);
    this.isBusy = false;
  }

  /** One job, whatever may happen to it; one that is kept stays the first of those that wait. @param {Job} job */
  async done(job) {
    let state = null;
    try {
      state = await job.run(job);
    } catch (error) {
      const isLost = error instanceof UnreachableError;
      if (isLost && job.phase === "commit") return this.hold(job);
      if (job.phase !== "preview") this.store.refuse(isLost ? OFFLINE : this.sentence(error));
    }
    this.waiting = this.waiting.filter((other) => other !== job);
    job.resolve(state);
  }

  /** Keep a change, and what comes after it, until the server is back. @param {Job} job */
  hold(job) {
    if (!job.isRepeated) this.store.refuse(KEPT);
    job.isRepeated = true;
    this.isHeld = true;
    this.store.tell("held");
    setTimeout(() => this.resume(), RETRY_MS);
  }

  /** Go on, unless it is known that there is still no server. */
  resume() {
    if (!this.isHeld || this.store.isLost) return;
    this.isHeld = false;
    this.store.tell("held");
    this.work();
  }

  /**
   * Send a change of the drawing, again if it came too late.
   * @param {Job} job
   * @returns {Promise<DocumentState|null>}
   */
  async put(job) {
    if (!this.store.state) return null;
    if (job.isRepeated && this.wasMade(job)) return this.store.state;
    job.after = this.store.state.history.can_undo;
    const isPartOfGesture = job.gesture !== null && job.gesture === this.gesture?.key;
    if (job.phase === "cancel" && !isPartOfGesture) return this.store.state;
    /** @type {Base} */
    let base = (isPartOfGesture && this.gesture) || this.store.state;
    for (let tries = 0; tries < TRIES; tries += 1) {
      const version = await this.versionOf(job, base);
      if (version !== null) {
        const goesOn = job.phase === "preview" && job.gesture !== null;
        this.gesture = goesOn ? { key: job.gesture ?? "", drawing: base.drawing, version } : null;
        return this.store.state;
      }
      base = this.store.state;
      if (job.phase !== "cancel") continue;
      this.gesture = null; // somebody else has ended it: there is nothing to take back
      return this.store.state;
    }
    throw new Error(say("server.changed_elsewhere"));
  }

  /**
   * The version that a change makes; null where it came too late, and the newer drawing is here.
   * @param {Job} job
   * @param {Base} base
   */
  async versionOf({ label, change, phase, coalesce, gesture }, base) {
    const copy = change && structuredClone(base.drawing);
    const drawing = copy && (change(copy) ?? copy);
    const common = { base_version: base.version, label, phase, coalesce, gesture };
    try {
      return (await this.store.ask(/** @type {Command} */ ({ do: "edit", ...common, drawing }))).version;
    } catch (error) {
      if (error instanceof RefusedError && error.problem.status === CONFLICT) return null;
      throw error;
    }
  }

  /**
   * Whether a change that is to be sent again has been made before, only its answer was lost. A gesture says where things
   * shall be: to make it again does no harm.
   * @param {Job} job
   */
  wasMade(job) {
    const last = this.store.state?.history.can_undo ?? null;
    return job.gesture === null && last === job.label && job.after !== last;
  }

  /** @param {unknown} error */
  sentence(error) {
    return error instanceof RefusedError ? error.inWords(this.store.state?.drawing.folds ?? []) : sayable(error);
  }
}
