/** The Fold-DAG as a graph: folds in columns by depth, done, available or waiting as the time goes. */

import { element, svg } from "../dom.js";
import { say } from "../language/say.js";
import { listed } from "../messages/lengths.js";
import { columns, wayOf } from "./dag_layout.js";
import { before, STATE_WORDS, waitsFor } from "./fold_states.js";
import { foldName } from "./step_kinds.js";

/** @import { Fold, Plan } from "pleat" */
/** @import { Place } from "./dag_layout.js" */

const NODE = { height: 34, gapX: 20, gapY: 8, edge: 8, line: 13 };
/** Nodes are as wide as fits, within these (px); so much of that is not for letters, and a letter takes so much. */
const WIDTH = { least: 78, most: 130, frame: 28, letter: 6.2 };

/** @typedef {{x: number, y: number}} Corner the upper left one of a node (px) */

export class Dag {
  /** @param {(id: string) => void} onSelect */
  constructor(onSelect) {
    this.onSelect = onSelect;
    this.root = element("div", "dag");
    /** @type {SVGElement[]} by fold */
    this.nodes = [];
    /** @type {{from: number, to: number, line: SVGElement}[]} */
    this.edges = [];
    /** @type {string[]} by fold */
    this.states = [];
    /** @type {Set<string>} ids */
    this.selected = new Set();
    this.shown = "";
    /** @type {Fold[]|null} of the drawing; null before any is known */
    this.folds = null;
    /** @type {Plan|null} */
    this.plan = null;
    /** How wide a node is, and the whole as it was drawn last (px). */
    this.width = WIDTH.most;
    this.drawn = 0;
    new ResizeObserver(() => this.draw()).observe(this.root);
  }

  /** @param {Fold[]} folds of the drawing @param {Plan|null} plan */
  show(folds, plan) {
    const wanted = JSON.stringify([folds.map(({ id, name, kind }) => [id, name, kind]), plan?.dag]);
    if (wanted === this.shown) return;
    this.shown = wanted;
    this.folds = folds;
    this.plan = plan;
    this.drawn = 0;
    this.nodes = []; // of other folds; while it is hidden none are drawn
    this.edges = [];
    this.draw();
  }

  /** Draw it, unless it is there already as wide as it should be. */
  draw() {
    const { folds, plan } = this;
    const width = this.root.clientWidth;
    if (!folds || !width || width === this.drawn) return;
    this.drawn = width;
    const missing = folds.length ? say("dag.unknown") : say("folds.none");
    if (plan && folds.length) this.root.replaceChildren(this.graph(folds, plan), this.key());
    else this.root.replaceChildren(element("p", "hint", missing));
    this.showStates(this.states);
    this.showSelection(this.selected);
  }

  /** @param {string[]} states by fold */
  showStates(states) {
    this.states = states;
    const { folds } = this;
    if (!folds) return;
    this.nodes.forEach((node, fold) => {
      if (node.dataset.state === states[fold]) return;
      node.dataset.state = states[fold];
      node.setAttribute("aria-label", this.label(folds, fold, states[fold]));
    });
    for (const { from, line } of this.edges) line.classList.toggle("is-done", states[from] === say("fold_state.done"));
  }

  /** @param {Set<string>} ids of the folds that are selected */
  showSelection(ids) {
    this.selected = ids;
    this.nodes.forEach((node, fold) => node.setAttribute("aria-pressed", String(ids.has(this.folds?.[fold].id ?? ""))));
  }

  /** @param {Fold[]} folds @param {Plan} plan */
  graph(folds, plan) {
    const { edges } = plan.dag;
    const laid = columns(folds.length, edges);
    const tallest = Math.max(...laid.map((column) => column.length));
    const room = (this.root.clientWidth - 2 * NODE.edge + NODE.gapX) / laid.length - NODE.gapX;
    this.width = Math.min(Math.max(Math.floor(room), WIDTH.least), WIDTH.most);
    const width = laid.length * (this.width + NODE.gapX) - NODE.gapX + 2 * NODE.edge;
    const height = tallest * (NODE.height + NODE.gapY) - NODE.gapY + 2 * NODE.edge;
    /** @param {Place} place */
    const at = (place) => this.at(place, height);
    this.edges = edges.map(([from, to]) => ({ from, to, line: this.link(wayOf(laid, from, to).map(at)) }));
    const own = laid.flat().filter(({ to }) => to < 0);
    const places = own.toSorted((a, b) => a.fold - b.fold).map(at); // one for each fold
    this.nodes = folds.map((fold, index) => this.node(fold, index, places[index]));
    const drawn = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "group" });
    drawn.setAttribute("aria-label", say("dag.label", { folds: folds.length, steps: laid.length }));
    const lines = svg("g", { "aria-hidden": "true" }, ...this.edges.map(({ line }) => line));
    drawn.append(lines, ...this.nodes);
    return element("div", "dag-scroll", drawn);
  }

  /** @param {Fold} fold @param {number} index @param {Corner} corner */
  node(fold, index, { x, y }) {
    const name = foldName(fold, index);
    const lines = twoLines(name, Math.floor((this.width - WIDTH.frame) / WIDTH.letter));
    const top = NODE.height / 2 + 4 - ((lines.length - 1) * NODE.line) / 2;
    const made = svg(
      "g",
      { class: "dag-node", "data-kind": fold.kind, transform: `translate(${x} ${y})`, tabindex: 0, role: "button" },
      svg("title", {}, name),
      svg("rect", { width: this.width, height: NODE.height, rx: 6 }),
      svg("path", { class: "dag-stroke", d: `M1.5 5v${NODE.height - 10}` }),
      svg("text", { class: "dag-number", x: 13, y: NODE.height / 2 + 4 }, String(index + 1)),
      ...lines.map((line, row) => svg("text", { x: 23, y: top + row * NODE.line }, line)),
    );
    made.addEventListener("click", () => this.onSelect(fold.id));
    made.addEventListener("keydown", (event) => this.onKey(event, fold));
    for (const name of ["pointerenter", "focus"]) made.addEventListener(name, () => this.highlight(index));
    for (const name of ["pointerleave", "blur"]) made.addEventListener(name, () => this.highlight(-1));
    return made;
  }

  /** The upper left corner of a place. @param {Place} place @param {number} height */
  at({ depth, row }, height) {
    const x = NODE.edge + depth * (this.width + NODE.gapX);
    return { x, y: (height - NODE.height) / 2 + row * (NODE.height + NODE.gapY) };
  }

  /** An arrow from one node to another by way of the places between. @param {Corner[]} places */
  link(places) {
    const ends = places.map(({ x, y }) => ({ x0: x, x1: x + this.width, y: y + NODE.height / 2 }));
    const [first, ...rest] = ends;
    const last = ends[ends.length - 1];
    let d = `M${first.x1} ${first.y}`;
    let from = first;
    for (const to of rest) {
      const middle = (from.x1 + to.x0) / 2;
      d += `C${middle} ${from.y} ${middle} ${to.y} ${to.x0} ${to.y}`;
      if (to !== last) d += `H${to.x1}`;
      from = to;
    }
    const tip = `M${last.x0 - 5} ${last.y - 3.5}L${last.x0} ${last.y}L${last.x0 - 5} ${last.y + 3.5}`;
    return svg("path", { class: "dag-edge", d: d + tip });
  }

  /**
   * Folds in words: what screen readers hear of a node.
   * @param {Fold[]} folds
   * @param {number} fold
   * @param {string} state
   */
  label(folds, fold, state) {
    /** @param {number[]} others */
    const names = (others) => listed(others.map((other) => foldName(folds[other], other)));
    const [after, first] = [waitsFor(this.plan, fold), before(this.plan, fold)];
    const about = [foldName(folds[fold], fold), say(`colour.${folds[fold].kind}`), STATE_WORDS[state] ?? ""];
    if (after.length) about.push(say("dag.after", { folds: names(after) }));
    if (first.length) about.push(say("dag.before", { folds: names(first) }));
    return about.filter(Boolean).join(", ");
  }

  /** @param {KeyboardEvent} event @param {Fold} fold */
  onKey(event, fold) {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    event.stopPropagation();
    this.onSelect(fold.id);
  }

  /** Show a fold with what comes right before and after it. @param {number} fold -1: none */
  highlight(fold) {
    const near = new Set([fold, ...waitsFor(this.plan, fold), ...before(this.plan, fold)]);
    this.root.classList.toggle("has-hover", fold >= 0);
    this.nodes.forEach((node, other) => node.classList.toggle("is-near", near.has(other)));
    for (const { from, to, line } of this.edges) line.classList.toggle("is-near", from === fold || to === fold);
  }

  key() {
    const entries = Object.entries({
      done: say("fold_state.done"),
      available: say("fold_state.available"),
      waiting: say("fold_state.waiting"),
    });
    const key = element("p", "dag-key", ...entries.map(([state, word]) => entry(state, word)));
    key.setAttribute("aria-hidden", "true");
    return key;
  }
}

/** A name broken into at most two lines, shortened where it is longer. @param {string} name @param {number} letters */
function twoLines(name, letters) {
  /** @param {string} text */
  const cut = (text) => (text.length > letters ? `${text.slice(0, letters - 1)}\u2026` : text);
  if (name.length <= letters) return [name];
  const space = name.lastIndexOf(" ", letters);
  return space > 0 ? [name.slice(0, space), cut(name.slice(space + 1))] : [cut(name)];
}

/** @param {string} state @param {string} word */
function entry(state, word) {
  const sample = element("span", "dag-sample");
  sample.dataset.state = state;
  return element("span", "", sample, word);
}
