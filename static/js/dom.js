/** Small things for building elements and telling errors. */

/**
 * @param {string} id of an element that is there
 * @returns {HTMLElement}
 */
export function byId(id) {
  const found = document.getElementById(id);
  if (!found) throw new Error(`no element #${id}`);
  return found;
}

/**
 * @param {string} tag
 * @param {string} className
 * @param {...(Node|string)} children
 * @returns {HTMLElement}
 */
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

/** Return what an error says. @param {unknown} error */
export const sayable = (error) => (error instanceof Error ? error.message : String(error));
