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

/**
 * @template {keyof SVGElementTagNameMap} T
 * @param {T} tag
 * @param {Record<string, unknown>} attributes
 * @param {...(Node|string)} children
 * @returns {SVGElementTagNameMap[T]}
 */
export function svg(tag, attributes = {}, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  made.append(...children);
  return made;
}

/** @param {string} className @param {Partial<HTMLInputElement>} properties @returns {HTMLInputElement} */
export function input(className, properties) {
  const made = /** @type {HTMLInputElement} */ (element("input", className));
  Object.assign(made, properties);
  return made;
}

/** A field for a text or a number, which the browser does not complete. @param {Partial<HTMLInputElement>} properties */
export const field = (properties) => input("field", { autocomplete: "off", ...properties });

/** A bar that shows how far work is. @param {string} label @returns {HTMLProgressElement} */
export function progressBar(label) {
  const made = /** @type {HTMLProgressElement} */ (element("progress", "job-progress"));
  made.setAttribute("aria-label", label);
  return made;
}

/** A paragraph whose text screen readers tell when it changes. @param {string} className @param {"status"|"alert"} role */
export function toldAloud(className, role = "status") {
  const made = element("p", className);
  made.setAttribute("role", role);
  return made;
}

/** Have screen readers tell some controls as a group. @param {HTMLElement} made @param {string} label */
export function group(made, label) {
  made.setAttribute("role", "group");
  made.setAttribute("aria-label", label);
  return made;
}

/** Let the arrow keys lead from button to button of a group. @param {HTMLElement} within @param {KeyboardEvent} event */
export function arrowsLead(within, event) {
  const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  const buttons = [...within.querySelectorAll("button")];
  const index = buttons.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
  if (!by || index < 0) return;
  event.preventDefault();
  event.stopPropagation();
  buttons[(index + by + buttons.length) % buttons.length].focus();
}

/** Return what an error says. @param {unknown} error */
export const sayable = (error) => (error instanceof Error ? error.message : String(error));
