/**
 * The ways to ask for a context menu: the right button, a long press, the menu key or Shift+F10.
 *
 * Not every browser makes a "contextmenu" event of a long press, nor of the keys; so both are looked for here, and an
 * event that comes on top of them is dropped.
 */

const LONG_PRESS_MS = 500;
/** A finger that lies still trembles by less than this (px). */
const SLACK_PX = 10;
/** A menu asked for by a key stands so far inside of the part that has the focus (px). */
const INSET_PX = 12;

/** @typedef {{part: HTMLElement, id: number, x: number, y: number, timer: number}} Press a finger that lies on a part */

export class MenuPress {
  /**
   * @param {HTMLElement} root
   * @param {string} selector of the parts below it that have a menu
   * @param {(part: HTMLElement, at: {x: number, y: number}) => void} onAsk with a place in the window (px)
   */
  constructor(root, selector, onAsk) {
    this.root = root;
    this.selector = selector;
    this.onAsk = onAsk;
    /** @type {Press|null} */
    this.press = null;
    /** Whether the press that goes on, or went on last, was a long one. */
    this.wasLong = false;
    root.addEventListener("contextmenu", (event) => this.ask(event));
    root.addEventListener("keydown", (event) => this.onKey(event));
    root.addEventListener("pointerdown", (event) => this.begin(event), true);
    root.addEventListener("pointermove", (event) => this.go(event));
    for (const name of ["pointerup", "pointercancel"]) root.addEventListener(name, () => this.end());
    root.addEventListener("click", (event) => this.swallow(event), true);
  }

  /** @param {Event} event @returns {HTMLElement|null} */
  partAt({ target }) {
    return target instanceof Element ? target.closest(this.selector) : null;
  }

  /** @param {MouseEvent} event */
  ask(event) {
    const part = this.partAt(event);
    if (!part) return;
    event.preventDefault();
    if (this.wasLong) return;
    this.wasLong = this.press !== null;
    this.end();
    this.onAsk(part, { x: event.clientX, y: event.clientY });
  }

  /** @param {KeyboardEvent} event */
  onKey(event) {
    const part = this.partAt(event);
    const isMenuKey = event.key === "ContextMenu" || (event.key === "F10" && event.shiftKey);
    if (!part || !isMenuKey) return;
    event.preventDefault();
    event.stopPropagation();
    const box = part.getBoundingClientRect();
    this.onAsk(part, { x: box.left + Math.min(INSET_PX, box.width / 2), y: box.bottom });
  }

  /** @param {PointerEvent} event */
  begin(event) {
    this.end();
    this.wasLong = false;
    const part = this.partAt(event);
    if (!part || event.pointerType === "mouse" || !event.isPrimary) return;
    const { pointerId: id, clientX: x, clientY: y } = event;
    const timer = setTimeout(() => this.lasts(), LONG_PRESS_MS);
    this.press = { part, id, x, y, timer };
  }

  /** @param {PointerEvent} event */
  go({ clientX, clientY }) {
    const { press } = this;
    if (press && Math.hypot(clientX - press.x, clientY - press.y) > SLACK_PX) this.end();
  }

  lasts() {
    const { press } = this;
    if (!press) return;
    this.wasLong = true;
    this.end();
    if (this.root.hasPointerCapture(press.id)) this.root.releasePointerCapture(press.id); // it pulls nothing any more
    this.onAsk(press.part, press);
  }

  end() {
    clearTimeout(this.press?.timer);
    this.press = null;
  }

  /** A long press may end with a click, which is not meant as one. @param {MouseEvent} event */
  swallow(event) {
    if (!this.wasLong || event.detail === 0) return;
    this.wasLong = false;
    event.stopPropagation();
    event.preventDefault();
  }
}
