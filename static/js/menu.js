/** A context menu: verbs for the part of the page that it is opened at. Its keys are those of menus everywhere. */

import { button, element } from "./dom.js";

/** How far it keeps from the window's edges (px). */
const MARGIN_PX = 8;

/**
 * An entry of a menu; one that is off stays readable, its hint says why.
 * @typedef {{text: string, hint: string, isOff: boolean, choose: () => void}} Entry
 */

export class Menu {
  constructor() {
    this.root = element("div", "menu");
    this.root.setAttribute("role", "menu");
    this.root.hidden = true;
    /** @type {HTMLElement|null} what it was opened at: it gets the focus back */
    this.opener = null;
    this.root.addEventListener("keydown", (event) => this.onKey(event));
    this.root.addEventListener("contextmenu", (event) => event.preventDefault());
    document.addEventListener("pointerdown", (event) => this.isOutside(event) && this.close(), true);
    for (const name of ["blur", "resize"]) addEventListener(name, () => this.close());
    document.addEventListener("scroll", (event) => this.opener && isAround(event, this.opener) && this.close(), true);
    document.body.append(this.root);
  }

  get isOpen() {
    return this.opener !== null;
  }

  get items() {
    return /** @type {HTMLElement[]} */ ([...this.root.children]);
  }

  /**
   * @param {string} label what the menu is about
   * @param {Entry[]} entries
   * @param {HTMLElement} opener
   * @param {{x: number, y: number}} at where in the window (px)
   */
  open(label, entries, opener, { x, y }) {
    this.root.setAttribute("aria-label", label);
    this.root.replaceChildren(...entries.map((entry) => this.item(entry)));
    this.root.hidden = false;
    this.opener = opener;
    const { offsetWidth: width, offsetHeight: height } = this.root;
    const right = x + width + MARGIN_PX > innerWidth ? Math.max(innerWidth - width - MARGIN_PX, MARGIN_PX) : x;
    const above = y + height + MARGIN_PX > innerHeight ? Math.max(y - height, MARGIN_PX) : y;
    Object.assign(this.root.style, { left: `${right}px`, top: `${above}px` });
    this.items[0]?.focus({ preventScroll: true });
  }

  /** @param {boolean} isFocusBack whether the focus goes back to where it was opened */
  close(isFocusBack = false) {
    const { opener } = this;
    if (!opener) return;
    this.opener = null; // first: to hide it takes the focus from it
    this.root.hidden = true;
    if (isFocusBack) opener.focus({ preventScroll: true });
  }

  /** @param {Entry} entry */
  item({ text, hint, isOff, choose }) {
    const chosen = () => {
      if (isOff) return;
      this.close(true);
      choose();
    };
    const made = button("menu-item", chosen, element("span", "", text), element("small", "menu-hint", hint));
    made.setAttribute("role", "menuitem");
    made.setAttribute("aria-disabled", String(isOff));
    made.tabIndex = -1;
    return made;
  }

  /** While it is open the keys are its own, whatever they mean elsewhere on the page. @param {KeyboardEvent} event */
  onKey(event) {
    event.stopPropagation();
    const { items } = this;
    const now = items.findIndex((item) => item === document.activeElement);
    /** @type {Record<string, number>} */
    const targets = { ArrowDown: now + 1, ArrowUp: now - 1, Home: 0, End: -1 };
    const target = targets[event.key];
    if (target !== undefined) items.at(target % items.length)?.focus();
    else if (event.key === "Escape" || event.key === "Tab") this.close(true);
    else return;
    event.preventDefault();
  }

  /** @param {Event} event */
  isOutside(event) {
    return !this.root.contains(/** @type {Node} */ (event.target));
  }
}

/** Whether what happens to a part of the page happens to what is in it too. @param {Event} event @param {Node} part */
const isAround = (event, part) => event.target instanceof Node && event.target.contains(part);
