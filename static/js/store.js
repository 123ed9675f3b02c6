/**
 * What the page knows: the document, its plan and playback as the server told them last, and what the reader looks at.
 * Parts listen to its events and call its verbs; none of them talks to another.
 *
 * Events: "document", "plan", "playback", "connection", "selection", "step", "overlays", "pending", "hover-time",
 * "preview", "begun", "held" (changes wait for a server, or do no more), "refused" (detail: a sentence), "gone", "opened"
 * (another garment, by this page; detail: the drawing that it has replaced), "propose" (ways to fold it are asked for).
 */

import { EditQueue } from "./edit_queue.js";
import { Live } from "./live.js";
import { tellArms } from "./messages/arms.js";

/** @import { Command, DocumentState, Drawing, Garment, Layer, PlanChange, PlanMessage, Playback } from "pleat" */
/** @import { Change } from "./edit_queue.js" */

/**
 * @typedef {{kind: "vertex"|"edge"|"fold"|"garment", ids: string[]}} Selection
 * An edge is named by the vertex that it starts at.
 */
/**
 * What a suggestion, a quick fix or a proposal would change; with the layers of the cloth as it would lie.
 * @typedef {PlanChange & {drawing?: Drawing, version?: number, layers?: Pick<Layer, "polygon"|"face">[]}} Preview
 */

export class Store extends EventTarget {
  /** @param {string} id the document's */
  constructor(id) {
    super();
    this.id = id;
    /** @type {DocumentState|null} what the server told last */
    this.state = null;
    /** @type {PlanMessage|null} */
    this.plan = null;
    /** @type {Playback|null} what the server told last */
    this.playback = null;
    this.isLive = false;
    /** Whether there was a connection, and is none now. */
    this.isLost = false;
    /** @type {Selection|null} */
    this.selection = null;
    /** Which moment of the folds the board shows: 0 = spread out. */
    this.step = 0;
    /** @type {Set<string>} */
    this.overlays = new Set();
    /** @type {string[]} the overlays of them that are being worked out and were not known before */
    this.pending = [];
    /** @type {number|null} seconds */
    this.hoverTime = null;
    /** What Undo would take back of what is being drawn, before any step; empty for nothing. */
    this.begun = "";
    /** @type {Preview|null} a suggestion's change that is pointed at */
    this.preview = null;
    this.queue = new EditQueue(this);
    this.live = this.listen();
  }

  /** The path of what a program may ask of the document, as its files. */
  get path() {
    return `../api/documents/${this.id}`;
  }

  /** The number of moments that can be shown, at least one. */
  get moments() {
    return Math.max(this.state?.steps.length ?? 0, 1);
  }

  /** @returns {Live} */
  listen() {
    const live = new Live(this.id);
    let isFirst = true; // after a restart the server's versions may begin lower
    live.addEventListener("open", () => (isFirst = true));
    live.addEventListener("lost", () => {
      this.isLost = this.isLost || this.isLive;
      this.isLive = false;
      this.tell("connection");
    });
    live.addEventListener("gone", () => this.tell("gone"));
    /** @param {Event} event */
    const told = (event) => /** @type {CustomEvent} */ (event).detail;
    live.addEventListener("problem", (event) => this.refuse(told(event).detail));
    live.addEventListener("document", (event) => {
      this.take(told(event), isFirst);
      isFirst = false;
    });
    live.addEventListener("plan", (event) => {
      this.plan = told(event);
      this.tell("plan");
      if (this.isLive) return;
      this.isLost = false;
      this.isLive = true; // not before: until the server has said all, what is known is of before
      this.tell("connection");
    });
    live.addEventListener("playback", (event) => {
      this.playback = told(event);
      this.tell("playback");
    });
    return live;
  }

  /**
   * Take over what the server says about the document, unless something newer is known.
   * @param {DocumentState} state
   * @param {boolean} always whether it is the truth however old it looks
   */
  take(state, always = false) {
    if (!always && this.state && state.version < this.state.version) return;
    this.state = state;
    tellArms(state.robot.arms);
    this.forgetWhatIsGone();
    this.tell("document");
  }

  /** @param {Selection|null} selection */
  select(selection) {
    if (JSON.stringify(selection) === JSON.stringify(this.selection)) return;
    this.selection = selection;
    this.tell("selection");
  }

  /** @param {number} step is kept within what can be shown */
  showStep(step) {
    const kept = Math.min(Math.max(step, 0), this.moments - 1);
    if (kept === this.step) return;
    this.step = kept;
    this.tell("step");
  }

  /** @param {string} name @param {boolean} on */
  setOverlay(name, on) {
    if (this.overlays.has(name) === on) return;
    if (on) this.overlays.add(name);
    else this.overlays.delete(name);
    this.tell("overlays");
  }

  /** @param {string[]} names */
  setPending(names) {
    if (names.join() === this.pending.join()) return;
    this.pending = names;
    this.tell("pending");
  }

  /** @param {number|null} t_s */
  setHoverTime(t_s) {
    if (t_s === this.hoverTime) return;
    this.hoverTime = t_s;
    this.tell("hover-time");
  }

  /** @param {string} part */
  setBegun(part) {
    if (part === this.begun) return;
    this.begun = part;
    this.tell("begun");
  }

  /** @param {Preview|null} change */
  setPreview(change) {
    this.preview = change;
    this.tell("preview");
  }

  /**
   * Change the drawing. Changes are sent one after the other; of a gesture's previews that wait only the last one.
   * All changes of a gesture are made to the drawing as it was before the gesture.
   * @param {string} label the name of the step
   * @param {Change} change alters the copy it is given, or returns another drawing
   * @param {{phase?: "preview"|"commit", coalesce?: string|null, gesture?: string|null}} how
   * @returns {Promise<DocumentState|null>} the state after it; null when it was refused or a later preview replaced it
   */
  edit(label, change, { phase = "commit", coalesce = null, gesture = null } = {}) {
    return this.queue.edit({ label, change, phase, coalesce, gesture });
  }

  /** Take a gesture's previews back. @param {string} gesture */
  cancel(gesture) {
    return this.queue.cancel(gesture);
  }

  /** Settled when all that was asked for so far is done. */
  settled() {
    return this.queue.push(async () => this.state);
  }

  undo() {
    return this.queue.change({ do: "undo" });
  }

  redo() {
    return this.queue.change({ do: "redo" });
  }

  /**
   * Another garment in place of this one.
   * @param {string|Garment} garment its name, or a garment file
   * @param {string|null} label the name of the step
   * @param {boolean} arcs whether edges that stand for arcs become curves
   */
  open(garment, label = null, arcs = false) {
    return this.queue.change({ do: "put_garment", garment, label, arcs }, (before) => {
      this.select(null);
      this.showStep(0);
      this.dispatchEvent(new CustomEvent("opened", { detail: before }));
    });
  }

  /** Have another robot fold, with the scene that suits it. @param {string} robot its name */
  putRobot(robot) {
    return this.queue.change({ do: "put_robot", robot });
  }

  /** @param {Command} command */
  command(command) {
    this.live.send(command);
  }

  /**
   * Send a change or a question, and wait for its answer; see `Live.ask`.
   * @param {Command} command
   * @param {AbortSignal} [signal]
   */
  ask(command, signal) {
    return this.live.ask(command, signal);
  }

  /** Tell the reader that something was not done. @param {string} detail a sentence */
  refuse(detail) {
    this.dispatchEvent(new CustomEvent("refused", { detail }));
  }

  forgetWhatIsGone() {
    if (!this.state) return;
    const { outline, folds } = this.state.drawing;
    if (this.selection && this.selection.kind !== "garment") {
      const known = new Set((this.selection.kind === "fold" ? folds : outline).map((item) => item.id));
      const ids = this.selection.ids.filter((id) => known.has(id));
      this.select(ids.length ? { kind: this.selection.kind, ids } : null);
    }
    this.showStep(this.step);
  }

  /** @param {string} name */
  tell(name) {
    this.dispatchEvent(new Event(name));
  }
}
