/** The dock's icons: 16 x 16, drawn with the colour of the text. */

const SVG = "http://www.w3.org/2000/svg";

/** Each as a path, and whether it is filled. @satisfies {Record<string, [string, boolean]>} */
const PATHS = {
  play: ["M5 3.2v9.6L13 8z", true],
  pause: ["M4.5 3h2.6v10H4.5zM8.9 3h2.6v10H8.9z", true],
  next: ["M4 3.2v9.6L10.5 8zM11.2 3h1.8v10h-1.8z", true],
  previous: ["M12 3.2v9.6L5.5 8zM3 3h1.8v10H3z", true],
  eye: ["M1.5 8S4 3.8 8 3.8 14.5 8 14.5 8 12 12.2 8 12.2 1.5 8 1.5 8zM8 6a2 2 0 1 1 0 4 2 2 0 0 1 0-4z", false],
  bin: ["M3 4.5h10M6.5 4.5V3h3v1.5M4.3 4.5l.6 8.5h6.2l.6-8.5M6.8 7v3.6M9.2 7v3.6", false],
  pen: ["M3 13l.7-2.9 7-7 2.2 2.2-7 7zM9.4 4.4l2.2 2.2", false],
  up: ["M8 13V3.5M4.2 7.2 8 3.4l3.8 3.8", false],
  down: ["M8 3v9.5M4.2 8.8 8 12.6l3.8-3.8", false],
  tick: ["M3.5 8.4l3 3 6-6.6", false],
};

/**
 * @param {keyof typeof PATHS} name
 * @returns {SVGSVGElement} hidden from screen readers: what it stands for has a name of its own
 */
export function icon(name) {
  const [path, isFilled] = PATHS[name];
  return drawnIcon(path, isFilled);
}

/** An icon of its own. @param {string} path @param {boolean} isFilled @returns {SVGSVGElement} */
export function drawnIcon(path, isFilled = false) {
  const kind = isFilled ? "icon is-filled" : "icon";
  const drawn = svg("svg", { viewBox: "0 0 16 16", class: kind, "aria-hidden": "true" });
  drawn.append(svg("path", { d: path }));
  return /** @type {SVGSVGElement} */ (drawn);
}

/**
 * @param {string} tag
 * @param {Record<string, string|number>} attributes
 * @param {...(Node|string)} children
 * @returns {SVGElement}
 */
export function svg(tag, attributes, ...children) {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  made.append(...children);
  return made;
}
