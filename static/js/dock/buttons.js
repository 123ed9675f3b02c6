/** The dock's buttons. */

import { button } from "../dom.js";
import { smallIcon } from "../icons.js";

/**
 * A button with an icon alone.
 * @param {Parameters<typeof smallIcon>[0]} name
 * @param {string} label what it does
 * @param {(event: Event) => void} onClick
 * @returns {HTMLButtonElement}
 */
export function iconButton(name, label, onClick) {
  const made = button("icon-button is-dense", onClick, smallIcon(name));
  relabel(made, label);
  return made;
}

/** @param {HTMLElement} made @param {string} label */
export function relabel(made, label) {
  if (made.getAttribute("aria-label") === label) return;
  made.setAttribute("aria-label", label);
  made.title = label;
}

/**
 * A button that is on or off.
 * @param {string} text
 * @param {(isOn: boolean) => void} onToggle
 * @returns {HTMLButtonElement}
 */
export function toggle(text, onToggle) {
  const made = button("chip", () => onToggle(made.getAttribute("aria-pressed") !== "true"), text);
  made.setAttribute("aria-pressed", "false");
  return made;
}
