/** SVG elements kept from one drawing to the next by their keys, so that focus and listeners outlive a change. */

import { svg } from "../dom.js";
import { present } from "../present.js";

/** @import { Point } from "pleat" */

/** @typedef {{key: string, tag: string, text?: string, [attribute: string]: unknown}} Item */
/** @typedef {(Item|null|false|undefined)[]} Items some of which may be missing */

export class Sheet {
  /** @param {SVGElement} parent @param {string} className */
  constructor(parent, className) {
    this.root = svg("g", { class: className });
    parent.append(this.root);
    /** @type {Map<string, {node: SVGElement, shown: Record<string, unknown>}>} */
    this.kept = new Map();
  }

  /** Show these items and nothing else, in this order. @param {Items} items */
  draw(items) {
    const wanted = present(items);
    const keys = new Set(wanted.map((item) => item.key));
    for (const [key, { node }] of this.kept) {
      if (keys.has(key)) continue;
      node.remove();
      this.kept.delete(key);
    }
    let place = this.root.firstChild;
    for (const item of wanted) {
      const node = this.put(item);
      if (node === place) place = place.nextSibling;
      else this.root.insertBefore(node, place);
    }
  }

  /** @param {Item} item */
  put({ key, tag, text, ...attributes }) {
    const known = this.kept.get(key);
    const name = /** @type {keyof SVGElementTagNameMap} */ (tag);
    const entry = known?.node.tagName === tag ? known : { node: svg(name), shown: {} };
    if (entry !== known) known?.node.remove();
    for (const name of new Set([...Object.keys(entry.shown), ...Object.keys(attributes)])) {
      const value = attributes[name];
      if (value === entry.shown[name]) continue;
      if (value === undefined || value === null) entry.node.removeAttribute(name);
      else entry.node.setAttribute(name, String(value));
    }
    if (text !== undefined && entry.node.textContent !== text) entry.node.textContent = text;
    entry.shown = attributes;
    this.kept.set(key, entry);
    return entry.node;
  }
}

/** A path through points on the screen, or in another unit. @param {Point[]} points @param {boolean} isClosed @param {number} digits after the point */
export function path(points, isClosed = true, digits = 1) {
  if (!points.length) return "";
  return `M${points.map(([x, y]) => `${x.toFixed(digits)} ${y.toFixed(digits)}`).join("L")}${isClosed ? "Z" : ""}`;
}
