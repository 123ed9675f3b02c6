/** Menus whose options have pictures, where the browser draws such lists; elsewhere they have words alone. */

import { element, svg } from "./dom.js";

/** @import { RobotEntry } from "pleat" */

/** @param {SVGElement} image @param {string} words @param {string} value */
export function pictured(image, words, value) {
  const made = new Option("", value);
  made.append(image, element("span", "", words));
  return made;
}

const HEAD = "M10 4H14V7H10Z";
const TWO_ARMS = "M12 7V19M12 10H7L4 14L7 17M12 10H17L20 14L17 17";
const ONE_ARM = "M9 20V13L16 7L19 13";
const FOOT = "M8 21H16";
const WHEELS = "M7 19H17M8 22H8.1M16 22H16.1";

/** A robot in small: what it stands on, and its arms. @param {RobotEntry} robot @returns {SVGElement} */
export function robotPicture({ arms, base }) {
  const made = svg("svg", { class: "picture-robot", viewBox: "0 0 24 24", "aria-hidden": "true" });
  const body = arms.length > 1 ? HEAD + TWO_ARMS : ONE_ARM;
  made.append(svg("path", { d: body + (base === "fixed" ? FOOT : WHEELS) }));
  return made;
}
