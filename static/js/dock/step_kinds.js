/**
 * The kinds of steps on the page: how each is told and drawn. Their names stand in the catalogues (`kind.…`), their
 * colours in `css/kinds.css`.
 */

import { say, translated } from "../language/say.js";
import { length } from "../messages/lengths.js";
import { place } from "../messages/names.js";

/** @import { Primitive } from "pleat" */

/** @typedef {{name?: string}[]} Folds the garment's */

/**
 * @template [P=any]
 * @typedef {object} StepKind
 * @property {"part"|"cloth"|"base"} moves what it moves: a part of the cloth, turned over; the cloth as a whole, along
 *   the table; or the base alone, to another station
 * @property {string} icon the path of its picture, 16 x 16
 * @property {(step: P, folds: Folds) => string} what what a step does
 * @property {(step: P, folds: Folds) => string} briefly the same where space is scarce
 * @property {(step: P, folds: Folds) => string} lane the same on the lane of what makes it
 */

/** What a fold is called. @param {{name?: string}|undefined} fold @param {number} index */
export const foldName = (fold, index) => translated(fold?.name ?? "") || say("fold.numbered", { number: index + 1 });

/** @param {{fold: number}} step @param {Folds} folds */
const named = ({ fold }, folds) => foldName(folds[fold], fold);

/** @param {{distance_m: number}} step */
const dragged = ({ distance_m: distance }) => say("step_words.drag", { length: length(distance) });

/** @type {{[K in Primitive["kind"]]: StepKind<Extract<Primitive, {kind: K}>>}} */
export const STEP_KINDS = {
  fold: {
    moves: "part",
    icon: "M2.5 12.5h11M4 10.5C4 6 12 6 12 10M9.8 8.2 12 10.4l2-2.3",
    what: named,
    briefly: named,
    lane: named,
  },
  drag: {
    moves: "cloth",
    icon: "M13 8H3.5M7 4.2 3.2 8 7 11.8",
    what: ({ distance_m: distance }) => say("step_words.towards_robot", { length: length(distance) }),
    briefly: dragged,
    lane: () => say("lane.drag"),
  },
  arm_drag: {
    moves: "cloth",
    icon: "M8 13V4M4.5 7.4 8 3.8l3.5 3.6M3 13h10",
    what: ({ distance_m: distance }) => say("step_words.by_arms", { length: length(distance) }),
    briefly: dragged,
    lane: () => say("lane.drag"),
  },
  move: {
    moves: "base",
    icon: "M3 13V9.5a4 4 0 0 1 4-4h5.5M9.6 2.4l3 3.1-3 3.1",
    what: ({ from, to }) => say("step_words.from_to", { from: place(from), to: place(to) }),
    briefly: ({ to }) => say("step_words.drive_to", { place: place(to) }),
    lane: ({ to }) => place(to),
  },
};

/** @param {Primitive} step @returns {StepKind} */
export const kindOf = (step) => STEP_KINDS[step.kind];

/** The fold that a step makes; undefined where it makes none. @param {Primitive} step @returns {number|undefined} */
export const foldOf = (step) => ("fold" in step ? step.fold : undefined);

/** Whether the hands keep hold after a step. @param {Primitive} step */
export const holdsOn = (step) => "holds" in step && step.holds;
