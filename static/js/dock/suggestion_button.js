/** A suggestion as a button: pointed at, its effect is shown on board and 3D view; pressed, it is done as one step. */

import { ringOf } from "../board/curves.js";
import { insertFold } from "../board/edits.js";
import { times } from "../board/geometry.js";
import { freshId } from "../board/ids.js";
import { button, element } from "../dom.js";
import { say } from "../language/say.js";
import { addedFold } from "../messages/changes.js";
import { inWords } from "../messages/in_words.js";
import { PointedPlan } from "../pointed_plan.js";
import { capital, seconds } from "./words.js";

/** @import { Preview } from "../store.js" */
/** @import { Drawing, Fold, FoldEnd, GarmentFold, Point } from "pleat" */

/** @typedef {import("../store.js").Store} Store */
/** @typedef {import("./suggestion_search.js").Suggestion} Suggestion */

const LONGEST = 200;

/** @param {Store} store @param {Suggestion} suggestion @param {string} className @returns {HTMLButtonElement} */
export function suggestionButton(store, suggestion, className) {
  const { cost_s: cost, is_assumption: isAssumed } = suggestion;
  const parts = [element("span", "suggestion-what", suggestionWords(store, suggestion))];
  if (cost !== null) parts.push(element("span", "suggestion-cost", seconds(cost)));
  const made = button(`suggestion ${className}`, () => {}, ...parts);
  if (isAssumed) parts[0].prepend(element("span", "tag", say("suggestion.assumption")), " ");
  made.dataset.kind = suggestion.kind;
  offer(store, suggestion, made);
  return made;
}

/** @param {Store} store @param {Suggestion} suggestion */
export const suggestionWords = (store, suggestion) => capital(inWords(suggestion, store.state?.drawing.folds ?? []));

/**
 * Have a button show what a suggestion does while it is pointed at, and do it when it is pressed.
 * @param {Store} store
 * @param {Suggestion} suggestion
 * @param {HTMLElement} made
 */
export function offer(store, suggestion, made) {
  const { change } = suggestion;
  const what = suggestionWords(store, suggestion);
  const plan = new PointedPlan(store, suggestion.plan_id);
  const point = () => {
    store.setPreview(change);
    plan.point();
  };
  const leave = () => {
    store.setPreview(null);
    plan.leave();
  };
  made.addEventListener("click", () => {
    leave();
    const isStillMeant = () => !change.drawing || change.version === store.state?.version;
    const added = addedFold(suggestion.says, store.state?.drawing.folds ?? []);
    store.edit(what.slice(0, LONGEST), (drawing) => (isStillMeant() ? applyChange(drawing, change, added) : drawing));
  });
  for (const name of ["pointerenter", "focus"]) made.addEventListener(name, point);
  for (const name of ["pointerleave", "blur"]) made.addEventListener(name, leave);
}

/** @typedef {{index: number, name: string}} Added */

const SAME_M = 1e-9;

/**
 * @param {Drawing} drawing is altered
 * @param {Preview} change fields of a plan request, or the whole drawing as it is to be
 * @param {Added|null} added the fold that the change adds
 * @returns {Drawing|void} another drawing in place of the altered one, if there is one
 */
export function applyChange(drawing, change, added = null) {
  if (change.drawing) return structuredClone(change.drawing);
  if (change.garment?.outline) resize(drawing, change.garment.outline);
  drawing.robot = change.robot ?? drawing.robot;
  drawing.placement = change.placement ?? drawing.placement;
  drawing.scene = change.scene ?? drawing.scene;
  drawing.start_station = change.start_station ?? drawing.start_station;
  drawing.comfort_radius_m = change.comfort_radius_m ?? drawing.comfort_radius_m;
  if (change.garment) {
    const before = drawing.grip_radius_m;
    drawing.grip_radius_m = change.garment.grip_radius_m ?? before;
    if (added) insertFold(drawing, added.index, newFold(drawing, added.name));
    drawing.folds = changedFolds(drawing, change.garment.folds, before);
  }
}

/**
 * Make the drawing as large as a garment of the same shape; folds stay where they are tied.
 * @param {Drawing} drawing
 * @param {Point[]} outline
 */
function resize(drawing, outline) {
  const ring = ringOf(drawing);
  const farthest = ring.reduce((best, point, index) => (Math.hypot(...point) > Math.hypot(...ring[best]) ? index : best), 0);
  if (ring.length !== outline.length || is(ring[farthest], outline[farthest])) return;
  const share = Math.hypot(...outline[farthest]) / Math.hypot(...ring[farthest]);
  for (const corner of drawing.outline) corner.point = times(corner.point, share);
  for (const end of drawing.folds.flatMap((fold) => [fold.start, fold.end])) end.point = times(end.point, share);
}

/** A fold whose line is told with the others. @param {Drawing} drawing @param {string} name */
const newFold = ({ folds }, name) => {
  const nowhere = { point: /** @type {Point} */ ([0, 0]), on: null };
  return { id: freshId("f", folds), name, kind: /** @type {const} */ ("blue"), start: nowhere, end: nowhere };
};

/**
 * The drawing's folds in the order and along the lines of a garment's; those that stay keep their ties. Where the
 * garment's grip radius was another before, each fold says its own.
 * @param {Drawing} drawing
 * @param {GarmentFold[]} wanted
 * @param {number} before the garment's grip radius (m)
 * @returns {Fold[]}
 */
function changedFolds(drawing, wanted, before) {
  /** @param {number|null|undefined} radius */
  const isUsual = (radius) => radius === before && radius === drawing.grip_radius_m;
  const left = [...drawing.folds];
  const taken = wanted.map((fold, index) => take(left, fold, drawing.folds[index]));
  const isReordered = taken.some((fold, index) => fold !== drawing.folds[index]);
  return wanted.map((fold, index) => ({
    ...taken[index],
    start: end(taken[index].start, fold.start, isReordered),
    end: end(taken[index].end, fold.end, isReordered),
    grip_radius_m: isUsual(fold.grip_radius_m) ? null : fold.grip_radius_m,
  }));
}

/**
 * The fold that is meant: the same line, else the one at the same place, else any that is left.
 * @param {Fold[]} left
 * @param {GarmentFold} fold
 * @param {Fold} atSamePlace
 */
function take(left, fold, atSamePlace) {
  /** @param {Fold} own */
  const isSame = (own) => own.name === fold.name && is(own.start.point, fold.start) && is(own.end.point, fold.end);
  const found = left.find(isSame) ?? left.find((own) => own === atSamePlace) ?? left[0];
  left.splice(left.indexOf(found), 1);
  return found;
}

/**
 * An end; where the line or what comes before it has changed, the server ties it anew.
 * @param {FoldEnd} own
 * @param {Point} point
 * @param {boolean} isReordered
 * @returns {FoldEnd}
 */
function end(own, point, isReordered) {
  return !isReordered && is(own.point, point) ? own : { point, on: null };
}

/** @param {Point} a @param {Point} b */
const is = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]) <= SAME_M;
