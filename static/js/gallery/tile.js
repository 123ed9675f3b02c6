/** A tile of the gallery: a picture, a title, and a word about it. */

import { picture } from "../dialogs/picture.js";
import { button, element } from "../dom.js";
import { times } from "../language/language.js";
import { say, translated } from "../language/say.js";

/** @import { DocumentEntry, Garment, GarmentEntry, Point } from "pleat" */

/**
 * @param {string} title
 * @param {string} about
 * @param {Point[]} outline
 * @param {{kind: string, start: Point, end: Point}[]} folds
 * @param {() => void} onClick
 */
export function tile(title, about, outline, folds, onClick) {
  const words = [element("span", "tile-title", title), ...(about ? [element("span", "tile-about", about)] : [])];
  const made = button("tile", onClick, picture(outline, folds), ...words);
  made.dataset.title = title;
  made.title = title;
  return made;
}

/** A garment of which a new document is made; its picture comes by itself. @param {GarmentEntry} entry @param {() => void} onClick */
export function garmentTile({ name, title, shipped }, onClick) {
  const made = tile(translated(title), shipped ? "" : say("gallery.your_garment"), [], [], onClick);
  const [image] = made.children;
  drawGarment(name, image);
  return made;
}

/** Put a garment's picture in the place of another once it is there. @param {string} name @param {Element} instead */
export async function drawGarment(name, instead) {
  const answer = await fetch(`../api/garments/${name}`).catch(() => null);
  if (!answer?.ok) return;
  /** @type {Garment} */
  const { outline, folds } = await answer.json();
  instead.replaceWith(picture(outline, folds));
}

/** @param {Pick<DocumentEntry, "title"|"name">} entry */
export const titleOf = ({ title, name }) => translated(title) || name;

/** When something was changed, as people say it; empty where that is not known. @param {string} changedAt */
export function when(changedAt) {
  if (!changedAt) return "";
  const moment = new Date(changedAt);
  const isToday = moment.toDateString() === new Date().toDateString();
  return isToday
    ? moment.toLocaleTimeString(times, { hour: "2-digit", minute: "2-digit" })
    : moment.toLocaleDateString(times, { day: "numeric", month: "short", year: "numeric" });
}
