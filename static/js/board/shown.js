/** What the board shows: the drawing, as it is or as it is being dragged, at one moment of its folds. */

import { cross } from "./geometry.js";

const EMPTY = { outline: [], folds: [], placement: { x_m: 0, y_m: 0, yaw_rad: 0 } };
const NOTHING = { silhouette: [], flap: [] };

export class Shown {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    this.store = store;
    /** @type {any} the drawing as it is while it is dragged */
    this.draft = null;
    /** @type {((drawing: any) => void)|null} what makes it of the drawing that the server knows */
    this.change = null;
    /** @type {import("./tools/tool.js").Tool|null} */
    this.tool = null;
    /** @type {import("./fold_paint.js").FoldPaint|null} */
    this.paint = null;
    /** @type {import("./layers.js").Layers|null} */
    this.layerStack = null;
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
    return this.tool?.name === "place";
  }

  /** The cloth at the moment that is shown. */
  get shown() {
    if (this.isSpread) return { silhouette: this.spreadRings, flap: [] };
    return this.state?.steps[this.step] ?? NOTHING;
  }

  get spreadRings() {
    const ring = this.drawing.outline.map(({ point }) => point);
    return ring.length >= 3 ? [ring] : [];
  }

  /** What a fold that is drawn now would end on. */
  get rings() {
    return this.tool?.name === "fold" && this.paint.kind === "red" ? this.shown.flap : this.shown.silhouette;
  }

  get layers() {
    return this.layerStack.at(this.step);
  }

  get foldEnds() {
    return this.drawing.folds.slice(this.step).flatMap(({ start, end }) => [start.point, end.point]);
  }

  /** Whether the outline is drawn counter-clockwise. */
  get turnsLeft() {
    const ring = this.drawing.outline.map(({ point }) => point);
    return ring.reduce((sum, point, index) => sum + cross(point, ring[(index + 1) % ring.length]), 0) > 0;
  }

  /** The fold whose grips are shown: the selected one, or the next one where that is asked for. */
  get foldLookedAt() {
    const { selection, overlays } = this.store;
    if (selection?.kind === "fold") return this.drawing.folds.findIndex(({ id }) => id === selection.ids[0]);
    return overlays.has("grips") ? this.step : null;
  }

  isSelected(kind, id) {
    const { selection } = this.store;
    return selection?.kind === kind && selection.ids.includes(id);
  }

  fold(id) {
    return this.drawing.folds.find((fold) => fold.id === id);
  }

  /** The outlines that a fold ends on. */
  ringsOf(id) {
    const index = this.drawing.folds.findIndex((fold) => fold.id === id);
    const steps = this.state?.steps ?? [];
    const step = steps[index] ?? steps.at(-1) ?? NOTHING;
    return this.fold(id)?.kind === "red" ? step.flap : step.silhouette;
  }

  /** @param {(drawing: any) => void} change */
  showDraft(change) {
    this.change = change;
    this.redraft();
    this.render();
  }

  /** @param {any} [change] only if this is the one shown */
  dropDraft(change = this.change) {
    if (change === this.change) this.draft = this.change = null;
    this.render();
  }

  /** Make the change again to what the server said last: folds have gone along. */
  redraft() {
    if (!this.change || !this.state) return;
    this.draft = structuredClone(this.state.drawing);
    this.change(this.draft);
  }
}
