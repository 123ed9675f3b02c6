/** Above a finger, what is under it: the board once more, larger, in a circle. */
import { svg } from "../dom.js";


const SIZE_PX = 116;
const LIFT_PX = 34;
const LARGER = 2;

export class Loupe {
  /** @param {HTMLElement} parent @param {string} scene the id of what is shown */
  constructor(parent, scene) {
    this.root = svg("svg", { class: "loupe", width: SIZE_PX, height: SIZE_PX, "aria-hidden": "true" });
    this.copy = svg("use", { href: `#${scene}` });
    this.root.append(
      this.copy,
      svg("path", { class: "loupe-mark", d: `M${SIZE_PX / 2} ${SIZE_PX / 2 - 9}v18m-9 -9h18` }),
    );
    this.root.toggleAttribute("hidden", true);
    parent.append(this.root);
  }

  /** @param {import("./pointer.js").Pointer|null} pointer a finger, or none */
  show(pointer) {
    this.root.toggleAttribute("hidden", !pointer);
    if (!pointer) return;
    const [x, y] = pointer.px;
    const top = y - LIFT_PX - SIZE_PX;
    const place =
      top < 0
        ? [x + (x > SIZE_PX + LIFT_PX ? -LIFT_PX - SIZE_PX : LIFT_PX), Math.max(y - SIZE_PX / 2, 0)]
        : [x - SIZE_PX / 2, top];
    this.root.style.transform = `translate(${place[0]}px, ${place[1]}px)`;
    this.copy.setAttribute(
      "transform",
      `translate(${SIZE_PX / 2 - x * LARGER} ${SIZE_PX / 2 - y * LARGER}) scale(${LARGER})`,
    );
  }
}
