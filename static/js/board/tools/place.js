/** The tool `Place`: the garment on the table, seen from above; it is dragged, and turned by its handle. */

import { ringOf } from "../curves.js";
import { inEnglish, say } from "../../language/say.js";
import { BASE_M } from "../draw_table.js";
import { middleOf } from "../edits.js";
import { boxOf, distance, isInside, minus, plus, times, toOuter, turned } from "../geometry.js";
import { Gesture } from "../gesture.js";
import { Tool } from "./tool.js";

/** @import { Drawing, Point, Pose } from "pleat" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Items } from "../sheet.js" */

const HANDLE_PX = 34;
const HIT_PX = 14;
const TOUCH_PX = 24;
const ROUND_M = 0.01;
const SNAP_PX = 4;
const SQUARE_RAD = (4 * Math.PI) / 180;
/** What holds the garment's middle, by how many of the table's middle lines it is on. */
const MIDDLES = ["", say("snap.table_middle"), say("snap.table_centre")];
const TURN_RAD = Math.PI / 12;
const NUDGE_TURN_RAD = Math.PI / 36;
/** @type {Record<string, number>} */
const TURNS = { ",": NUDGE_TURN_RAD, ".": -NUDGE_TURN_RAD };

/**
 * What was pressed, and how the garment lay then.
 * @typedef {object} Held
 * @property {"turn"|"move"|null} grasp
 * @property {Point} plane where it was pressed, in the plane that is shown (m)
 * @property {Point} px
 * @property {Pose} placement
 * @property {Point} middle the garment's (garment frame, m)
 * @property {Point} centre the same on the table (m)
 */

export class PlaceTool extends Tool {
  /** @param {import("../board.js").Board} board */
  constructor(board) {
    super(board, "place", "default");
    /** @type {Held|null} */
    this.held = null;
    /** @type {Gesture|null} */
    this.gesture = null;
  }

  get hint() {
    return say("hint.place");
  }

  enter() {
    this.board.store.select({ kind: "garment", ids: [] });
  }

  /** The garment's middle, garment frame. */
  get middle() {
    return middleOf(this.board.drawing);
  }

  /** The handle's place and where it is tied to (px). */
  get handle() {
    const box = boxOf(ringOf(this.board.drawing));
    if (!box) return null;
    const { view } = this.board;
    const foot = view.toPx([this.middle[0], box.high[1]]);
    const beyond = view.toPx([this.middle[0], box.high[1] + HANDLE_PX / view.scale]);
    return { foot, knob: beyond };
  }

  /** @param {Pointer} pointer */
  grasp(pointer) {
    const handle = this.handle;
    if (handle && distance(pointer.px, handle.knob) <= (pointer.isTouch ? TOUCH_PX : HIT_PX)) return "turn";
    return isInside(pointer.at, [ringOf(this.board.drawing)]) ? "move" : null;
  }

  /** The station whose robot is drawn there. @param {Pointer} pointer */
  station(pointer) {
    const { view, drawing } = this.board;
    /** @param {[string, Pose]} station */
    const isThere = ([, { x_m, y_m }]) => distance(pointer.px, view.tableToPx([x_m, y_m])) <= BASE_M * view.scale;
    return Object.entries(drawing.scene.stations).find(isThere)?.[0] ?? null;
  }

  /** @param {Pointer} pointer */
  takes(pointer) {
    return this.grasp(pointer) !== null || this.station(pointer) !== null;
  }

  /** @param {Pointer} pointer */
  hover(pointer) {
    this.board.hover = null;
    const grasp = this.grasp(pointer) ?? this.station(pointer);
    this.cursor = grasp === "turn" ? "grab" : grasp === "move" ? "move" : grasp ? "pointer" : "default";
  }

  /** @param {Pointer} pointer */
  press(pointer) {
    const grasp = this.grasp(pointer);
    const { view, drawing } = this.board;
    const { placement } = drawing;
    const plane = view.pxToPlane(pointer.px);
    this.held = {
      grasp,
      plane,
      px: pointer.px,
      placement,
      middle: this.middle,
      centre: toOuter(placement, this.middle),
    };
  }

  /** @param {Pointer} pointer */
  drag(pointer) {
    if (!this.held) return;
    if (!this.held.grasp) {
      this.board.view.pan(minus(pointer.px, this.held.px));
      this.held.px = pointer.px;
      return;
    }
    const { held } = this;
    const isTurn = held.grasp === "turn";
    this.gesture ??= new Gesture(this.board, isTurn ? inEnglish("step.turn_garment") : inEnglish("step.place_garment"));
    const { placement, name } = isTurn ? this.turnedTo(pointer, held) : this.movedTo(pointer, held);
    this.board.snapped = { at: pointer.at, name, key: "", isOnCloth: false };
    this.gesture.show((drawing) => {
      drawing.placement = placement;
    });
  }

  /** @param {Pointer} pointer @param {Held} held */
  movedTo(pointer, { placement, plane, centre }) {
    const [right, up] = minus(this.board.view.pxToPlane(pointer.px), plane);
    const by = [up, -right]; // the plane's up is the table's x, its left the table's y
    const at = /** @type {Point} */ ([0, 1].map((axis) => this.rounded(centre[axis] + by[axis], pointer)));
    const kept = minus(at, centre);
    const name = MIDDLES[at.filter((value) => value === 0).length];
    return { placement: { ...placement, x_m: placement.x_m + kept[0], y_m: placement.y_m + kept[1] }, name };
  }

  /**
   * The garment's middle goes onto whole centimetres, and onto the table's middle lines.
   * @param {number} value
   * @param {Pointer} pointer
   */
  rounded(value, pointer) {
    if (pointer.ctrl || !this.board.snapper.isOn) return value;
    return Math.abs(value) * this.board.view.scale < 2 * SNAP_PX ? 0 : Math.round(value / ROUND_M) * ROUND_M;
  }

  /** @param {Pointer} pointer @param {Held} held */
  turnedTo(pointer, held) {
    const { view } = this.board;
    const centre = view.toPx(held.middle);
    const [x, y] = minus(pointer.px, centre);
    let yaw = Math.atan2(-y, x) - Math.PI; // the handle is the garment's +y, the plane's up the table's x
    let name = "";
    const square = Math.round(yaw / (Math.PI / 2)) * (Math.PI / 2);
    if (pointer.shift) [yaw, name] = [Math.round(yaw / TURN_RAD) * TURN_RAD, "15\u00B0"];
    else if (!pointer.ctrl && this.board.snapper.isOn && Math.abs(yaw - square) < SQUARE_RAD)
      [yaw, name] = [square, say("snap.square")];
    return { placement: laid(held.centre, held.middle, yaw), name };
  }

  /** @param {Pointer} pointer @param {boolean} hasMoved */
  release(pointer, hasMoved) {
    const { gesture } = this;
    const { store, drawing } = this.board;
    const station = this.held && !this.held.grasp && !hasMoved ? this.station(pointer) : null;
    if (station && station !== drawing.start_station) {
      const step = inEnglish("step.start_at", { station: station.replaceAll("_", " ") });
      store.edit(step, (changed) => void (changed.start_station = station));
    }
    this.held = null;
    this.gesture = null;
    this.board.snapped = null;
    gesture?.commit();
  }

  cancel() {
    const wasBusy = this.gesture !== null;
    this.gesture?.cancel();
    this.board.snapped = null;
    this.held = null;
    this.gesture = null;
    return wasBusy;
  }

  /** Arrow keys move it on the table; `,` and `.` turn it. @param {KeyboardEvent} event */
  key(event) {
    const { store, drawing } = this.board;
    const by = this.board.nudgeOf(event);
    const turn = TURNS[event.key];
    if (by) {
      /** @param {Drawing} changed */
      const change = (changed) => {
        changed.placement.x_m += by[1];
        changed.placement.y_m -= by[0];
      };
      store.edit(inEnglish("step.place_garment"), change, { coalesce: "nudge-place" });
    } else if (turn) {
      const { middle } = this;
      const { placement } = drawing;
      const wanted = laid(toOuter(placement, middle), middle, placement.yaw_rad + turn);
      store.edit(inEnglish("step.turn_garment"), (changed) => void (changed.placement = wanted), {
        coalesce: "nudge-turn",
      });
    } else return false;
    return true;
  }

  /** @returns {Items} */
  items() {
    const handle = this.handle;
    if (!handle) return [];
    const { foot, knob } = handle;
    return [
      { key: "stem", tag: "path", class: "yaw-stem", d: `M${foot.join(" ")}L${knob.join(" ")}` },
      { key: "knob", tag: "circle", class: "handle yaw-knob", cx: knob[0], cy: knob[1], r: 7 },
    ];
  }
}

/**
 * The placement with which a garment's point lies at a place of the table.
 * @param {Point} at
 * @param {Point} middle
 * @param {number} yaw
 * @returns {Pose}
 */
export function laid(at, middle, yaw) {
  const yaw_rad = Math.atan2(Math.sin(yaw), Math.cos(yaw));
  const [x_m, y_m] = plus(at, times(turned(middle, yaw_rad), -1));
  return { x_m, y_m, yaw_rad };
}
