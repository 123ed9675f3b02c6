/** The drafting board: an SVG that shows the document's drawing, and the tools that change it. */

import { element, svg } from "../dom.js";
import { Callout } from "./callout.js";
import { drawAll } from "./draw_all.js";
import { FoldPaint } from "./fold_paint.js";
import { Framing } from "./framing.js";
import { Keyboard } from "./keyboard.js";
import { Layers } from "./layers.js";
import { Legend } from "./legend.js";
import { Loupe } from "./loupe.js";
import { Mirroring } from "./mirror.js";
import { Numbers } from "./numbers.js";
import { Overlays } from "./overlays.js";
import { Photo } from "./photo.js";
import { PointerInput } from "./pointer.js";
import { drawingArea, REDRAWN_AT, sheetsOf } from "./drawing_area.js";
import { hatches } from "./drawing_area.js";
import { HintLine } from "./hint_line.js";
import { Shown } from "./shown.js";
import { Snapper } from "./snap.js";
import { Soft } from "./snap.js";
import { Strip } from "./strip.js";
import { FoldTool } from "./tools/fold.js";
import { MeasureTool } from "./tools/measure.js";
import { OutlineTool } from "./tools/outline.js";
import { PhotoTool } from "./tools/photo.js";
import { PlaceTool } from "./tools/place.js";
import { ProposeTool } from "./tools/propose.js";
import { SelectTool } from "./tools/select.js";
import { TypedLength } from "./typed.js";
import { length } from "./units.js";
import { View } from "./view.js";

/** @import { Point } from "pleat" */
/** @import { Hit } from "./hit.js" */
/** @import { Pointed, Snapped, Targets } from "./snap.js" */
/** @import { Tool, ToolName } from "./tools/tool.js" */
/** @import { Blank } from "./blank.js" */
/** @import { Rail } from "./rail.js" */

export class Board extends Shown {
  /** @param {import("../store.js").Store} store @param {HTMLElement} root @param {() => void} togglePlay */
  constructor(store, root, togglePlay) {
    super(store);
    this.root = root;
    this.togglePlay = togglePlay;
    this.view = new View();
    this.snapper = new Snapper();
    /** @type {Hit|null} what is pointed at */
    this.hover = null;
    /** @type {Snapped|null} the snap in force */
    this.snapped = null;
    /** @type {{moving: Point[][], landed: Point[][]}|null} */
    this.ghost = null;
    this.said = "";
    this.mirroring = new Mirroring(this);
    this.paint = new FoldPaint(this);
    /** @type {Rail|null} */
    this.rail = null;
    /** @type {Blank|null} */
    this.blank = null;
    /** @type {import("../proposals/proposing.js").Proposing|null} */
    this.proposing = null;
    /** @type {number|undefined} the frame that is to be drawn */
    this.frame = undefined;
    /** @type {{height: number, width: number}|null} what lies over the board's upper edge, or over its right side */
    this.over = null;
    this.framing = new Framing(this);
    this.svg = drawingArea();
    const scene = svg("g", { id: "board-scene" });
    this.svg.append(hatches(), scene);
    this.strip = new Strip(this);
    this.root.append(this.svg);
    this.sheets = sheetsOf(scene);
    this.hintLine = new HintLine();
    this.live = element("p", "unseen");
    this.live.setAttribute("aria-live", "polite");
    this.root.append(this.hintLine.root, this.live);
    this.photo = new Photo(
      this.store.id,
      () => this.render(),
      (sentence) => this.store.refuse(sentence),
    );
    this.layerStack = new Layers(this.store, () => this.render());
    this.overlays = new Overlays(this);
    this.numbers = new Numbers(this);
    this.typed = new TypedLength(this);
    this.callout = new Callout(this);
    this.legend = new Legend(this);
    this.loupe = new Loupe(this.root, "board-scene");
    this.tools = {
      select: new SelectTool(this),
      outline: new OutlineTool(this),
      fold: new FoldTool(this),
      place: new PlaceTool(this),
      measure: new MeasureTool(this),
      photo: new PhotoTool(this),
      propose: new ProposeTool(this),
    };
    /** @type {Tool} */
    this.tool = this.tools.select;
    this.pointer = new PointerInput(this);
    this.keyboard = new Keyboard(this);
    this.listen();
  }

  listen() {
    for (const name of REDRAWN_AT)
      this.store.addEventListener(name, () => this.render());
    new ResizeObserver(() => this.framing.resize()).observe(this.svg);
  }

  get toolInHand() {
    return this.tool ?? null;
  }

  get kindOfNext() {
    return this.paint.kind;
  }

  /**
   * Something lies over the board's upper edge or right side: what is fitted to the board is fitted to what is left of it.
   * @param {EventTarget & {height: number, width: number}} over
   */
  cover(over) {
    this.over = over;
    over.addEventListener("change", () => this.framing.uncover());
    for (const name of ["selection", "document"]) this.store.addEventListener(name, () => this.framing.comeBack());
  }

  /** How much of the board's upper edge is covered (px). */
  get covered() {
    return Math.max((this.over?.height ?? 0) - this.place.top, 0);
  }

  /** How much of the board's right side is covered (px). */
  get coveredSide() {
    return this.over?.width ?? 0;
  }

  /** @param {number} step */
  layersAt(step) {
    return this.layerStack.at(step);
  }

  /** Whether nothing is being dragged or drawn. */
  get isQuiet() {
    return !this.draft && !this.tool.isBusy && (this.tool.name === "select" || this.isPlacing);
  }

  get isByKeyboard() {
    return this.keyboard.isOn;
  }

  /** The board's size, and how far below the pane's top it begins (px). */
  get place() {
    return { width: this.view.width, height: this.view.height, top: this.root.clientHeight - this.view.height };
  }

  /** @param {Pointed} pointer @param {Targets} targets @returns {Snapped} */
  snapTo(pointer, targets) {
    this.snapped = this.snapper.snap(this.view, pointer, { ...targets, soft: new Soft(this.drawing) });
    return this.snapped;
  }

  /** @param {string} text */
  openTyped(text) {
    this.typed.open(text);
  }

  closeTyped() {
    this.typed.close();
  }

  /** @param {KeyboardEvent} event */
  nudgeOf(event) {
    return this.keyboard.nudge(event);
  }

  /** @param {KeyboardEvent} event */
  keyboardPointer(event) {
    return this.keyboard.pointer(event);
  }

  /** @param {boolean} isOn */
  useKeyboard(isOn) {
    this.keyboard.isOn = isOn;
  }

  /** A sentence at the cursor. @param {string} sentence */
  say(sentence) {
    this.said = sentence;
  }

  /** @param {string} text */
  announce(text) {
    this.live.textContent = text;
  }

  /** @param {Point} at */
  whereText([x, y]) {
    return `${length(x)}, ${length(y)}${this.snapped?.name ? `, ${this.snapped.name}` : ""}`;
  }

  /** @param {ToolName} name */
  choose(name) {
    if (!this.state) return;
    if (this.blank) this.blank.isAtOnce = false;
    const before = this.tool;
    before.interrupt();
    this.closeTyped();
    this.tool = this.tools[name];
    if (name === "place" || before.name === "place") this.framing.turn(before.name === "place");
    this.snapped = null;
    this.hintLine.show("");
    this.tool.enter();
    this.svg.focus({ preventScroll: true });
    this.render();
  }

  escape() {
    if (this.tool.cancel()) this.render();
    else if (this.tool.name !== "select") this.choose("select");
    else if (this.store.selection) this.store.select(null);
    else return false;
    return true;
  }

  /** Undo what is being drawn, before any step of the document. @returns {boolean} whether anything is */
  takeBack() {
    if (!this.tool.isBusy) return false;
    this.tool.takeBack();
    this.render();
    return true;
  }

  /** Whether the axis over which things are mirrored is shown. */
  get isAxisShown() {
    return this.mirroring.isAxisShown;
  }

  toggleSnap() {
    this.snapper.turn(!this.snapper.isOn);
    this.render();
  }

  /** Draw soon. */
  render() {
    this.frame ??= requestAnimationFrame(() => {
      this.frame = undefined;
      this.framing.fitFirst();
      this.redraft();
      this.draw();
    });
  }

  /** Draw at once. */
  draw() {
    drawAll(this);
  }
}
