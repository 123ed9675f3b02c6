/** The timeline: one lane each for the base and the two arms, with the playhead across them. */

import { element } from "./dom.js";
import { KINDS, what } from "./words.js";

export class Lanes {
  /** @param {(t_s: number) => void} onSeek */
  constructor(onSeek) {
    this.onSeek = onSeek;
    this.root = /** @type {HTMLElement} */ (document.querySelector(".lanes"));
    this.duration = 0;
  }

  /**
   * @param {any} garment
   * @param {any} plan or null
   */
  show(garment, plan) {
    this.duration = plan?.cost_s ?? 0;
    for (const lane of this.root.querySelectorAll(".lane")) {
      const name = lane.getAttribute("data-lane");
      const own = (plan?.primitives ?? []).filter((primitive) => isIn(primitive, name));
      lane.replaceChildren(...own.map((primitive) => this.block(primitive, garment)));
    }
  }

  /** @param {number} t_s */
  tick(t_s) {
    this.root.style.setProperty("--head", String(this.duration ? t_s / this.duration : 0));
  }

  block(primitive, garment) {
    const name = what(primitive, garment.folds);
    const label = primitive.kind === "drag" ? `drag ${Math.round(100 * primitive.distance_m)} cm` : name;
    const block = element("div", "block", label);
    block.dataset.kind = primitive.kind;
    block.classList.toggle("is-red", garment.folds[primitive.fold]?.kind === "red");
    block.style.left = `${(100 * primitive.start_s) / this.duration}%`;
    block.style.width = `${(100 * primitive.duration_s) / this.duration}%`;
    block.title = `${KINDS[primitive.kind] ?? primitive.kind}: ${name}`;
    block.addEventListener("click", () => this.onSeek(primitive.start_s));
    return block;
  }
}

function isIn(primitive, lane) {
  if (lane === "base") return primitive.kind !== "fold";
  return primitive.grips.some((grip) => grip.arm === lane);
}
