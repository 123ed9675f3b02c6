/** `New`: a garment from a few measures, seen while they are written, or a blank board. */

import { button, element } from "../dom.js";
import { number, parsed, problemOf, unit } from "../board/units.js";
import { openDialog, OFFLINE, sentenceOf } from "./dialog.js";
import { goToNew } from "./documents.js";
import { picture } from "./picture.js";

const WAIT_MS = 120;

/** Where keys lead in the list of templates. @type {Record<string, (index: number) => number>} */
const STEPS = {
  ArrowLeft: (index) => index - 1,
  ArrowUp: (index) => index - 1,
  ArrowRight: (index) => index + 1,
  ArrowDown: (index) => index + 1,
  Home: () => 0,
  End: () => Infinity,
};

export async function showNew() {
  const list = element("div", "templates");
  const detail = element("div", "template-detail");
  list.setAttribute("role", "listbox");
  list.setAttribute("aria-label", "Templates");
  openDialog("New garment", "is-wide", element("div", "new", list, detail));
  const answer = await fetch("../api/templates").catch(() => null);
  const templates = answer?.ok ? await answer.json() : [];
  const entries = [...templates, null];
  const options = entries.map((template, index) => tile(template, () => choose(index)));
  const choose = (index) => {
    for (const [n, option] of options.entries()) {
      option.setAttribute("aria-selected", String(n === index));
      option.tabIndex = n === index ? 0 : -1;
    }
    detail.replaceChildren(...(entries[index] ? measures(entries[index]) : blank(answer?.ok ? "" : OFFLINE)));
  };
  list.addEventListener("keydown", (event) => {
    const to = STEPS[event.key]?.(options.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement)));
    if (to === undefined) return;
    event.preventDefault();
    const index = Math.max(0, Math.min(to, options.length - 1));
    choose(index);
    options[index].focus();
  });
  list.append(...options);
  choose(0);
  options[0].focus();
}

function tile(template, onClick) {
  const shown = template ? picture(template.outline, template.folds) : picture([], []);
  const made = button("template", onClick, shown, element("span", "", template?.title ?? "Blank board"));
  made.setAttribute("role", "option");
  return made;
}

function blank(problem) {
  const said = element("p", "dialog-problem", problem);
  const go = button("main-button", () => create({}, said, "outline"), "Start drawing");
  return [
    element("h3", "", "Blank board"),
    element("p", "dialog-text", "Draw the outline yourself, corner by corner."),
    said,
    element("div", "dialog-buttons", go),
  ];
}

/** The fields of a template, with the garment that they come to. */
function measures(template) {
  const said = element("p", "dialog-problem");
  said.setAttribute("role", "alert");
  const shown = element("div", "template-picture", picture(template.outline, template.folds));
  const fields = template.measures.map((measure) => field(measure));
  /** @type {any} */
  let garment = null;
  let turn = 0;
  const ask = async () => {
    const mine = (turn += 1);
    garment = null;
    said.textContent = fields.map(({ problem }) => problem()).find(Boolean) ?? "";
    if (said.textContent) return;
    const written = fields.filter(({ isWritten }) => isWritten());
    const made = await garmentOf(template.name, Object.fromEntries(written.map(({ name, value }) => [name, value()])));
    if (mine !== turn) return;
    garment = made.garment ?? null;
    said.textContent = made.problem ?? "";
    if (!garment) return;
    shown.replaceChildren(picture(garment.outline, garment.folds));
    for (const { name, follow } of fields) follow(made.measures[name]);
  };
  let timer;
  const soon = () => {
    clearTimeout(timer);
    timer = setTimeout(ask, WAIT_MS);
  };
  for (const { row } of fields) row.addEventListener("input", soon);
  const form = /** @type {HTMLFormElement} */ (element("form", "template-form"));
  const go = element("button", "main-button", "Create");
  form.append(...fields.map(({ row }) => row), said, element("div", "dialog-buttons", go));
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    clearTimeout(timer);
    await ask();
    if (garment) create({ garment }, said);
  });
  return [
    element("h3", "", template.title),
    element("p", "dialog-text", template.text),
    element("div", "template-columns", shown, form),
  ];
}

/** One measure: what nobody has written keeps its proportion to what somebody has. */
function field({ name, label, text, default_m: first, min_m: least }) {
  const input = /** @type {HTMLInputElement} */ (element("input", "field"));
  input.value = number(first);
  input.autocomplete = "off";
  const row = element(
    "label",
    "measure",
    element("span", "measure-name", label, element("small", "", text)),
    input,
    element("span", "measure-unit", unit.name),
  );
  let shown = input.value;
  const isWritten = () => input.value !== shown;
  const follow = (metres) => {
    if (!isWritten()) input.value = shown = number(metres);
  };
  return { name, row, follow, isWritten, value: () => parsed(input.value), problem: () => problemOf(input.value, least) };
}

async function garmentOf(name, measures) {
  const answer = await fetch(`../api/templates/${name}`, {
    method: "POST",
    headers: { "content-type": "application/json" },
    body: JSON.stringify({ measures }),
  }).catch(() => null);
  if (!answer) return { problem: OFFLINE };
  const told = await answer.json();
  return answer.ok ? told : { problem: sentenceOf(told) };
}

async function create(wanted, said, tool = "") {
  const answer = await goToNew(wanted, tool).catch(() => null);
  if (!answer) said.textContent = OFFLINE;
  else if (answer.status !== 201) said.textContent = sentenceOf(await answer.json());
}
