/** The list `Plan`: one row for each primitive; a click goes to its start. */

import { byId, element } from "./dom.js";
import { how, KINDS, seconds, what, WHY_NOT } from "./words.js";

export class PlanList {
  /** @param {(t_s: number) => void} onSeek */
  constructor(onSeek) {
    this.onSeek = onSeek;
    this.list = byId("plan");
    this.empty = byId("plan-empty");
    /** @type {any[]} */
    this.primitives = [];
  }

  /**
   * @param {any} garment
   * @param {any} plan or null
   * @param {string} status
   */
  show(garment, plan, status) {
    this.primitives = plan ? plan.primitives : [];
    this.list.replaceChildren(...this.primitives.map((primitive) => this.row(primitive, garment)));
    this.empty.hidden = this.primitives.length > 0;
    this.empty.textContent = emptyText(status);
  }

  /** @param {number} t_s */
  tick(t_s) {
    this.primitives.forEach((primitive, index) => {
      const isLast = index === this.primitives.length - 1;
      const end = primitive.start_s + primitive.duration_s;
      const isCurrent = t_s >= primitive.start_s && (t_s < end || isLast);
      this.list.children[index].firstElementChild.setAttribute("aria-current", String(isCurrent));
    });
  }

  row(primitive, garment) {
    const name = `${KINDS[primitive.kind] ?? primitive.kind}: ${what(primitive, garment.folds)}`;
    const button = element(
      "button",
      "row",
      element("span", "row-mark", mark(primitive, garment)),
      element("span", "row-name", name, element("small", "", how(primitive))),
      element("span", "row-end", seconds(primitive.duration_s)),
    );
    button.setAttribute("type", "button");
    button.addEventListener("click", () => this.onSeek(primitive.start_s));
    return element("li", "", button);
  }
}

/** A fold's stroke as in the list of folds, or an arrow. */
function mark(primitive, garment) {
  if (primitive.kind !== "fold") return primitive.kind === "drag" ? "\u2190" : "\u21B7";
  return element("span", garment.folds[primitive.fold]?.kind === "red" ? "stroke is-red" : "stroke");
}

function emptyText(status) {
  if (status === "solved") return "Nothing to do.";
  return status === "planning" ? "Being worked out." : `There is none: see \u201C${WHY_NOT}\u201D.`;
}
