/** `Import`: a garment file, a plan file, an SVG, a DXF, a picture or a robot, chosen or dropped on the page. */

import { boxOf } from "../board/geometry.js";
import { length, parsed, problemOf, unit } from "../board/units.js";
import { button, element } from "../dom.js";
import { titleOf } from "../gallery/tile.js";
import { inEnglish, say } from "../language/say.js";
import { openDialog, OFFLINE, sentenceOf } from "./dialog.js";
import { inWords } from "../messages/in_words.js";
import { goToNew } from "./documents.js";
import { likeness } from "./likeness.js";
import { picture } from "./picture.js";
import { takeRobot } from "./take_robot.js";

/** @import { Garment, Imported } from "pleat" */
/** @import { Told } from "../messages/in_words.js" */
/** @import { Store } from "../store.js" */

const KINDS = ".json,.svg,.dxf,.png,.jpg,.jpeg,.zip";
const UNITS = ["mm", "cm", "m", "in"];
/** @typedef {NonNullable<Imported["creases"]>} Creases */
/** @typedef {NonNullable<Imported["sizes"]>} Sizes by unit, how wide and how high (m) */

/** No garment is shorter or longer (m). */
const [LEAST_M, MOST_M] = [0.01, 10];

/** @param {Store} store @param {File|null} first a file that was dropped */
export function showImport(store, first = null) {
  const body = element("div", "import");
  openDialog(say("import.title"), "", body);
  if (first) read(store, body, first, {});
  else ask(store, body);
}

/** Take files that are dropped anywhere on the page. @param {Store} store */
export function acceptDrops(store) {
  /** @param {DragEvent} event */
  const hasFiles = (event) => event.dataTransfer?.types.includes(say("import.files"));
  addEventListener("dragover", (event) => {
    if (hasFiles(event)) event.preventDefault();
  });
  addEventListener("drop", (event) => {
    const file = event.dataTransfer?.files[0];
    if (!hasFiles(event) || !file) return;
    event.preventDefault();
    for (const dialog of document.querySelectorAll("dialog[open]")) /** @type {HTMLDialogElement} */ (dialog).close();
    showImport(store, file);
  });
}

/** @param {Store} store @param {HTMLElement} body @param {string} problem */
function ask(store, body, problem = "") {
  const input = /** @type {HTMLInputElement} */ (element("input", ""));
  input.type = "file";
  input.accept = KINDS;
  input.setAttribute("aria-label", say("import.file"));
  input.addEventListener("change", () => input.files?.[0] && read(store, body, input.files[0], {}));
  const said = element("p", "dialog-problem", problem);
  said.setAttribute("role", "alert");
  body.replaceChildren(
    element(
      "label",
      "drop",
      element("strong", "", say("import.choose")),
      element("span", "", say("import.drop")),
      input,
    ),
    element("p", "dialog-text", say("import.about")),
    said,
  );
}

/**
 * What is to be said beside the file to read it; without it the file says so itself.
 * @typedef {{units?: string, scale?: number, creases?: Creases, measured?: string, like?: string}} How
 */

/** @param {Store} store @param {HTMLElement} body @param {File} file @param {How} how */
async function read(store, body, file, how) {
  body.replaceChildren(element("p", "dialog-text", say("import.reading", { name: file.name })));
  if (/\.zip$/i.test(file.name)) {
    const problem = await takeRobot(store, file);
    if (problem) ask(store, body, problem);
    else body.closest("dialog")?.close();
    return;
  }
  const query = new URLSearchParams({ filename: file.name });
  for (const [name, value] of Object.entries(how)) if (value !== undefined) query.set(name, String(value));
  const answer = await fetch(`../api/imports?${query}`, { method: "POST", body: file }).catch(() => null);
  const told = answer ? await answer.json() : null;
  if (answer?.ok) found(store, body, file, how, told);
  else if (told?.errors?.[0]?.field === "measured") askLength(store, body, file, how, inWords(told.errors[0], []));
  else if (told?.sizes) askSize(store, body, file, how, told.sizes, inWords(told.errors[0], []));
  else ask(store, body, told ? `${file.name}: ${sentenceOf(told)}` : OFFLINE);
}

/**
 * How large the garment is: by one of the units, or by its width.
 * @param {Store} store
 * @param {HTMLElement} body
 * @param {File} file
 * @param {How} how
 * @param {Sizes} sizes
 * @param {string} why
 */
function askSize(store, body, file, how, sizes, why) {
  /** @param {How} size */
  const readAs = (size) => read(store, body, file, { ...how, ...size });
  /** @param {[number, number]} sides */
  const isPossible = (sides) => Math.min(...sides) > 0 && Math.max(...sides) >= LEAST_M && Math.max(...sides) <= MOST_M;
  const choices = UNITS.filter((name) => sizes[name] && isPossible(sizes[name])).map((name) => {
    const [wide, tall] = sizes[name].map((metres) => length(metres));
    return button(
      "plain-button",
      () => readAs({ units: name, scale: how.scale ?? 1 }),
      say("import.size", { name, wide, tall }),
    );
  });
  const said = element("p", "dialog-problem");
  said.setAttribute("role", "alert");
  const input = /** @type {HTMLInputElement} */ (element("input", "field"));
  input.autocomplete = "off";
  const form = /** @type {HTMLFormElement} */ (element("form", "width-form"));
  const label = element("label", "measure", element("span", "measure-name", say("import.its_width")), input);
  label.append(element("span", "measure-unit", unit.name));
  form.append(label, element("button", "plain-button", say("import.use_width")));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    said.textContent = problemOf(input.value, LEAST_M);
    if (!said.textContent) readAs(scaledTo(parsed(input.value) ?? 0, sizes, how.scale ?? 1));
  });
  body.replaceChildren(
    element("p", "dialog-text", `${file.name}: ${why}.`),
    element("p", "dialog-text", say("import.how_large")),
    element("div", "unit-choices", ...choices),
    form,
    said,
  );
}

/**
 * How long the garment in a picture is, where nothing in it tells.
 * @param {Store} store
 * @param {HTMLElement} body
 * @param {File} file
 * @param {How} how
 * @param {string} why
 */
function askLength(store, body, file, how, why) {
  const said = element("p", "dialog-problem");
  said.setAttribute("role", "alert");
  const input = /** @type {HTMLInputElement} */ (element("input", "field"));
  input.autocomplete = "off";
  const form = /** @type {HTMLFormElement} */ (element("form", "width-form"));
  const label = element("label", "measure", element("span", "measure-name", say("import.end_to_end")), input);
  label.append(element("span", "measure-unit", unit.name));
  form.append(label, element("button", "plain-button", say("import.use_length")));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    said.textContent = problemOf(input.value, LEAST_M);
    const length_m = (parsed(input.value) ?? 0).toFixed(6);
    if (!said.textContent) read(store, body, file, { ...how, measured: `${length_m}m:longest` });
  });
  body.replaceChildren(
    element("p", "dialog-text", `${file.name}: ${why}.`),
    element("p", "dialog-text", say("import.how_long")),
    form,
    said,
  );
}

/**
 * The unit and the scale of it that make a garment so wide; the scale that is nearest to 1.
 * @param {number} width_m
 * @param {Sizes} sizes
 * @param {number} scale of the sizes
 * @returns {How}
 */
function scaledTo(width_m, sizes, scale) {
  const ways = UNITS.filter((name) => sizes[name]).map((units) => ({
    units,
    scale: (scale * width_m) / sizes[units][0],
  }));
  return ways.reduce((best, way) => (Math.abs(Math.log(way.scale)) < Math.abs(Math.log(best.scale)) ? way : best));
}

/**
 * Show what was read.
 * @param {Store} store
 * @param {HTMLElement} body
 * @param {File} file
 * @param {How} how
 * @param {Imported} imported
 */
function found(store, body, file, how, { garment, notes, says, creases, sizes, seen }) {
  const said = element("p", "dialog-problem");
  const here = button("main-button", () => open(store, body, file, garment), say("import.open_here"));
  const anew = button("plain-button", () => create(garment, said), say("import.open_new"));
  /** @param {Sizes} known */
  const other = (known) => askSize(store, body, file, how, known, say("import.garment_is", { size: sizeOf(garment) }));
  const verbs = sizes ? [button("plain-button", () => other(sizes), say("import.another_size"))] : [];
  body.replaceChildren(
    element(
      "div",
      "found",
      picture(garment.outline, garment.folds),
      element(
        "div",
        "",
        element("h3", "", garment.title),
        element("p", "dialog-text", counted(garment)),
        element("ul", "notes", ...notes.map((message, n) => note({ says: says[n], message }, garment.folds))),
      ),
    ),
    ...(seen ? [likeness(how.like, (like) => read(store, body, file, { ...how, like }))] : []),
    ...(creases ? [onWhichCloth(creases, (chosen) => read(store, body, file, { ...how, creases: chosen }))] : []),
    ...replaces(store),
    said,
    element("div", "dialog-buttons", ...verbs, anew, here),
  );
  here.focus();
}

/** What would be gone from this document, where anything is drawn in it. @param {Store} store */
function replaces({ state }) {
  if (!state?.drawing.outline.length) return [];
  const { title, name } = state.drawing;
  return [element("p", "dialog-text", say("import.replaces", { title: titleOf({ title, name }) }))];
}

/**
 * On which cloth the fold lines are drawn, where that matters.
 * @param {Creases} creases
 * @param {(chosen: Creases) => void} onChoice
 */
function onWhichCloth(creases, onChoice) {
  /** @param {Creases} value @param {string} text */
  const choice = (value, text) => {
    const input = /** @type {HTMLInputElement} */ (element("input", ""));
    Object.assign(input, { type: "radio", name: "creases", value, checked: value === creases });
    input.addEventListener("change", () => onChoice(value));
    return element("label", "choice", input, text);
  };
  return element(
    "fieldset",
    "choices",
    element("legend", "", say("import.lines_drawn_on")),
    choice("folded", say("import.on_folded")),
    choice("flat", say("import.on_flat")),
  );
}

/** @param {Garment} garment */
function sizeOf({ outline }) {
  const box = boxOf(outline);
  return box
    ? say("import.by", { wide: length(box.high[0] - box.low[0]), tall: length(box.high[1] - box.low[1]) })
    : "";
}

/** What is to be said of how the garment was read. @param {Told} told @param {{name?: string}[]} folds */
function note(told, folds) {
  const text = inWords(told, folds);
  return element("li", "", text[0].toUpperCase() + text.slice(1) + (text.endsWith(".") ? "" : "."));
}

/** @param {Garment} garment */
const counted = ({ outline, folds }) =>
  `${say("import.corners", { count: outline.length })}, ${say("import.folds", { count: folds.length })}`;

/** @param {Store} store @param {HTMLElement} body @param {File} file @param {Garment} garment */
async function open(store, body, file, garment) {
  const state = await store.open(garment, inEnglish("step.import", { name: file.name }));
  if (state) body.closest("dialog")?.close();
}

/** @param {Garment} garment @param {HTMLElement} said */
async function create(garment, said) {
  const answer = await goToNew({ garment }).catch(() => null);
  if (!answer) said.textContent = OFFLINE;
  else if (answer.status !== 201) said.textContent = sentenceOf(await answer.json());
}
