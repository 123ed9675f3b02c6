/** Numbers at the selection: a corner's place, an edge's length, a fold's ends on their edges, the placement. */

import { element } from "../dom.js";
import { placeOf, sideOf } from "./beside.js";
import { middleOf, moveCorners, moveFold } from "./edits.js";
import { between, distance, toOuter } from "./geometry.js";
import { atLength } from "./snap.js";
import { laid } from "./tools/place.js";
import { evaluated, number, parsed, problemOf, unit } from "./units.js";

const DEGREE = Math.PI / 180;

/** @typedef {{label: string, name: string, value: string, put: (text: string) => string}} Field */

export class Numbers {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.root = element("div", "numbers-at");
    this.root.setAttribute("role", "group");
    this.root.setAttribute("aria-label", "Numbers");
    this.root.hidden = true;
    this.shown = "";
    /** @type {[number, number]} */
    this.side = [1, 1];
    board.root.append(this.root);
  }

  /** Show the fields of what is selected, beside it. */
  draw() {
    const found = this.board.isQuiet ? this.found() : null;
    this.root.hidden = !found;
    if (!found) {
      this.shown = "";
      return;
    }
    const names = `${found.key} ${found.fields.map(({ name }) => name)} ${unit.name}`;
    const isNew = names !== this.shown;
    if (isNew) this.root.replaceChildren(...found.fields.map((_, index) => this.row(index)));
    this.shown = names;
    this.fields = found.fields;
    for (const [index, input] of [...this.root.querySelectorAll("input")].entries()) {
      if (document.activeElement !== input) input.value = found.fields[index].value;
    }
    this.put(found.at, isNew);
  }

  /** Beside its place; on which side is chosen when it appears. @param {[number, number]} at px @param {boolean} isNew */
  put(at, isNew) {
    const { width, height, top } = this.board.place;
    const size = /** @type {[number, number]} */ ([this.root.offsetWidth, this.root.offsetHeight]);
    if (isNew) this.side = sideOf(at, size, [width, height], this.board.pointer.last);
    const [x, y] = placeOf(at, size, [width, height], this.side);
    this.root.style.left = `${x}px`;
    this.root.style.top = `${top + y}px`;
  }

  focus() {
    this.draw(); // what was selected just now may not have been drawn yet
    const input = this.root.hidden ? null : this.root.querySelector("input");
    input?.focus();
    return Boolean(input);
  }

  row(index) {
    const input = /** @type {HTMLInputElement} */ (element("input", "field"));
    input.type = "text";
    input.autocomplete = "off";
    const { label, name } = (this.fields = this.found().fields)[index];
    input.setAttribute("aria-label", name);
    input.addEventListener("focus", () => input.select());
    input.addEventListener("change", () => this.take(index, input));
    input.addEventListener("keydown", (event) => this.key(event, index, input));
    return element("label", "number-at", element("span", "", label), input);
  }

  take(index, input) {
    const problem = this.fields[index].put(input.value);
    if (!problem) return;
    this.board.store.refuse(problem);
    input.value = this.fields[index].value;
  }

  /** With Enter or Escape the field is left, and what was written in it changes something as it always does then. */
  key(event, index, input) {
    event.stopPropagation();
    if (event.key === "Escape") input.value = this.fields[index].value;
    if (event.key === "Enter" || event.key === "Escape") {
      event.preventDefault();
      this.board.svg.focus({ preventScroll: true });
    }
  }

  /** @returns {{key: string, at: [number, number], fields: Field[]}|null} */
  found() {
    const { kind, ids } = this.board.store.selection ?? {};
    if (this.board.isPlacing) return this.ofPlacement();
    if (ids?.length !== 1) return null;
    const [id] = ids;
    if (kind === "vertex" && this.board.isSpread) return this.ofCorner(id);
    if (kind === "edge" && this.board.isSpread) return this.ofEdge(id);
    return kind === "fold" ? this.ofFold(id) : null;
  }

  ofCorner(id) {
    const corner = this.board.drawing.outline.find((other) => other.id === id);
    if (!corner) return null;
    const field = (axis) => ({
      label: "xy"[axis],
      name: `${"xy"[axis]} of the vertex`,
      value: number(corner.point[axis]),
      put: (text) =>
        this.move(
          text,
          (metres, drawing) => {
            const point = /** @type {[number, number]} */ ([...drawing.outline.find((other) => other.id === id).point]);
            point[axis] = metres;
            moveCorners(drawing, new Map([[id, point]]));
          },
          "Move vertex",
        ),
    });
    return { key: id, at: this.board.view.toPx(corner.point), fields: [field(0), field(1)] };
  }

  ofEdge(id) {
    const { outline } = this.board.drawing;
    const index = outline.findIndex((corner) => corner.id === id);
    const next = outline[(index + 1) % outline.length];
    const [a, b] = [outline[index].point, next.point];
    const field = {
      label: "length",
      name: "Length of the edge",
      value: number(distance(a, b)),
      put: (text) =>
        this.move(
          text,
          (metres, drawing) => moveCorners(drawing, new Map([[next.id, atLength(a, b, metres)]])),
          "Set edge length",
          0.001,
        ),
    };
    return { key: id, at: this.board.view.toPx(between(a, b)), fields: [field] };
  }

  ofFold(id) {
    const fold = this.board.fold(id);
    const fields = ["start", "end"].flatMap((end) => this.ofEnd(fold, end));
    return fields.length ? { key: id, at: this.board.view.toPx(fold.end.point), fields } : null;
  }

  /** How far along its edge an end is; of an end at a corner or on a crease there is nothing to say. */
  ofEnd(fold, end) {
    const { on } = fold[end];
    const [from, to] = ["from", "to"].map(
      (side) => this.board.drawing.outline.find(({ id }) => id === on?.[side])?.point,
    );
    if (on?.kind !== "edge" || !from || !to) return [];
    const whole = distance(from, to);
    const put = (metres, drawing) =>
      moveFold(drawing, fold.id, {
        [end]: { point: fold[end].point, on: { ...on, fraction: Math.min(metres / whole, 1) } },
      });
    return [
      {
        label: end,
        name: `${end} of the fold along its edge`,
        value: number(on.fraction * whole),
        put: (text) => this.move(text, put, "Move fold", 0),
      },
    ];
  }

  ofPlacement() {
    const { drawing, view } = this.board;
    if (!drawing.outline.length) return null;
    const middle = middleOf(drawing);
    const { placement } = drawing;
    const centre = toOuter(placement, middle);
    const place = (axis) => ({
      label: ["ahead", "left"][axis],
      name: ["Ahead of the table's middle", "Left of the table's middle"][axis],
      value: number(centre[axis]),
      put: (text) =>
        this.move(
          text,
          (metres, changed) => {
            const at = /** @type {[number, number]} */ ([...centre]);
            at[axis] = metres;
            changed.placement = laid(at, middle, placement.yaw_rad);
          },
          "Place garment",
        ),
    });
    const turn = {
      label: "turn \u00B0",
      name: "Turn in degrees",
      value: (placement.yaw_rad / DEGREE).toFixed(1).replace(/\.0$/, ""),
      put: (text) => {
        const degrees = evaluated(text.replace("\u00B0", "").trim());
        if (degrees === null) return `\u201C${text}\u201D is no number of degrees. Write 90 or 180/4.`;
        this.board.store.edit(
          "Turn garment",
          (changed) => void (changed.placement = laid(centre, middle, degrees * DEGREE)),
        );
        return "";
      },
    };
    return { key: "place", at: /** @type {[number, number]} */ ([view.width, 0]), fields: [place(0), place(1), turn] };
  }

  /** Make a change of a length that was written, or tell what is wrong with it. @returns {string} */
  move(text, change, label, least = undefined) {
    const problem = problemOf(text, least);
    if (!problem) this.board.store.edit(label, (drawing) => change(parsed(text), drawing));
    return problem;
  }
}
