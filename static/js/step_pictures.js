/** Cloth and base before each step of the plan that is shown and after the last, as pictures and on the board need them. */

/** @import { StepPicture } from "pleat" */

export class StepPictures extends EventTarget {
  /** @param {import("./store.js").Store} store */
  constructor(store) {
    super();
    this.store = store;
    /** The plan that they are of. */
    this.id = "";
    /** @type {StepPicture[]} one more than the plan has steps; none while they are not known */
    this.all = [];
    store.addEventListener("plan", () => this.look());
  }

  async look() {
    const plan = this.store.plan?.plan;
    const id = plan?.status === "solved" ? plan.id : "";
    if (id === this.id) return;
    this.id = id;
    this.take([]);
    const answer = id ? await this.store.ask({ do: "pictures", plan: id }).catch(() => null) : null;
    if (id === this.id) this.take(/** @type {StepPicture[]} */ (answer?.result ?? []));
  }

  /** @param {StepPicture[]} pictures */
  take(pictures) {
    if (!pictures.length && !this.all.length) return;
    this.all = pictures;
    this.dispatchEvent(new Event("change"));
  }

  /** The step that goes on while time runs or has begun to run; null at the start and where there is no plan. */
  get current() {
    const { playback, plan: message } = this.store;
    const steps = message?.plan?.primitives ?? [];
    if (!playback || !this.all.length || message?.plan?.id !== this.id) return null;
    if (!playback.playing && playback.t_s <= 0) return null;
    const index = steps.findIndex(({ start_s, duration_s }) => playback.t_s < start_s + duration_s);
    return index < 0 ? this.all.length - 1 : index;
  }
}
