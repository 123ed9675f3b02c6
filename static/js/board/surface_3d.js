/**
 * The 3-D view as the board's second surface: the tool in hand acts on it too. A pointer over the table means that place
 * of the cloth as it lies there, and what the board draws of tools and handles lies over the picture, in perspective.
 * Where the tool has nothing to take, the pointer moves the camera.
 */

import { svg } from "../dom.js";
import { say } from "../language/say.js";
import { isViewOnly } from "../view_only.js";
import { distance } from "./geometry.js";
import { after, applied, asTransform, back, laid, tablePicture } from "./table_picture.js";
import { View } from "./view.js";

/** @import { Point } from "pleat" */
/** @import { Board } from "./board.js" */
/** @import { LayerName } from "./draw_all.js" */
/** @import { Pointer } from "./pointer.js" */
/** @import { Projective, Scene } from "./table_picture.js" */

const DRAG_PX = 4;
/** Where cloth is drawn, over the table (m). */
const CLOTH_M = 0.0015;
const NEAR_M = 0.005;
/** What of the board is seen on the cloth; its cloth too where it is folded, since that of the 3D view is spread. @type {LayerName[]} */
const LAYERS = ["ghost", "folds", "handles", "tool", "cursor"];

/** The board's plane as the camera sees it lie on the table. */
class View3DProjection extends View {
  /** @param {Board} board */
  constructor(board) {
    super();
    this.board = board;
    /** From the table to the picture. @type {Projective} */
    this.table = [1, 0, 0, 0, 1, 0, 0, 0, 1];
    /** From the plane to the picture. */
    this.map = this.table;
  }

  /** Take the camera as it is now. @param {Partial<Scene>|undefined} scene @returns {boolean} whether there is a picture */
  look(scene) {
    const picture = tablePicture(scene, CLOTH_M);
    if (!picture) return false;
    const { view, isPlacing, drawing } = this.board;
    const { x_m, y_m, yaw_rad } = drawing.placement;
    this.pose = view.pose;
    this.table = picture;
    this.map = after(picture, isPlacing ? laid([0, 0], -Math.PI / 2) : laid([x_m, y_m], yaw_rad));
    return true;
  }

  /** Measure in pixels as they are at a place. @param {Point} px */
  measureAt(px) {
    const [x, y] = this.pxToPlane(px);
    const across = distance(this.planeToPx([x - NEAR_M, y]), this.planeToPx([x + NEAR_M, y]));
    const along = distance(this.planeToPx([x, y - NEAR_M]), this.planeToPx([x, y + NEAR_M]));
    this.scale = Math.sqrt(across * along) / (2 * NEAR_M);
  }

  /** @param {Point} p */
  planeToPx(p) {
    return applied(this.map, p);
  }

  /** @param {Point} px */
  pxToPlane(px) {
    return applied(back(this.map), px);
  }

  /** From the board's picture to this one. */
  get fromBoard() {
    const { scale, origin } = this.board.view;
    return after(this.map, [1 / scale, 0, -origin[0] / scale, 0, -1 / scale, origin[1] / scale, 0, 0, 1]);
  }
}

export class Surface3D {
  /** @param {Board} board @param {HTMLIFrameElement} frame the 3D view's */
  constructor(board, frame) {
    this.board = board;
    this.frame = frame;
    this.view = new View3DProjection(board);
    /** @type {{id: number, px: Point, hasMoved: boolean, last: Pointer}|null} */
    this.pressed = null;
    this.isOver = false;
    this.copies = svg("g", { class: "view3d-copies" });
    for (const name of /** @type {LayerName[]} */ (["cloth", ...LAYERS]))
      this.copies.append(svg("use", { href: `#board-${name}`, class: `copy-${name}` }));
    this.root = svg("svg", { class: "view3d-surface", "aria-hidden": "true" });
    this.root.append(this.copies);
    this.root.toggleAttribute("hidden", true);
    frame.after(this.root);
    if (!isViewOnly) frame.addEventListener("load", () => this.listen());
  }

  listen() {
    this.finish(); // the frame in which it was begun has gone
    const { contentWindow: inside, contentDocument } = this.frame;
    if (!inside || !contentDocument) return;
    // At the window, before anything of viser's own, so that the camera stays where a tool is at work.
    inside.addEventListener("pointerdown", (event) => this.down(event), true);
    inside.addEventListener("pointermove", (event) => this.move(event), true);
    inside.addEventListener("pointerup", (event) => this.up(event), true);
    inside.addEventListener("pointercancel", (event) => this.cancel(event), true);
    inside.addEventListener("dblclick", (event) => this.twice(event), true);
    contentDocument.documentElement.addEventListener("pointerleave", () => this.leave());
  }

  /** @returns {Partial<Scene>|undefined} */
  get scene() {
    return /** @type {{__viserMutable?: Partial<Scene>}} */ (this.frame.contentWindow ?? {}).__viserMutable;
  }

  /** Whether there is something to edit: neither while time runs nor without a server. */
  get isUsable() {
    const { board } = this;
    return Boolean(board.state) && !board.store.isLost && !board.store.playback?.playing && this.view.look(this.scene);
  }

  /** Whether the 3D view shows the cloth as it lies at the beginning. */
  get isAtStart() {
    return !this.board.store.playback?.t_s;
  }

  /** @param {MouseEvent} event @returns {Pointer} */
  pointer(event) {
    const { ctrlKey, metaKey, shiftKey: shift, altKey: alt } = event;
    /** @type {Point} */
    const px = [event.clientX, event.clientY];
    this.view.measureAt(px);
    const at = this.view.toM(px);
    this.board.pointer.last = this.board.view.toPx(at);
    return { px, at, isTouch: false, isKeyboard: false, ctrl: ctrlKey || metaKey, shift, alt };
  }

  /** Whether the tool in hand would take a press there, on the table. @param {Pointer} pointer */
  isTaken(pointer) {
    const { depth_m, width_m } = this.board.drawing.scene.table;
    const [x, y] = applied(back(this.view.table), pointer.px);
    const isOnTable = Math.abs(x) <= depth_m / 2 && Math.abs(y) <= width_m / 2;
    return isOnTable && this.through(() => this.board.tool.takes(pointer));
  }

  /** Let the tool act with this surface's view in the board's place. @template T @param {() => T} act @returns {T} */
  through(act) {
    const { board } = this;
    const own = board.view;
    board.view = this.view;
    try {
      return act();
    } finally {
      board.view = own;
    }
  }

  /** @param {Event} event */
  keep(event) {
    event.stopImmediatePropagation();
    event.preventDefault();
  }

  /** @param {PointerEvent} event */
  down(event) {
    const { board } = this;
    if (event.button !== 0 || event.pointerType === "touch" || this.pressed || !this.isUsable) return;
    const pointer = this.pointer(event);
    if (!this.isTaken(pointer)) return;
    this.keep(event);
    if (!this.isAtStart) {
      board.store.command({ do: "seek", t_s: 0 });
      board.store.refuse(say("rule.spread_again"));
      return;
    }
    this.pressed = { id: event.pointerId, px: pointer.px, hasMoved: false, last: pointer };
    /** @type {Element} */ (event.target).setPointerCapture(event.pointerId);
    board.svg.focus({ preventScroll: true }); // its keys go on with what is begun here
    board.useKeyboard(false);
    this.through(() => board.tool.press(pointer));
    board.render();
  }

  /** @param {PointerEvent} event */
  move(event) {
    const { board, pressed } = this;
    if (event.pointerType === "touch") return;
    this.enter();
    if (pressed?.id !== event.pointerId) {
      if (!event.buttons) this.hover(event);
      return;
    }
    this.keep(event);
    if (!this.view.look(this.scene)) return;
    const pointer = (pressed.last = this.pointer(event));
    pressed.hasMoved ||= distance(pointer.px, pressed.px) >= DRAG_PX;
    if (pressed.hasMoved) this.through(() => board.tool.drag(pointer));
    board.render();
  }

  /** @param {PointerEvent} event */
  hover(event) {
    const { board } = this;
    const { canvas } = this.scene ?? {};
    if (!this.isUsable || !this.isAtStart) {
      if (canvas) canvas.style.cursor = "";
      return;
    }
    const pointer = this.pointer(event);
    const isTaken = this.isTaken(pointer);
    if (isTaken) this.through(() => board.tool.hover(pointer));
    else board.tool.leave();
    if (canvas) canvas.style.cursor = isTaken ? board.tool.cursor : "";
    board.render();
  }

  /** @param {PointerEvent} event */
  up(event) {
    const { pressed } = this;
    if (pressed?.id !== event.pointerId) return;
    this.keep(event);
    pressed.last = this.pointer(event);
    this.finish();
  }

  /** Let go of what is pressed where the pointer was last. */
  finish() {
    const { board, pressed } = this;
    if (!pressed) return;
    this.pressed = null;
    this.through(() => board.tool.release(pressed.last, pressed.hasMoved));
    board.render();
  }

  /** @param {PointerEvent} event */
  cancel(event) {
    if (this.pressed?.id !== event.pointerId) return;
    this.pressed = null;
    this.board.tool.interrupt();
    this.board.render();
  }

  /** @param {MouseEvent} event */
  twice(event) {
    if (!this.isUsable || !this.isAtStart) return;
    const pointer = this.pointer(event);
    if (!this.isTaken(pointer)) return;
    this.keep(event);
    this.through(() => this.board.tool.twice(pointer));
    this.board.render();
  }

  enter() {
    if (this.isOver) return;
    this.isOver = true;
    const draw = () => {
      this.draw();
      if (this.isOver || this.pressed) requestAnimationFrame(draw);
    };
    draw();
  }

  leave() {
    this.isOver = false;
    if (!this.pressed) this.board.tool.leave();
    this.board.render();
  }

  /** Lay the board's picture over this one, as the camera is now. */
  draw() {
    const { board } = this;
    const isShown = (this.isOver || this.pressed !== null) && this.isUsable && this.isAtStart;
    this.root.toggleAttribute("hidden", !isShown);
    if (!isShown) return;
    this.root.style.transform = asTransform(this.view.fromBoard);
    this.copies.classList.toggle("is-folded", !board.isSpread);
  }
}
