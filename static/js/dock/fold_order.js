/** Rows of a list are put into another order by hand: pulled by their numbers, with a mouse by any part but buttons. */

import { isViewOnly } from "../view_only.js";

const SLACK_PX = 4;
const TOUCH_HANDLE = ".fold-number";

/** @typedef {{row: HTMLElement, pointer: number, y: number, to: number, isOn: boolean}} Pull */

export class FoldOrder {
  /**
   * @param {HTMLElement} list its children have `data-fold`
   * @param {(id: string, to: number) => void} onMove
   * @param {() => void} onEnd after every pull, also one that led nowhere
   */
  constructor(list, onMove, onEnd) {
    this.list = list;
    this.onMove = onMove;
    this.onEnd = onEnd;
    /** @type {Pull|null} */
    this.pull = null;
    /** Whether the click that is to come ends a pull. */
    this.wasPulled = false;
    list.addEventListener("pointerdown", (event) => this.begin(event));
    list.addEventListener("pointermove", (event) => this.go(event));
    list.addEventListener("pointerup", (event) => this.end(event, true));
    list.addEventListener("pointercancel", (event) => this.end(event, false));
    list.addEventListener("click", (event) => this.swallow(event), true);
    document.addEventListener("keydown", (event) => this.giveUp(event), true);
  }

  get isDragging() {
    return this.pull?.isOn ?? false;
  }

  /** @param {PointerEvent} event */
  begin(event) {
    this.wasPulled = false;
    const part = /** @type {Element} */ (event.target);
    const row = /** @type {HTMLElement|null} */ (part.closest(".fold-row"));
    const isHandle = event.pointerType === "mouse" ? part.closest(".fold-line") : part.closest(TOUCH_HANDLE);
    if (isViewOnly || !row || !isHandle || part.closest("input, .icon-button") || event.button !== 0) return;
    this.pull = { row, pointer: event.pointerId, y: event.clientY, to: this.index(row), isOn: false };
  }

  /** @param {PointerEvent} event */
  go(event) {
    const { pull } = this;
    if (!pull || event.pointerId !== pull.pointer) return;
    const by = event.clientY - pull.y;
    if (!pull.isOn && Math.abs(by) < SLACK_PX) return;
    if (!pull.isOn) this.list.setPointerCapture(pull.pointer);
    pull.isOn = true;
    pull.row.classList.add("is-pulled");
    pull.row.style.transform = `translateY(${by}px)`;
    pull.to = this.target(pull.row, event.clientY);
    this.mark(pull);
  }

  /** Where the row would come to stand. @param {Element} row @param {number} y */
  target(row, y) {
    const others = [...this.list.children].filter((child) => child !== row);
    return others.filter((child) => middle(child) < y).length;
  }

  /** Show between which rows it would come. @param {Pull} pull */
  mark(pull) {
    const others = [...this.list.children].filter((child) => child !== pull.row);
    others.forEach((child, index) => {
      child.classList.toggle("is-drop-before", index === pull.to);
      child.classList.toggle("is-drop-after", pull.to === others.length && index === others.length - 1);
    });
  }

  /** @param {PointerEvent} event @param {boolean} isKept */
  end(event, isKept) {
    const { pull } = this;
    if (!pull || event.pointerId !== pull.pointer) return;
    const from = this.index(pull.row);
    this.clear();
    if (!pull.isOn) return;
    this.wasPulled = true;
    if (isKept && pull.to !== from) this.onMove(pull.row.dataset.fold ?? "", pull.to);
    this.onEnd();
  }

  /** A pull ends with a click, which is not meant as one. @param {Event} event */
  swallow(event) {
    if (!this.wasPulled) return;
    this.wasPulled = false;
    event.stopPropagation();
    event.preventDefault();
  }

  /** @param {KeyboardEvent} event */
  giveUp(event) {
    if (!this.isDragging || event.key !== "Escape") return;
    event.stopPropagation();
    this.clear();
    this.wasPulled = true;
    this.onEnd();
  }

  clear() {
    this.pull = null;
    for (const child of this.list.children) {
      child.classList.remove("is-pulled", "is-drop-before", "is-drop-after");
      /** @type {HTMLElement} */ (child).style.transform = "";
    }
  }

  /** @param {Element} row */
  index(row) {
    return [...this.list.children].indexOf(row);
  }
}

/** @param {Element} child */
function middle(child) {
  const box = child.getBoundingClientRect();
  return box.top + box.height / 2;
}
