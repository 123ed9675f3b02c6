/**
 * Sends changes to the server one after the other, each made to what the one before led to.
 *
 * A change that comes too late, because somebody else changed the drawing, is made again to the newer drawing. Of the
 * previews that wait only the newest is sent, and none once their gesture is committed or cancelled.
 */

const TRIES = 3;
const OFFLINE = "The server cannot be reached; nothing was changed.";

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
  }

  /** @param {any} wanted see Store.edit */
  edit(wanted) {
    this.drop((other) => other.phase === "preview" && wanted.gesture && other.gesture === wanted.gesture);
    const last = this.waiting.at(-1);
    if (wanted.coalesce && last?.coalesce === wanted.coalesce) return this.joined(last, wanted.change);
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
    for (const job of this.waiting.filter(isUnwanted)) job.resolve(null);
    this.waiting = this.waiting.filter((job) => !isUnwanted(job));
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
    for (let job = this.waiting.shift(); job; job = this.waiting.shift()) job.resolve(await this.done(job));
    this.isBusy = false;
  }

  /** One job, whatever may happen to it. */
  async done(job) {
    try {
      return await job.run(job);
    } catch (error) {
      if (job.phase !== "preview") this.store.refuse(error instanceof TypeError ? OFFLINE : String(error.message));
      return null;
    }
  }

  /** Send a change of the drawing, again if it came too late. */
  async put(job) {
    if (!this.store.state) return null;
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
    if (!ok) throw new Error(sentence(told));
    this.store.take(told);
    return told;
  }

  async send(method, path, sent) {
    const answer = await fetch(this.store.path + path, {
      method,
      headers: { "content-type": "application/json" },
      body: sent === undefined ? undefined : JSON.stringify(sent),
    });
    return { ok: answer.ok, status: answer.status, told: await answer.json() };
  }
}

function body({ label, change, phase, coalesce = null, gesture }, base) {
  const common = { base_version: base.version, label, phase, coalesce, gesture };
  if (phase === "cancel") return common;
  const copy = structuredClone(base.drawing);
  return { ...common, drawing: change(copy) ?? copy };
}

function sentence(problem) {
  const first = problem.errors?.[0];
  return first ? `${first.field}: ${first.message}` : (problem.detail ?? problem.title ?? "This was refused.");
}
