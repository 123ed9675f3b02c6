/**
 * Sends changes to the server one after the other, each made to what the one before led to.
 *
 * A change that comes too late, because somebody else changed the drawing, is made again to the newer drawing. Of the
 * previews that wait only the newest is sent, and none once their gesture is committed or cancelled. A change that finds
 * no server is kept, and sent again when there is one.
 */

import { sayable } from "./dom.js";
import { inWords } from "./messages/in_words.js";

const TRIES = 3;
const RETRY_MS = 1000;
const OFFLINE = "The server cannot be reached; nothing was changed.";
const KEPT = "The server cannot be reached. Your change is kept and sent when it is back.";

class UnreachableError extends Error {}

export class EditQueue {
  /** @param {import("./store.js").Store} store */
  constructor(store) {
    this.store = store;
    /** @type {any[]} */
    this.waiting = [];
    this.isBusy = false;
    /** The gesture going on: its key, the drawing before it, and the version that its last answer had. */
    /** @type {{key: string, drawing: any, version: number}|null} */
    this.gesture = null;
    /** Whether changes wait for a server. */
    this.isHeld = false;
    store.addEventListener("connection", () => this.resume());
  }

  /** @param {any} wanted see Store.edit */
  edit(wanted) {
    this.drop((other) => other.phase === "preview" && wanted.gesture && other.gesture === wanted.gesture);
    const last = this.waiting.at(-1);
    const isWaiting = last && !(this.isBusy && last === this.waiting[0]);
    if (isWaiting && wanted.coalesce && last.coalesce === wanted.coalesce) return this.joined(last, wanted.change);
    return this.push({ ...wanted, run: (job) => this.put(job) });
  }

  /** A change that goes along with one of the same run that has not been sent yet. */
  joined(job, change) {
    const first = job.change;
    job.change = (drawing) => {
      const between = first(drawing) ?? drawing;
      return change(between) ?? between;
    };
    return job.promise;
  }

  /** @param {string} gesture */
  cancel(gesture) {
    this.drop((other) => other.gesture === gesture);
    return this.push({ phase: "cancel", label: "Cancel", gesture, run: (job) => this.put(job) });
  }

  /** @param {"undo"|"redo"} verb */
  post(verb) {
    const run = () => this.send("POST", `/${verb}`, undefined);
    return this.push({ run: async () => this.taken(await run()) });
  }

  /** @param {string|object} garment @param {string|null} label */
  open(garment, label) {
    const run = async () => {
      const before = this.store.state?.drawing;
      const state = this.taken(await this.send("PUT", "/garment", { garment, label }));
      this.store.select(null);
      this.store.showStep(0);
      this.store.dispatchEvent(new CustomEvent("opened", { detail: before }));
      return state;
    };
    return this.push({ run });
  }

  /** @param {(job: any) => unknown} isUnwanted */
  drop(isUnwanted) {
    const [first] = this.isBusy ? this.waiting : []; // on its way
    const dropped = this.waiting.filter((job) => job !== first && isUnwanted(job));
    for (const job of dropped) job.resolve(null);
    this.waiting = this.waiting.filter((job) => !dropped.includes(job));
  }

  push(job) {
    const waiting = { ...job };
    waiting.promise = new Promise((resolve) => (waiting.resolve = resolve));
    this.waiting.push(waiting);
    this.work();
    return waiting.promise;
  }

  async work() {
    if (this.isBusy) return;
    this.isBusy = true;
    while (!this.isHeld && this.waiting.length) await this.done(this.waiting[0]);
    this.isBusy = false;
  }

  /** One job, whatever may happen to it; one that is kept stays the first of those that wait. */
  async done(job) {
    let state = null;
    try {
      state = await job.run(job);
    } catch (error) {
      const isLost = error instanceof UnreachableError;
      if (isLost && job.phase === "commit") return this.hold(job);
      if (job.phase !== "preview") this.store.refuse(isLost ? OFFLINE : sayable(error));
    }
    this.waiting = this.waiting.filter((other) => other !== job);
    job.resolve(state);
  }

  /** Keep a change, and what comes after it, until the server is back. */
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

  /** Send a change of the drawing, again if it came too late. */
  async put(job) {
    if (!this.store.state) return null;
    if (job.isRepeated && this.wasMade(job)) return this.store.state;
    job.after = this.store.state.history.can_undo;
    const isPartOfGesture = job.gesture !== null && job.gesture === this.gesture?.key;
    if (job.phase === "cancel" && !isPartOfGesture) return this.store.state;
    let base = isPartOfGesture ? this.gesture : this.store.state;
    for (let tries = 0; tries < TRIES; tries += 1) {
      const answer = await this.send("PUT", "/drawing", body(job, base));
      if (answer.status !== 409) return this.settled(job, base, answer);
      base = answer.told.state;
      this.store.take(base);
      if (job.phase === "cancel") return this.forgotten();
    }
    throw new Error("The drawing is being changed elsewhere; this change was not made.");
  }

  /**
   * Whether a change that is to be sent again has been made before, only its answer was lost. A gesture says where things
   * shall be: to make it again does no harm.
   */
  wasMade(job) {
    const last = this.store.state.history.can_undo;
    return job.gesture === null && last === job.label && job.after !== last;
  }

  settled(job, base, answer) {
    const state = this.taken(answer);
    const goesOn = job.phase === "preview" && job.gesture !== null;
    this.gesture = goesOn ? { key: job.gesture, drawing: base.drawing, version: state.version } : null;
    return state;
  }

  /** Somebody else has ended our gesture: there is nothing to take back. */
  forgotten() {
    this.gesture = null;
    return this.store.state;
  }

  taken({ ok, told }) {
    if (!ok) throw new Error(sentence(told, this.store.state?.drawing.folds ?? []));
    this.store.take(told);
    return told;
  }

  async send(method, path, sent) {
    const body = sent === undefined ? undefined : JSON.stringify(sent);
    const headers = { "content-type": "application/json" };
    try {
      const answer = await fetch(this.store.path + path, { method, headers, body });
      return { ok: answer.ok, status: answer.status, told: await answer.json() };
    } catch {
      throw new UnreachableError();
    }
  }
}

function body({ label, change, phase, coalesce = null, gesture }, base) {
  const common = { base_version: base.version, label, phase, coalesce, gesture };
  if (phase === "cancel") return common;
  const copy = structuredClone(base.drawing);
  return { ...common, drawing: change(copy) ?? copy };
}

function sentence(problem, folds) {
  const first = problem.errors?.[0];
  if (first?.says) return `${inWords(first, folds)}.`;
  return first ? `${first.field}: ${first.message}` : (problem.detail ?? problem.title ?? "This was refused.");
}
