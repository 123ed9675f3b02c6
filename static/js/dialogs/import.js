/** `Import`: a garment file, an SVG or a DXF, chosen or dropped on the page. */

import { button, element } from "../dom.js";
import { openDialog, OFFLINE, sentenceOf } from "./dialog.js";
import { goToNew } from "./documents.js";
import { picture } from "./picture.js";

const KINDS = ".json,.svg,.dxf";
const UNITS = ["mm", "cm", "m", "in"];

/** @param {import("../store.js").Store} store @param {File|null} first a file that was dropped */
export function showImport(store, first = null) {
  const body = element("div", "import");
  openDialog("Import", "", body);
  if (first) read(store, body, first, null);
  else ask(store, body);
}

/** Take files that are dropped anywhere on the page. @param {import("../store.js").Store} store */
export function acceptDrops(store) {
  const hasFiles = (event) => event.dataTransfer?.types.includes("Files");
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

function ask(store, body, problem = "") {
  const input = /** @type {HTMLInputElement} */ (element("input", ""));
  input.type = "file";
  input.accept = KINDS;
  input.setAttribute("aria-label", "File");
  input.addEventListener("change", () => input.files?.[0] && read(store, body, input.files[0], null));
  const said = element("p", "dialog-problem", problem);
  said.setAttribute("role", "alert");
  body.replaceChildren(
    element(
      "label",
      "drop",
      element("strong", "", "Choose a file"),
      element("span", "", "or drop it anywhere on the page"),
      input,
    ),
    element(
      "p",
      "dialog-text",
      "A garment of Pleat (.json), a drawing (.svg) or a pattern (.dxf). In drawings the closed path is the outline, " +
        "and blue and red lines are folds.",
    ),
    said,
  );
}

async function read(store, body, file, units) {
  body.replaceChildren(element("p", "dialog-text", `Reading ${file.name}...`));
  const query = new URLSearchParams({ filename: file.name, ...(units ? { units } : {}) });
  const answer = await fetch(`/api/imports?${query}`, { method: "POST", body: file }).catch(() => null);
  const told = answer ? await answer.json() : null;
  if (answer?.ok) found(store, body, file, told);
  else if (told?.sizes) askUnits(store, body, file, told.sizes);
  else ask(store, body, told ? `${file.name}: ${sentenceOf(told)}` : OFFLINE);
}

function askUnits(store, body, file, sizes) {
  const choices = UNITS.filter((name) => sizes[name]).map((name) => {
    const [wide, tall] = sizes[name].map((metres) => `${(100 * metres).toPrecision(3)} cm`);
    return button("plain-button", () => read(store, body, file, name), `${name}: ${wide} x ${tall}`);
  });
  body.replaceChildren(
    element("p", "dialog-text", `${file.name} does not say how long a unit is. How large is the garment?`),
    element("div", "unit-choices", ...choices),
  );
}

function found(store, body, file, { garment, notes }) {
  const said = element("p", "dialog-problem");
  const here = button("main-button", () => open(store, body, file, garment), "Open here");
  const anew = button("plain-button", () => create(garment, said), "As a new document");
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
        element("ul", "notes", ...notes.map((note) => element("li", "", note))),
      ),
    ),
    said,
    element("div", "dialog-buttons", anew, here),
  );
  here.focus();
}

const counted = ({ outline, folds }) =>
  `${outline.length} corners, ${folds.length} ${folds.length === 1 ? "fold" : "folds"}`;

async function open(store, body, file, garment) {
  const state = await store.open(garment, `Import ${file.name}`);
  if (state) body.closest("dialog").close();
}

async function create(garment, said) {
  const answer = await goToNew({ garment }).catch(() => null);
  if (!answer) said.textContent = OFFLINE;
  else if (answer.status !== 201) said.textContent = sentenceOf(await answer.json());
}
