/** Small things for building elements and telling errors. */

/** @param {string} id of an element that is there @returns {HTMLElement} */
export function byId(id) {
  const found = document.getElementById(id);
  if (!found) throw new Error(`no element #${id}`);
  return found;
}

/** @param {string} tag @param {string} className @param {...(Node|string)} children @returns {HTMLElement} */
export function element(tag, className, ...children) {
  const made = document.createElement(tag);
  if (className) made.className = className;
  made.append(...children);
  return made;
}

/**
 * @param {string} className
 * @param {(event: MouseEvent) => void} onClick
 * @param {...(Node|string)} children
 * @returns {HTMLButtonElement}
 */
export function button(className, onClick, ...children) {
  const made = /** @type {HTMLButtonElement} */ (element("button", className, ...children));
  made.type = "button";
  made.addEventListener("click", onClick);
  return made;
}

/** Let the arrow keys lead from button to button of a group. @param {HTMLElement} group @param {KeyboardEvent} event */
export function arrowsLead(group, event) {
  const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  const buttons = [...group.querySelectorAll("button")];
  const index = buttons.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
  if (!by || index < 0) return;
  event.preventDefault();
  event.stopPropagation();
  buttons[(index + by + buttons.length) % buttons.length].focus();
}

/** Return what an error says. @param {unknown} error */
export const sayable = (error) => (error instanceof Error ? error.message : String(error));
