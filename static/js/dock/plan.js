/** The list `Plan`: one row for each primitive; a click goes to its start. */

import { unit } from "../board/units.js";
import { button, element } from "../dom.js";
import { drawnIcon } from "../icons.js";
import { say } from "../language/say.js";
import { present } from "../present.js";
import { primitiveAt } from "./lane_blocks.js";
import { layersPicture } from "../suggestions/folded_picture.js";
import { inAWord } from "../rehearsal/words.js";
import { markStep } from "./step_menu.js";
import { place } from "../messages/names.js";
import { foldOf, holdsOn, kindOf } from "./step_kinds.js";
import { briefly, hands, seconds, where, whole } from "./words.js";

/** @import { Fold, Plan, Primitive } from "pleat" */
/** @import { Verdict } from "../rehearsal/rehearsal.js" */

export class PlanList {
  /**
   * @param {import("../store.js").Store} store
   * @param {import("./clock.js").Clock} clock
   * @param {import("../step_pictures.js").StepPictures} pictures
   * @param {(t_s: number) => void} onSeek
   */
  constructor(store, clock, pictures, onSeek) {
    this.store = store;
    this.clock = clock;
    this.onSeek = onSeek;
    this.root = element("ol", "plan-list");
    this.root.setAttribute("aria-label", say("plan.label"));
    /** What is shown: plan, folds and unit. */
    this.shown = "";
    /** @type {Plan|null} */
    this.plan = null;
    this.current = -1;
    this.pictures = pictures;
    clock.addEventListener("tick", () => this.tick());
    pictures.addEventListener("change", () => this.illustrate());
  }

  /** @param {Plan|null} plan @param {Fold[]} folds of the drawing */
  show(plan, folds) {
    const wanted = JSON.stringify([unit.name, plan?.id, folds.map(({ name, kind }) => [name, kind])]);
    if (wanted === this.shown) return;
    this.shown = wanted;
    this.plan = plan;
    this.root.replaceChildren(...(plan?.primitives ?? []).map((primitive, index) => this.row(primitive, index, folds)));
    this.current = -1;
    this.illustrate();
    this.tick();
  }

  /** Show in each row the cloth as its step leaves it, as soon as that is known. */
  illustrate() {
    const { all, id } = this.pictures;
    if (id !== this.plan?.id) return;
    for (const [index, row] of [...this.root.children].entries()) {
      const shown = all[index + 1];
      const place = row.querySelector(".plan-picture");
      if (!shown || !place) continue;
      place.replaceChildren(layersPicture(shown.layers, shown.placement.yaw_rad + Math.PI / 2));
    }
  }

  /** Write in each row what became of its step in a rehearsal. @param {Map<number, Verdict>} verdicts by step */
  judge(verdicts) {
    for (const [index, row] of [...this.root.children].entries()) {
      const shown = /** @type {HTMLElement} */ (row.firstElementChild);
      shown.querySelector(".plan-verdict")?.remove();
      const verdict = verdicts.get(index);
      shown.setAttribute("aria-label", verdict ? `${shown.title}, ${inAWord(verdict)}` : shown.title);
      if (!verdict) continue;
      const mark = element("span", "plan-verdict", inAWord(verdict));
      mark.dataset.isHeld = String(verdict.held);
      shown.append(mark);
    }
  }

  tick() {
    const now = this.clock.now;
    const current = primitiveAt(this.plan, now);
    if (current !== this.current) this.mark(current);
    const primitive = this.plan?.primitives[current];
    const row = /** @type {HTMLElement|undefined} */ (this.root.children[current]);
    if (!primitive || !row) return;
    const share = Math.min((now - primitive.start_s) / primitive.duration_s, 1);
    row.style.setProperty("--share", share.toFixed(4));
  }

  /** @param {number} current the primitive that is going on */
  mark(current) {
    const { children } = this.root;
    [...children].forEach((row, index) => {
      row.classList.toggle("is-done", index < current);
      const shown = /** @type {HTMLElement} */ (row.firstElementChild);
      if (index === current) shown.setAttribute("aria-current", "step");
      else shown.removeAttribute("aria-current");
    });
    this.current = current;
    const isMoving = this.clock.told.playing || this.clock.now > 0;
    if (isMoving && children[current]) this.bringIntoView(/** @type {HTMLElement} */ (children[current]));
  }

  /** Scroll the list, and nothing else. @param {HTMLElement} row */
  bringIntoView(row) {
    const frame = this.root.parentElement;
    if (!frame) return;
    const [box, seen] = [row.getBoundingClientRect(), frame.getBoundingClientRect()];
    if (box.top < seen.top) frame.scrollTop -= seen.top - box.top;
    if (box.bottom > seen.bottom) frame.scrollTop += box.bottom - seen.bottom;
  }

  /** @param {Primitive} primitive @param {number} index @param {Fold[]} folds */
  row(primitive, index, folds) {
    const name = element("span", "plan-name", briefly(primitive, folds));
    const by = hands(primitive);
    const at = kindOf(primitive).moves === "base" ? "" : place(primitive.base.station);
    const about = element("span", "plan-about", ...present([by && element("b", "arm", by), at]));
    const shown = button(
      "plan-row",
      () => this.onSeek(primitive.start_s),
      element("span", "plan-picture"),
      drawnIcon(kindOf(primitive).icon),
      name,
      about,
      element("span", "plan-cost", seconds(primitive.duration_s)),
    );
    markStep(shown, index);
    const fold = foldOf(primitive);
    if (fold !== undefined) shown.dataset.colour = folds[fold]?.kind ?? "";
    shown.title = told(primitive, folds);
    shown.setAttribute("aria-label", shown.title);
    shown.addEventListener("pointerenter", () => this.store.setHoverTime(primitive.start_s));
    shown.addEventListener("pointerleave", () => this.store.setHoverTime(null));
    return element("li", "", shown);
  }
}

/** A row as it is read out. @param {Primitive} primitive @param {Fold[]} folds */
function told(primitive, folds) {
  const by = hands(primitive);
  const at = where(primitive);
  const how = [by && say("lane.by_hands", { hands: by }), at && say("lane.at", { place: at })];
  const parts = [whole(primitive, folds), ...how, holdsOn(primitive) ? say("lane.holds_on") : "", seconds(primitive.duration_s)];
  return parts.filter(Boolean).join(", ");
}
