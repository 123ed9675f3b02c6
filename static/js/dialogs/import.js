/** `Import`: a garment file, a plan file, an SVG, a DXF, a picture or a robot, chosen or dropped on the page. */

import { boxOf } from "../board/geometry.js";
import { length, parsed, problemOf, unit } from "../board/units.js";
import { button, element, field, input, toldAloud } from "../dom.js";
import { titleOf } from "../gallery/tile.js";
import { inEnglish, say, translated } from "../language/say.js";
import { inWords } from "../messages/in_words.js";
import { length as shortLength } from "../messages/lengths.js";
import { OFFLINE, openDialog, sentenceOf } from "./dialog.js";
import { goToNew } from "./documents.js";
import { picture } from "./picture.js";
import { takeRobot } from "./take_robot.js";
import { isViewOnly } from "../view_only.js";

/** @import { Told } from "../messages/in_words.js" */
/** @import { Store } from "../store.js" */
/** @import { Garment, Imported, Template } from "pleat" */

/** Files that draw arcs, which stay curves on the board. */
const DRAWINGS = new Set(["svg", "dxf"]);
const KINDS = ".json,.fold,.svg,.dxf,.png,.jpg,.jpeg,.zip,.urdf,.xml";
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
  if (isViewOnly) return;
  /** @param {DragEvent} event */
  const hasFiles = (event) => [...(event.dataTransfer?.items ?? [])].some(({ kind }) => kind === "file");
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
  const chosen = input("", { type: "file", accept: KINDS, ariaLabel: say("import.file") });
  chosen.addEventListener("change", () => chosen.files?.[0] && read(store, body, chosen.files[0], {}));
  const said = toldAloud("dialog-problem", "alert");
  said.textContent = problem;
  body.replaceChildren(
    element(
      "label",
      "drop",
      element("strong", "", say("import.choose")),
      element("span", "", say("import.drop")),
      chosen,
    ),
    element("p", "dialog-text", say("import.about")),
    said,
  );
}

/**
 * What is to be said beside the file to read it; without it the file says so itself.
 * @typedef {{units?: string, scale?: number, creases?: Creases, measured?: string, like?: string, line?: "seam"|"cut", size?: string, piece?: string}} How
 */

/** @param {Store} store @param {HTMLElement} body @param {File} file @param {How} how */
async function read(store, body, file, how) {
  body.replaceChildren(element("p", "dialog-text", say("import.reading", { name: file.name })));
  if (/\.(zip|urdf|xacro|xml)$/i.test(file.name)) {
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
 * @returns {Asked}
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
function found(store, body, file, how, { format, garment, notes, says, creases, sizes, seen, allowance, graded, pieces }) {
  const said = element("p", "dialog-problem");
  const arcs = DRAWINGS.has(format);
  const proposes = Boolean(seen) && !garment.folds.length; // of a photo the folds are what is missing
  const here = button("plain-button", () => open(store, body, file, garment, arcs, proposes), say("import.open_here"));
  const anew = button("plain-button", () => create(garment, arcs, said, proposes), say("import.open_new"));
  const [second, first] = store.state?.drawing.outline.length ? [here, anew] : [anew, here];
  first.className = "main-button";
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
    ...(pieces ? [whichPiece(pieces, (piece) => read(store, body, file, { ...how, piece }))] : []),
    ...(graded ? [whichSize(graded, (size) => read(store, body, file, { ...how, size }))] : []),
    ...replaces(store),
    said,
    element("div", "dialog-buttons", ...verbs, second, first),
  );
  first.focus();
}

/** What would be gone from this document, where anything is drawn in it. @param {Store} store */
function replaces({ state }) {
  if (!state?.drawing.outline.length) return [];
  const { title, name } = state.drawing;
  return [element("p", "dialog-text", say("import.replaces", { title: titleOf({ title, name }) }))];
}

/**
 * @param {Store} store
 * @param {HTMLElement} body
 * @param {File} file
 * @param {Garment} garment
 * @param {boolean} arcs
 * @param {boolean} proposes whether ways to fold it are shown at once
 */
async function open(store, body, file, garment, arcs, proposes) {
  const state = await store.open(garment, inEnglish("step.import", { name: file.name }), arcs);
  if (!state) return;
  body.closest("dialog")?.close();
  if (proposes) store.tell("propose");
}

/** @param {Garment} garment @param {boolean} arcs @param {HTMLElement} said @param {boolean} proposes */
async function create(garment, arcs, said, proposes) {
  const answer = await goToNew({ garment, arcs }, proposes ? "propose" : "").catch(() => null);
  if (!answer) said.textContent = OFFLINE;
  else if (answer.status !== 201) said.textContent = sentenceOf(await answer.json());
}

/**
 * The choice `It is like` for a garment read from a picture: the measures of a template are fitted to the outline, and
 * its folds come along.
 * @param {string|undefined} like the template that was chosen
 * @param {(like: string|undefined) => void} onChoice
 */
function likeness(like, onChoice) {
  const select = /** @type {HTMLSelectElement} */ (element("select", ""));
  select.append(new Option(say("likeness.nothing"), ""));
  select.addEventListener("change", () => onChoice(select.value || undefined));
  fetch("../api/templates")
    .then((answer) => (answer.ok ? answer.json() : []))
    .then((/** @type {Template[]} */ templates) => {
      select.append(...templates.map(({ name, title }) => new Option(translated(title), name)));
      select.value = like ?? "";
    })
    .catch(() => {});
  return element("label", "likeness", say("likeness.label"), select);
}

const UNITS = ["mm", "cm", "m", "in", "pt", "px"];
/** No garment is shorter or longer (m). */
const [LEAST_M, MOST_M] = [0.01, 10];

/**
 * What an import asks a question about.
 * @typedef {object} Asked
 * @property {HTMLElement} body where it is shown
 * @property {string} filename
 * @property {How} how the file was read
 * @property {string} why it is asked
 * @property {(how: How) => void} read reads the file again
 */

/** How large the garment is: by one of the units, or by its width. @param {Asked} asked @param {Sizes} sizes */
function askSize({ body, filename, how, why, read }, sizes) {
  /** @param {[number, number]} sides */
  const isPossible = (sides) => Math.min(...sides) > 0 && Math.max(...sides) >= LEAST_M && Math.max(...sides) <= MOST_M;
  const choices = UNITS.filter((name) => sizes[name] && isPossible(sizes[name])).map((name) => {
    const [wide, tall] = sizes[name].map((metres) => length(metres));
    return button(
      "plain-button",
      () => read({ ...how, units: name, scale: how.scale ?? 1 }),
      say("import.size", { name, wide, tall }),
    );
  });
  const { form, said } = lengthForm(say("import.its_width"), say("import.use_width"), (width_m) =>
    read({ ...how, ...scaledTo(width_m, sizes, how.scale ?? 1) }),
  );
  body.replaceChildren(
    element("p", "dialog-text", `${filename}: ${why}.`),
    element("p", "dialog-text", say("import.how_large")),
    element("div", "unit-choices", ...choices),
    form,
    said,
  );
}

/** How long the garment in a picture is, where nothing in it tells. @param {Asked} asked */
function askLength({ body, filename, how, why, read }) {
  const { form, said } = lengthForm(say("import.end_to_end"), say("import.use_length"), (length_m) =>
    read({ ...how, measured: `${length_m.toFixed(6)}m:longest` }),
  );
  body.replaceChildren(
    element("p", "dialog-text", `${filename}: ${why}.`),
    element("p", "dialog-text", say("import.how_long")),
    form,
    said,
  );
}

/**
 * A field for a length, and what is wrong with it.
 * @param {string} name
 * @param {string} verb
 * @param {(metres: number) => void} onLength
 */
function lengthForm(name, verb, onLength) {
  const said = toldAloud("dialog-problem", "alert");
  const input = field({});
  const form = /** @type {HTMLFormElement} */ (element("form", "width-form"));
  const label = element("label", "measure", element("span", "measure-name", name), input);
  label.append(element("span", "measure-unit", unit.name));
  form.append(label, element("button", "plain-button", verb));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    said.textContent = problemOf(input.value, LEAST_M);
    if (!said.textContent) onLength(parsed(input.value) ?? 0);
  });
  return { form, said };
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
 * On which cloth the fold lines are drawn, where that matters.
 * @param {Creases} creases
 * @param {(chosen: Creases) => void} onChoice
 */
const onWhichCloth = (creases, onChoice) =>
  choices(
    "creases",
    say("import.lines_drawn_on"),
    { folded: say("import.on_folded"), flat: say("import.on_flat") },
    creases,
    onChoice,
  );

/**
 * Which of two parallel lines the garment ends at.
 * @param {NonNullable<Imported["allowance"]>} allowance
 * @param {(line: "seam"|"cut") => void} onChoice
 */
const whichLine = ({ line, width_m: width }, onChoice) =>
  choices(
    "line",
    say("import.outline_is"),
    { seam: say("import.seam_line"), cut: say("import.cut_line", { width: shortLength(width) }) },
    line,
    onChoice,
  );

/**
 * Which of the sizes of a pattern that is graded.
 * @param {NonNullable<Imported["graded"]>} graded
 * @param {(size: string) => void} onChoice
 */
const whichSize = ({ size, sizes }, onChoice) =>
  choices("size", say("import.size_is"), Object.fromEntries(sizes.map((one) => [one, one])), size, onChoice);

/**
 * Which of the pieces of a pattern.
 * @param {NonNullable<Imported["pieces"]>} pieces
 * @param {(piece: string) => void} onChoice
 */
const whichPiece = ({ piece, pieces }, onChoice) =>
  choices("piece", say("import.piece_is"), Object.fromEntries(pieces.map((one) => [one, one])), piece, onChoice);

/**
 * One of several, as radio buttons.
 * @template {string} T
 * @param {string} name
 * @param {string} legend
 * @param {Record<T, string>} texts
 * @param {T} chosen
 * @param {(value: T) => void} onChoice
 */
function choices(name, legend, texts, chosen, onChoice) {
  const made = /** @type {[T, string][]} */ (Object.entries(texts)).map(([value, text]) => {
    const radio = input("", { type: "radio", name, value, checked: value === chosen });
    radio.addEventListener("change", () => onChoice(value));
    return element("label", "choice", radio, text);
  });
  return element("fieldset", "choices", element("legend", "", legend), ...made);
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
