/** What the board shows: the drawing, as it is or as it is being dragged, at one moment of its folds. */

import { FOLD_KINDS } from "../fold_kinds.js";
import { ringOf } from "./curves.js";
import { cross } from "./geometry.js";

/** @import { Drawing, FoldKind, Layer, Point, Step } from "pleat" */
/** @import { Change } from "../edit_queue.js" */
/** @import { Tool } from "./tools/tool.js" */
/** @import { Selection } from "../store.js" */

/** What is drawn where no document is known yet: no cloth, no table. @type {Drawing} */
const EMPTY = {
  name: "",
  title: "",
  outline: [],
  areal_density_kg_m2: 0,
  thickness_m: 0,
  grip_radius_m: 0,
  folds: [],
  placement: { x_m: 0, y_m: 0, yaw_rad: 0 },
  scene: {
    table: { depth_m: 0, width_m: 0, height_m: 0 },
    stations: {},
    torso_m: 0,
    friction: 0,
    support_angle_rad: 0,
    approach_cone_rad: 0,
    back_off_max_m: 0,
    edge_clear_m: 0,
    arm_motion_s: 0,
    grip_dwell_s: 0,
    base_speed_m_s: 0,
    base_turn_rad_s: 0,
  },
  start_station: "",
  comfort_radius_m: 0,
  robot: "",
};

/** @typedef {Pick<Step, "silhouette"|"flap">} Cloth the outlines of the cloth at a moment, and of its last flap */

/** @type {Cloth} */
const NOTHING = { silhouette: [], flap: [] };

export class Shown {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    this.store = store;
    /** @type {Drawing|null} the drawing as it is while it is dragged */
    this.draft = null;
    /** @type {Change|null} what makes it of the drawing that the server knows */
    this.change = null;
    /** @type {import("../step_pictures.js").StepPictures|null} */
    this.pictures = null;
  }

  /**
   * While the plan is played the board shows the cloth as it is then.
   * @param {import("../step_pictures.js").StepPictures} pictures
   */
  play(pictures) {
    this.pictures = pictures;
    pictures.addEventListener("change", () => this.render());
  }

  /** The cloth and where it lies at the time that is shown; null while nothing is played. */
  get played() {
    const index = this.pictures?.current ?? null;
    return index === null ? null : (this.pictures?.all[index] ?? null);
  }

  /** The layers of the cloth as a proposal that is pointed at folds it; null while none is. */
  get previewed() {
    return this.store.preview?.layers ?? null;
  }

  /** Whether time runs: the board shows the film, and nothing to edit. */
  get isPlaying() {
    return this.played !== null && Boolean(this.store.playback?.playing) && !this.isPlacing;
  }

  /** Whether time is stopped after the start: the board shows the cloth of then, below what can be edited. */
  get isStopped() {
    const { playback } = this.store;
    const hasBegun = (playback?.t_s ?? 0) > 0 && !playback?.playing;
    return this.played !== null && hasBegun && this.isSpread && !this.isPlacing && !this.draft;
  }

  /** The tool in hand; none while the board is being built. @returns {Tool|null} */
  get toolInHand() {
    return null;
  }

  /** What the next fold takes. @returns {FoldKind} */
  get kindOfNext() {
    return "blue";
  }

  /** The layers of the stack at the moment that is shown, bottom to top; null while they are not known. */
  get layers() {
    return this.layersAt(this.step);
  }

  /** @param {number} _step @returns {Layer[]|null} */
  layersAt(_step) {
    return null;
  }

  /** Draw soon. */
  render() {}

  get state() {
    return this.store.state;
  }

  get drawing() {
    return this.draft ?? this.state?.drawing ?? EMPTY;
  }

  get step() {
    return this.isPlacing ? 0 : this.store.step;
  }

  get isSpread() {
    return this.step === 0;
  }

  get isPlacing() {
    return this.toolInHand?.name === "place";
  }

  /** The cloth at the moment that is shown. @returns {Cloth} */
  get shown() {
    if (this.isSpread) return { silhouette: this.spreadRings, flap: [] };
    return this.state?.steps[this.step] ?? NOTHING;
  }

  /** @returns {Point[][]} */
  get spreadRings() {
    const ring = ringOf(this.drawing);
    return ring.length >= 3 ? [ring] : [];
  }

  /** What a fold that is drawn now would end on. */
  get rings() {
    return this.toolInHand?.name === "fold" && FOLD_KINDS[this.kindOfNext].takesFlap ? this.shown.flap : this.shown.silhouette;
  }

  get foldEnds() {
    return this.drawing.folds.slice(this.step).flatMap(({ start, end }) => [start.point, end.point]);
  }

  /** Whether the outline is drawn counter-clockwise. */
  get turnsLeft() {
    const ring = ringOf(this.drawing);
    return ring.reduce((sum, point, index) => sum + cross(point, ring[(index + 1) % ring.length]), 0) > 0;
  }

  /** The fold whose grips are shown: the selected one, or the next one where that is asked for. */
  get foldLookedAt() {
    const { selection, overlays } = this.store;
    if (selection?.kind === "fold") return this.drawing.folds.findIndex(({ id }) => id === selection.ids[0]);
    return overlays.has("grips") ? this.step : null;
  }

  /** @param {Selection["kind"]} kind @param {string} id */
  isSelected(kind, id) {
    const { selection } = this.store;
    return selection?.kind === kind && selection.ids.includes(id);
  }

  /** @param {string} id */
  fold(id) {
    return this.drawing.folds.find((fold) => fold.id === id);
  }

  /** The outlines that a fold ends on. @param {string} id */
  ringsOf(id) {
    const index = this.drawing.folds.findIndex((fold) => fold.id === id);
    const steps = this.state?.steps ?? [];
    const step = steps[index] ?? steps.at(-1) ?? NOTHING;
    return FOLD_KINDS[this.fold(id)?.kind ?? this.kindOfNext].takesFlap ? step.flap : step.silhouette;
  }

  /** @param {Change} change */
  showDraft(change) {
    this.change = change;
    this.redraft();
    this.render();
  }

  /** @param {Change|null} [change] only if this is the one shown */
  dropDraft(change = this.change) {
    if (change === this.change) this.draft = this.change = null;
    this.render();
  }

  /** Make the change again to what the server said last: folds have gone along. */
  redraft() {
    if (!this.change || !this.state) return;
    const draft = structuredClone(this.state.drawing);
    this.draft = this.change(draft) ?? draft;
  }
}
