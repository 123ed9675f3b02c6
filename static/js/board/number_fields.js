/** The numbers of what is selected: what each is called, what it is, and what changes when another one is written. */

import { numeral } from "../language/numeral.js";
import { inEnglish, say } from "../language/say.js";
import { edgeFrom, edgePoints, handleOf } from "./curves.js";
import { middleOf, moveFold } from "./edits.js";
import { distance, left, lengthOf, minus, plus, times, toOuter, unit as direction } from "./geometry.js";
import { freshId } from "./ids.js";
import { bendEdge, cutNotch, moveCorners } from "./outline_edits.js";
import { CURVE_MAX, MOVE_CORNER } from "./rules.js";
import { atLength } from "./snap.js";
import { laid } from "./tools/place.js";
import { evaluated, length, number, parsed, problemOf } from "./units.js";

/** @import { Drawing, Fold, Point } from "pleat" */

const DEGREE = Math.PI / 180;

/** @typedef {{key?: string, label: string, name: string, value: string, put: (text: string) => string}} Field */
/** @typedef {{label: string, name: string, act: () => void}} Act what a button beside the fields does */
/** @typedef {(metres: number, drawing: Drawing) => void} Put */
/** @typedef {{key: string, at: Point, fields: Field[], acts?: Act[]}|null} Found */

export class NumberFields {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
  }

  /** @returns {Found} */
  found() {
    const { kind, ids } = this.board.store.selection ?? {};
    if (this.board.isPlacing) return this.ofPlacement();
    if (ids?.length !== 1) return null;
    const [id] = ids;
    if (kind === "vertex" && this.board.isSpread) return this.ofCorner(id);
    if (kind === "edge" && this.board.isSpread) return this.ofEdge(id);
    return kind === "fold" ? this.ofFold(id) : null;
  }

  /** @param {string} id @returns {Found} */
  ofCorner(id) {
    const corner = this.board.drawing.outline.find((other) => other.id === id);
    if (!corner) return null;
    /** @param {0|1} axis @returns {Field} */
    const field = (axis) => ({
      label: "xy"[axis],
      name: say("numbers.coordinate", { axis: "xy"[axis] }),
      value: number(corner.point[axis]),
      put: (text) =>
        this.move(
          text,
          (metres, drawing) => {
            const now = drawing.outline.find((other) => other.id === id)?.point ?? corner.point;
            moveCorners(drawing, new Map([[id, withPart(now, axis, metres)]]));
          },
          MOVE_CORNER,
        ),
    });
    return { key: id, at: this.board.view.toPx(corner.point), fields: [field(0), field(1)] };
  }

  /** @param {string} id @returns {Found} */
  ofEdge(id) {
    const { drawing, view } = this.board;
    const [a, b] = edgeFrom(drawing, id) ?? [];
    if (!a || !b) return null;
    /** @type {Field} */
    const field = {
      label: say("numbers.length"),
      name: say("numbers.edge_length"),
      value: number(distance(a.point, b.point)),
      put: (text) =>
        this.move(
          text,
          (metres, changed) => moveCorners(changed, new Map([[b.id, atLength(a.point, b.point, metres)]])),
          inEnglish("step.edge_length"),
          0.001,
        ),
    };
    const notch = { label: say("numbers.notch"), name: say("numbers.notch_name"), act: () => this.notch(id) };
    const acts = a.curve ? [] : [notch];
    return { key: id, at: view.toPx(handleOf(a, b)), fields: [field, this.ofBulge(id)], acts };
  }

  /** How far an edge's middle is outside of its chord. @param {string} id @returns {Field} */
  ofBulge(id) {
    const outwards = this.board.turnsLeft ? -1 : 1;
    const across = edgeFrom(this.board.drawing, id)?.[0].curve?.across ?? 0;
    /** @param {Drawing} drawing @returns {[Point, Point, Point]} */
    const ends = (drawing) => {
      const [a, b] = edgeFrom(drawing, id) ?? [];
      return a && b ? [a.point, b.point, handleOf(a, b)] : [[0, 0], [0, 0], [0, 0]];
    };
    const [from, to] = ends(this.board.drawing);
    const most = CURVE_MAX * distance(from, to);
    return {
      key: "bulge",
      label: say("numbers.bulge"),
      name: say("numbers.bulge_name"),
      value: number(across * outwards * distance(from, to)),
      put: (text) => {
        const metres = parsed(text);
        if (metres !== null && Math.abs(metres) > most) return say("length.too_much", { text, most: length(most) });
        return this.move(
          text,
          (bulge, drawing) => {
            const [a, b, handle] = ends(drawing);
            const way = left(direction(minus(b, a)));
            const now = edgeFrom(drawing, id)?.[0].curve?.across ?? 0;
            bendEdge(drawing, id, plus(handle, times(way, bulge * outwards - now * distance(a, b))));
          },
          inEnglish("step.bend_edge"),
        );
      },
    };
  }

  /** @param {string} id the edge's */
  notch(id) {
    const { store, drawing, turnsLeft } = this.board;
    const first = freshId("v", drawing.outline);
    const second = freshId("v", [...drawing.outline, { id: first }]);
    store.edit(inEnglish("step.cut_notch"), (changed) => cutNotch(changed, id, [first, second], turnsLeft));
    store.select({ kind: "edge", ids: [first] });
  }

  /** @param {string} id @returns {Found} */
  ofFold(id) {
    const fold = this.board.fold(id);
    if (!fold) return null;
    const fields = [...this.ofEnd(fold, "start"), ...this.ofEnd(fold, "end")];
    return fields.length ? { key: id, at: this.board.view.toPx(fold.end.point), fields } : null;
  }

  /**
   * How far along its edge an end is; of an end at a corner or on a crease there is nothing to say.
   * @param {Fold} fold
   * @param {"start"|"end"} end
   * @returns {Field[]}
   */
  ofEnd(fold, end) {
    const { on } = fold[end];
    if (on?.kind !== "edge") return [];
    const whole = this.along(on.from, on.to);
    if (!whole) return [];
    /** @type {Put} */
    const put = (metres, drawing) =>
      moveFold(drawing, fold.id, {
        [end]: { point: fold[end].point, on: { ...on, fraction: Math.min(metres / whole, 1) } },
      });
    return [
      {
        label: say(`numbers.${end}`),
        name: say(`numbers.${end}_along`),
        value: number(on.fraction * whole),
        put: (text) => this.move(text, put, inEnglish("step.move_fold"), 0),
      },
    ];
  }

  /** How long it is from corner to corner, along a curve where that is their edge (m). @param {string} from @param {string} to */
  along(from, to) {
    const edge = edgeFrom(this.board.drawing, from);
    if (edge?.[1].id === to) return lengthOf(edgePoints(...edge));
    const [a, b] = [from, to].map((id) => this.board.drawing.outline.find((corner) => corner.id === id)?.point);
    return a && b ? distance(a, b) : 0;
  }

  /** @returns {Found} */
  ofPlacement() {
    const { drawing, view } = this.board;
    if (!drawing.outline.length) return null;
    const middle = middleOf(drawing);
    const { placement } = drawing;
    const centre = toOuter(placement, middle);
    /** @param {0|1} axis @returns {Field} */
    const place = (axis) => ({
      label: [say("numbers.ahead"), say("numbers.left")][axis],
      name: [say("numbers.ahead_of_middle"), say("numbers.left_of_middle")][axis],
      value: number(centre[axis]),
      put: (text) =>
        this.move(
          text,
          (metres, changed) => {
            changed.placement = laid(withPart(centre, axis, metres), middle, placement.yaw_rad);
          },
          inEnglish("step.place_garment"),
        ),
    });
    /** @type {Field} */
    const turn = {
      label: say("numbers.turn"),
      name: say("numbers.turn_name"),
      value: numeral(placement.yaw_rad / DEGREE, 1, 0),
      put: (text) => {
        const degrees = evaluated(text.replace("\u00B0", "").trim().replaceAll(",", "."));
        if (degrees === null) return say("numbers.no_degrees", { text });
        this.board.store.edit(
          inEnglish("step.turn_garment"),
          (changed) => void (changed.placement = laid(centre, middle, degrees * DEGREE)),
        );
        return "";
      },
    };
    return { key: "place", at: [view.width, 0], fields: [place(0), place(1), turn] };
  }

  /**
   * Make a change of a length that was written, or tell what is wrong with it.
   * @param {string} text
   * @param {Put} change
   * @param {string} label the name of the step
   * @param {number} [least] (m)
   * @returns {string}
   */
  move(text, change, label, least = undefined) {
    const problem = problemOf(text, least);
    const metres = parsed(text);
    if (!problem && metres !== null) this.board.store.edit(label, (drawing) => change(metres, drawing));
    return problem;
  }
}

/**
 * A point with one of its coordinates replaced.
 * @param {Point} point
 * @param {0|1} axis
 * @param {number} value
 * @returns {Point}
 */
const withPart = ([x, y], axis, value) => (axis === 0 ? [value, y] : [x, value]);
