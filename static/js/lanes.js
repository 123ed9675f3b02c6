/** The timeline: one lane each for the base and the two arms, with the playhead across them. */

import { element } from "./dom.js";
import { KINDS, what } from "./words.js";

const MOVED_M = 0.001;

export class Lanes {
  /** @param {(t_s: number) => void} onSeek */
  constructor(onSeek) {
    this.onSeek = onSeek;
    this.root = /** @type {HTMLElement} */ (document.querySelector(".lanes"));
    this.duration = 0;
    for (const lane of this.root.querySelectorAll(".lane")) {
      lane.addEventListener("click", (event) => this.seekAt(lane, /** @type {MouseEvent} */ (event)));
    }
  }

  /**
   * @param {any} garment
   * @param {any} plan or null
   */
  show(garment, plan) {
    this.duration = plan?.cost_s ?? 0;
    const primitives = plan?.primitives ?? [];
    for (const lane of this.root.querySelectorAll(".lane")) {
      const name = lane.getAttribute("data-lane");
      const blocks = primitives.map((primitive, index) =>
        name === "base"
          ? this.baseBlock(primitive, primitives[index - 1], garment)
          : this.armBlock(primitive, name, garment),
      );
      lane.replaceChildren(...blocks.filter(Boolean));
    }
  }

  /** @param {number} t_s */
  tick(t_s) {
    this.root.style.setProperty("--head", String(this.duration ? t_s / this.duration : 0));
  }

  /** A click where no block is goes to that time. */
  seekAt(lane, event) {
    if (event.target !== lane || !this.duration) return;
    const box = lane.getBoundingClientRect();
    this.onSeek((this.duration * (event.clientX - box.left)) / box.width);
  }

  armBlock(primitive, arm, garment) {
    if (!primitive.grips.some((grip) => grip.arm === arm)) return null;
    const block = this.block(primitive, garment, primitive.kind, label(primitive, garment));
    block.classList.toggle("is-red", garment.folds[primitive.fold]?.kind === "red");
    return block;
  }

  /** What the base does meanwhile; during a fold it may back off or come nearer. */
  baseBlock(primitive, before, garment) {
    if (primitive.kind !== "fold") return this.block(primitive, garment, primitive.kind, label(primitive, garment));
    const further = primitive.base.back_off_m - (before?.base.back_off_m ?? 0);
    if (Math.abs(further) < MOVED_M) return null;
    const way = `${Math.round(100 * Math.abs(further))} cm ${further > 0 ? "back" : "ahead"}`;
    return this.block(primitive, garment, "drive", way);
  }

  block(primitive, garment, kind, text) {
    const whole = `${KINDS[primitive.kind] ?? primitive.kind}: ${what(primitive, garment.folds)}`;
    const block = element("div", "block", element("span", "block-name", text));
    block.dataset.kind = kind;
    block.style.left = `${(100 * primitive.start_s) / this.duration}%`;
    block.style.width = `${(100 * primitive.duration_s) / this.duration}%`;
    block.title = kind === "drive" ? `${whole}, the base drives ${text}` : whole;
    block.addEventListener("click", () => this.onSeek(primitive.start_s));
    return block;
  }
}

function label(primitive, garment) {
  return primitive.kind === "drag" ? `${Math.round(100 * primitive.distance_m)} cm` : what(primitive, garment.folds);
}
