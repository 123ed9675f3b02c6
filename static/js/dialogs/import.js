/** `Import`: a garment file, a plan file, an SVG, a DXF, a picture or a robot, chosen or dropped on the page. */

import { button, element } from "../dom.js";
import { titleOf } from "../gallery/tile.js";
import { inEnglish, say } from "../language/say.js";
import { openDialog, OFFLINE, sentenceOf } from "./dialog.js";
import { inWords } from "../messages/in_words.js";
import { goToNew } from "./documents.js";
import { askLength, askSize } from "./import_size.js";
import { counted, note, onWhichCloth, sizeOf, whichLine, whichSize } from "./import_told.js";
import { likeness } from "./likeness.js";
import { picture } from "./picture.js";
import { takeRobot } from "./take_robot.js";

/** @import { Garment, Imported } from "pleat" */
/** @import { Store } from "../store.js" */

/** Files that draw arcs, which stay curves on the board. */
const DRAWINGS = new Set(["svg", "dxf"]);
const KINDS = ".json,.svg,.dxf,.png,.jpg,.jpeg,.zip";
/** @typedef {NonNullable<Imported["creases"]>} Creases */
/** @typedef {NonNullable<Imported["sizes"]>} Sizes by unit, how wide and how high (m) */

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
 * @typedef {{units?: string, scale?: number, creases?: Creases, measured?: string, like?: string, line?: "seam"|"cut", size?: string}} How
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
  else if (told?.errors?.[0]?.field === "measured") askLength(asked(store, body, file, how, inWords(told.errors[0], [])));
  else if (told?.sizes) askSize(asked(store, body, file, how, inWords(told.errors[0], [])), told.sizes);
  else ask(store, body, told ? `${file.name}: ${sentenceOf(told)}` : OFFLINE);
}

/**
 * A question about a file.
 * @param {Store} store
 * @param {HTMLElement} body
 * @param {File} file
 * @param {How} how
 * @param {string} why
 * @returns {import("./import_size.js").Asked}
 */
const asked = (store, body, file, how, why) => ({
  body,
  filename: file.name,
  how,
  why,
  read: (size) => read(store, body, file, size),
});

/**
 * Show what was read.
 * @param {Store} store
 * @param {HTMLElement} body
 * @param {File} file
 * @param {How} how
 * @param {Imported} imported
 */
function found(store, body, file, how, { format, garment, notes, says, creases, sizes, seen, allowance, graded }) {
  const said = element("p", "dialog-problem");
  const arcs = DRAWINGS.has(format);
  const here = button("main-button", () => open(store, body, file, garment, arcs), say("import.open_here"));
  const anew = button("plain-button", () => create(garment, arcs, said), say("import.open_new"));
  /** @param {Sizes} known */
  const other = (known) =>
    askSize(asked(store, body, file, how, say("import.garment_is", { size: sizeOf(garment) })), known);
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
    ...(allowance ? [whichLine(allowance, (line) => read(store, body, file, { ...how, line }))] : []),
    ...(graded ? [whichSize(graded, (size) => read(store, body, file, { ...how, size }))] : []),
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

/** @param {Store} store @param {HTMLElement} body @param {File} file @param {Garment} garment @param {boolean} arcs */
async function open(store, body, file, garment, arcs) {
  const state = await store.open(garment, inEnglish("step.import", { name: file.name }), arcs);
  if (state) body.closest("dialog")?.close();
}

/** @param {Garment} garment @param {boolean} arcs @param {HTMLElement} said */
async function create(garment, arcs, said) {
  const answer = await goToNew({ garment, arcs }).catch(() => null);
  if (!answer) said.textContent = OFFLINE;
  else if (answer.status !== 201) said.textContent = sentenceOf(await answer.json());
}
