/** Line drawings for buttons, in the text's colour; hidden from screen readers, as what they stand for has a name. */

import { svg } from "./dom.js";

/** Those of 20 x 20. */
const PATHS = {
  select: "M5 3l10 7-4.4.9L13 16l-2 1-2.4-5.2L5 15z",
  outline:
    "M4 15l3-10 9 2-2 9z M4 15m-1.5 0a1.5 1.5 0 1 0 3 0a1.5 1.5 0 1 0-3 0 M16 7m-1.5 0a1.5 1.5 0 1 0 3 0a1.5 1.5 0 1 0-3 0",
  fold: "M3 16V4h14l-14 12z M7 16h10V7.5 M3 16L17 4",
  place:
    "M10 3v14M3 10h14M10 3L8 5.2M10 3l2 2.2M10 17l-2-2.2M10 17l2-2.2M3 10l2.2-2M3 10l2.2 2M17 10l-2.2-2M17 10l-2.2 2",
  mirror: "M10 2.5v15 M8 5L3 15h5z M12 5l5 10h-5z",
  snap: "M5 3v6a5 5 0 0 0 10 0V3 M5 6.5h3 M12 6.5h3 M8 3v6a2 2 0 0 0 4 0V3 M5 3h3 M12 3h3",
  measure: "M3 13.5L13.5 3 17 6.5 6.5 17z M6 10.5l1.6 1.6 M8.5 8l2.4 2.4 M11 5.5l1.6 1.6",
  photo: "M3 5h14v11H3z M3 13.5l4-4 3.5 3.5 2.5-2.5 4 3.5 M12.5 8m-1.2 0a1.2 1.2 0 1 0 2.4 0a1.2 1.2 0 1 0-2.4 0",
  undo: "M7.5 4L4 7.5 7.5 11 M4 7.5h8a4.2 4.2 0 0 1 0 8.5H8",
  redo: "M12.5 4L16 7.5 12.5 11 M16 7.5H8a4.2 4.2 0 0 0 0 8.5h4",
  gallery: "M3.5 3.5h5v5h-5z M11.5 3.5h5v5h-5z M3.5 11.5h5v5h-5z M11.5 11.5h5v5h-5z",
  new: "M5 3h7l3.5 3.5V17H5z M12 3v3.5h3.5 M10 9v5 M7.5 11.5h5",
  import: "M10 3v9 M6.5 8.5L10 12l3.5-3.5 M4 13v4h12v-4",
  export: "M10 12V3 M6.5 6.5L10 3l3.5 3.5 M4 13v4h12v-4",
  moon: "M15.5 12A6.5 6.5 0 0 1 8 4.5a6.5 6.5 0 1 0 7.5 7.5z",
  sun: "M10 6.5a3.5 3.5 0 1 0 0 7a3.5 3.5 0 1 0 0-7z M10 2v2M10 16v2M2 10h2M16 10h2M4.3 4.3l1.4 1.4M14.3 14.3l1.4 1.4M4.3 15.7l1.4-1.4M14.3 5.7l1.4-1.4",
  rename: "M4 16l.8-3.6L13 4.2l2.8 2.8-8.2 8.2z M11.4 5.8l2.8 2.8",
  share: "M8 11.5a3 3 0 0 0 4.3 0l3-3a3 3 0 0 0-4.3-4.3l-1 1 M12 8.5a3 3 0 0 0-4.3 0l-3 3a3 3 0 0 0 4.3 4.3l1-1",
  jobs: "M4 5h2M9 5h7M4 10h2M9 10h7M4 15h2M9 15h7",
  settings:
    "M3 6h7.5M15.5 6H17M13 6m-2.2 0a2.2 2.2 0 1 0 4.4 0a2.2 2.2 0 1 0-4.4 0 M3 14h1.5M9.5 14H17M7 14m-2.2 0a2.2 2.2 0 1 0 4.4 0a2.2 2.2 0 1 0-4.4 0",
  help: "M7.5 7.5a2.5 2.5 0 1 1 3.6 2.2c-.7.4-1.1.9-1.1 1.8 M10 14.4v.2",
  fit: "M3 7V3h4 M13 3h4v4 M17 13v4h-4 M7 17H3v-4",
  back: "M12 4.5L6.5 10l5.5 5.5",
  next: "M8 4.5l5.5 5.5L8 15.5",
  flip: "M4 7h11l-3-3 M16 13H5l3 3",
  grab: "M6 10V5.5a1.3 1.3 0 0 1 2.6 0V9 M8.6 9V4.3a1.3 1.3 0 0 1 2.6 0V9 M11.2 9V5a1.3 1.3 0 0 1 2.6 0V9.5 M13.8 9.5V7.2a1.2 1.2 0 0 1 2.4 0V12a5 5 0 0 1-5 5h-.8a5 5 0 0 1-4-2L3.6 11.6a1.2 1.2 0 0 1 1.9-1.5L6 10.7",
  close: "M5 5l10 10 M15 5L5 15",
  more: "M5 10h.01M10 10h.01M15 10h.01",
  trash: "M4 6h12 M8 6V4h4v2 M6 6l.7 11h6.6L14 6",
};

/** Those of 16 x 16: each as a path, and whether it is filled. @satisfies {Record<string, [string, boolean]>} */
const SMALL = {
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

/** @param {keyof typeof PATHS} name */
export const icon = (name) => drawn(20, PATHS[name], false);

/** One of the small icons of the dock. @param {keyof typeof SMALL} name */
export function smallIcon(name) {
  const [path, isFilled] = SMALL[name];
  return drawnIcon(path, isFilled);
}

/** A small icon of its own. @param {string} path @param {boolean} isFilled */
export const drawnIcon = (path, isFilled = false) => drawn(16, path, isFilled);

/** @param {number} size @param {string} path @param {boolean} isFilled */
function drawn(size, path, isFilled) {
  const kind = isFilled ? "icon is-filled" : "icon";
  return svg("svg", { viewBox: `0 0 ${size} ${size}`, class: kind, "aria-hidden": "true" }, svg("path", { d: path }));
}
