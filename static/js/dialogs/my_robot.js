/**
 * `My robot`: what was guessed of a robot that came without a card. What is corrected is a change of the card that the
 * drawing's robot is named with, so the robot is seen and planned for with it at once; saved, it is the card's.
 */

import { number, parsed, unit } from "../board/units.js";
import { button, element, field, toldAloud } from "../dom.js";
import { numeral } from "../language/numeral.js";
import { inEnglish, say } from "../language/say.js";
import { armTitle } from "../messages/arms.js";
import { OFFLINE, openDialog, sentenceOf } from "./dialog.js";

/** @import { Store } from "../store.js" */

/** @typedef {Record<string, any>} Card a robot's card as JSON */
/** @typedef {{guesses: string[], unknown: string[]}} Draft */
/**
 * A field of the card.
 * @typedef {object} Field
 * @property {string} label
 * @property {string} path in the card, its parts joined by dots
 * @property {boolean} isLength whether its numbers are lengths, in the unit of the page
 */

const DEGREES = 180 / Math.PI;
const BASES = /** @type {const} */ (["fixed", "omni", "differential"]);

/** @param {Store} store @param {string} name the robot's @param {Draft} draft */
export async function showMyRobot(store, name, draft) {
  const answer = await fetch(`../api/robots/${encodeURIComponent(name)}`).catch(() => null);
  if (answer?.ok) new MyRobot(store, await answer.json(), draft);
}

class MyRobot {
  /** @param {Store} store @param {Card} card @param {Draft} draft */
  constructor(store, card, draft) {
    this.store = store;
    this.card = card;
    /** What was corrected, by path. @type {Map<string, unknown>} */
    this.changes = new Map();
    this.title = card.title;
    this.problem = toldAloud("dialog-problem", "alert");
    this.dialog = openDialog(
      say("my_robot.title"),
      "is-beside",
      element("p", "dialog-text", say("my_robot.about")),
      element("div", "my-robot", this.titleField(), this.baseField(), ...this.fields().map((field) => this.row(field))),
      told(say("my_robot.guessed"), draft.guesses),
      told(say("my_robot.unknown"), draft.unknown),
      this.problem,
      element("div", "dialog-buttons", button("main-button", () => this.save(), say("my_robot.save"))),
    );
  }

  /** @returns {Field[]} */
  fields() {
    const { scene, arms, mounts } = this.card;
    const station = `scene.stations.${Object.keys(scene.stations)[0]}`;
    /** @type {(label: string, path: string, isLength?: boolean) => Field} */
    const of = (label, path, isLength = true) => ({ label, path, isLength });
    return [
      of(say("my_robot.table"), "scene.table.height_m"),
      ...(mounts.length === 1 ? [of(say("my_robot.foot"), "mounts.0.z_m")] : []),
      of(say("my_robot.ahead"), `${station}.x_m`),
      of(say("my_robot.aside"), `${station}.y_m`),
      of(say("my_robot.turned"), `${station}.yaw_rad`, false),
      ...arms.flatMap((/** @type {Card} */ { name, tool }, /** @type {number} */ index) => {
        const arm = armTitle(name);
        return [
          of(say("my_robot.tool", { arm, link: tool.link }), `arms.${index}.tool.offset_m`),
          of(say("my_robot.opening", { arm }), `arms.${index}.gripper.opening_max_m`),
          of(say("my_robot.home", { arm }), `arms.${index}.home`, false),
        ];
      }),
    ];
  }

  titleField() {
    const input = field({ value: this.title, maxLength: 200 });
    input.addEventListener("change", () => (this.title = input.value.trim() || this.title));
    return labelled(say("rename.name"), input);
  }

  baseField() {
    const select = /** @type {HTMLSelectElement} */ (element("select", ""));
    select.append(...BASES.map((kind) => new Option(say(`my_robot.base.${kind}`), kind)));
    select.value = this.card.base.kind;
    select.addEventListener("change", () => this.change("base.kind", select.value));
    return labelled(say("my_robot.base"), select);
  }

  /** @param {Field} about */
  row({ label, path, isLength }) {
    const value = at(this.card, path);
    const numbers = Array.isArray(value) ? value : [value];
    const shown = numbers.map((one) => (isLength ? number(one) : numeral(one * DEGREES, 1)));
    const input = field({ value: shown.join("; ") });
    input.addEventListener("change", () => {
      const read = input.value.split(";").map((text) => inMetresOrRadians(text, isLength));
      const isRead = read.length === numbers.length && !read.includes(null);
      if (isRead) void this.change(path, Array.isArray(value) ? read : read[0]);
      else this.problem.textContent = say("length.no_number", { text: input.value });
    });
    return labelled(isLength ? `${label} (${unit.name})` : `${label} (°)`, input);
  }

  /** @param {string} path @param {unknown} value */
  async change(path, value) {
    this.problem.textContent = "";
    this.changes.set(path, value);
    const told = [...this.changes].map(([field, now]) => `${field}=${JSON.stringify(now)}`);
    if (!(await this.store.putRobot(`${this.card.name}@${told.join(":")}`))) this.changes.delete(path); // it says why
  }

  async save() {
    /** @type {Card} */
    const card = { ...structuredClone(this.card), title: this.title };
    for (const [path, value] of this.changes) put(card, path, value);
    const headers = { "content-type": "application/json" };
    const url = `../api/robots/${encodeURIComponent(card.name)}`;
    const answer = await fetch(url, { method: "PUT", headers, body: JSON.stringify(card) }).catch(() => null);
    if (!answer?.ok) {
      this.problem.textContent = answer ? sentenceOf(await answer.json()) : OFFLINE;
      return;
    }
    dispatchEvent(new Event("robots"));
    this.dialog.close();
    this.store.edit(inEnglish("my_robot.save"), (drawing) => Object.assign(drawing, { robot: card.name }));
  }
}

/** To the micrometre, as people write: 70 cm is 0.7 m. @param {string} text @param {boolean} isLength @returns {number|null} */
function inMetresOrRadians(text, isLength) {
  const degrees = text.trim() ? Number(text.trim().replace(",", ".")) : NaN;
  const value = isLength ? parsed(text) : degrees / DEGREES;
  return value !== null && Number.isFinite(value) ? Number(value.toFixed(6)) : null;
}

/** @param {Card} card @param {string} path @returns {any} */
const at = (card, path) => path.split(".").reduce((/** @type {any} */ part, name) => part[name], card);

/** @param {Card} card is altered @param {string} path @param {unknown} value */
function put(card, path, value) {
  const names = path.split(".");
  const last = names.pop() ?? "";
  at(card, names.join("."))[last] = value;
}

/** @param {string} label @param {HTMLElement} control */
const labelled = (label, control) => element("label", "", element("span", "dialog-text", label), control);

/** Sentences that the server tells in English. @param {string} heading @param {string[]} sentences */
function told(heading, sentences) {
  const list = element("ul", "notes", ...sentences.map((sentence) => element("li", "", sentence)));
  list.lang = "en";
  const made = element("details", "", element("summary", "", heading), list);
  made.hidden = !sentences.length;
  return made;
}
