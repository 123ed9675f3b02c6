/** The list `Folds`: kind, name, what each waits for; done ones fade as the plan plays. */

import { byId, element } from "./dom.js";

const KINDS = { blue: ["Blue", "all layers"], red: ["Red", "last flap"] };

export class Folds {
  constructor() {
    this.list = byId("folds");
    /** @type {any[]} */
    this.primitives = [];
  }

  /**
   * @param {any} garment
   * @param {any} plan or null
   */
  show(garment, plan) {
    const edges = plan ? plan.dag.edges : [];
    this.primitives = plan ? plan.primitives : [];
    this.list.replaceChildren(...garment.folds.map((fold, index) => row(fold, index, edges)));
  }

  /** @param {number} t_s */
  tick(t_s) {
    for (const primitive of this.primitives) {
      if (primitive.kind !== "fold") continue;
      const shown = this.list.children[primitive.fold];
      const end = primitive.start_s + primitive.duration_s;
      shown.classList.toggle("is-done", t_s >= end - 1e-9);
      const isCurrent = t_s >= primitive.start_s && t_s < end - 1e-9;
      shown.setAttribute("aria-current", String(isCurrent));
    }
  }
}

function row(fold, index, edges) {
  const before = edges.filter(([, to]) => to === index).map(([from]) => from);
  const waits = before.length ? `after ${before.join(", ")}` : "";
  const [colour, moved] = KINDS[fold.kind];
  const stroke = element("span", fold.kind === "red" ? "stroke is-red" : "stroke");
  stroke.setAttribute("role", "img");
  stroke.setAttribute("aria-label", colour);
  const shown = element(
    "li",
    "row",
    element("span", "row-mark", stroke),
    element("span", "row-name", `${index}. ${fold.name || "fold"} `, element("small", "", moved)),
    element("span", "row-end", waits),
  );
  shown.title = `${colour}: ${moved}`;
  return shown;
}
