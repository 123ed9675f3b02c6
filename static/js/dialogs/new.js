/** `New`: a garment from a few measures, seen while they are written, or a blank board. */

import { button, element, field, toldAloud } from "../dom.js";
import { number, parsed, problemOf, unit } from "../board/units.js";
import { say, translated } from "../language/say.js";
import { openDialog, OFFLINE, sentenceOf } from "./dialog.js";
import { goToNew } from "./documents.js";
import { picture } from "./picture.js";

/** @import { Garment, Made, Measure, Template } from "pleat" */

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

/** @param {string} name of the template that is chosen first; the first of all if there is none of it */
export async function showNew(name = "") {
  const list = element("div", "templates");
  const detail = element("div", "template-detail");
  list.setAttribute("role", "listbox");
  list.setAttribute("aria-label", say("new.templates"));
  openDialog(say("new.title"), "is-wide", element("div", "new", list, detail));
  const answer = await fetch("../api/templates").catch(() => null);
  /** @type {Template[]} */
  const templates = answer?.ok ? await answer.json() : [];
  /** @type {(Template|null)[]} of which null is the blank board */
  const entries = [...templates, null];
  const options = entries.map((template, index) => tile(template, () => choose(index)));
  /** @param {number} index */
  const choose = (index) => {
    for (const [n, option] of options.entries()) {
      option.setAttribute("aria-selected", String(n === index));
      option.tabIndex = n === index ? 0 : -1;
    }
    const template = entries[index];
    detail.replaceChildren(...(template ? measures(template) : blank(answer?.ok ? "" : OFFLINE)));
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
  const first = Math.max(
    templates.findIndex((template) => template.name === name),
    0,
  );
  choose(first);
  options[first].focus();
}

/** @param {Template|null} template @param {() => void} onClick */
function tile(template, onClick) {
  const shown = template ? picture(template.outline, template.folds) : picture([], []);
  const made = button(
    "template",
    onClick,
    shown,
    element("span", "", template ? translated(template.title) : say("new.blank")),
  );
  made.setAttribute("role", "option");
  return made;
}

/** @param {string} problem */
function blank(problem) {
  const said = element("p", "dialog-problem", problem);
  const go = button("main-button", () => create({}, said, "outline"), say("new.start"));
  return [
    element("h3", "", say("new.blank")),
    element("p", "dialog-text", say("new.blank_text")),
    said,
    element("div", "dialog-buttons", go),
  ];
}

/** The fields of a template, with the garment that they come to. @param {Template} template */
function measures(template) {
  const said = toldAloud("dialog-problem", "alert");
  const shown = element("div", "template-picture", picture(template.outline, template.folds));
  const fields = template.measures.map(measureField);
  /** @type {Garment|null} */
  let garment = null;
  let turn = 0;
  const ask = async () => {
    const mine = (turn += 1);
    garment = null;
    said.textContent = fields.map(({ problem }) => problem()).find(Boolean) ?? "";
    if (said.textContent) return;
    const written = fields.filter(({ isWritten }) => isWritten());
    const values = Object.fromEntries(written.map(({ name, value }) => [name, value() ?? 0]));
    const made = await garmentOf(template.name, values);
    if (mine !== turn) return;
    if (typeof made === "string") {
      said.textContent = made;
      return;
    }
    garment = made.garment;
    shown.replaceChildren(picture(garment.outline, garment.folds));
    for (const { name, follow } of fields) follow(made.measures[name]);
  };
  let timer = 0;
  const soon = () => {
    clearTimeout(timer);
    timer = setTimeout(ask, WAIT_MS);
  };
  for (const { row } of fields) row.addEventListener("input", soon);
  const form = /** @type {HTMLFormElement} */ (element("form", "template-form"));
  const go = element("button", "main-button", say("new.create"));
  form.append(...fields.map(({ row }) => row), said, element("div", "dialog-buttons", go));
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    clearTimeout(timer);
    await ask();
    if (garment) create({ garment }, said);
  });
  return [
    element("h3", "", translated(template.title)),
    element("p", "dialog-text", translated(template.text)),
    element("div", "template-columns", shown, form),
  ];
}

/** One measure: what nobody has written keeps its proportion to what somebody has. @param {Measure} measure */
function measureField({ name, label, text, default_m: first, min_m: least }) {
  const input = field({ value: number(first) });
  const row = element(
    "label",
    "measure",
    element("span", "measure-name", translated(label), element("small", "", translated(text))),
    input,
    element("span", "measure-unit", unit.name),
  );
  let shown = input.value;
  const isWritten = () => input.value !== shown;
  /** @param {number} metres */
  const follow = (metres) => {
    if (!isWritten()) input.value = shown = number(metres);
  };
  return {
    name,
    row,
    follow,
    isWritten,
    value: () => parsed(input.value),
    problem: () => problemOf(input.value, least),
  };
}

/**
 * What a template makes of measures, or why it makes nothing.
 * @param {string} name the template's
 * @param {Record<string, number>} measures
 * @returns {Promise<Made|string>}
 */
async function garmentOf(name, measures) {
  const answer = await fetch(`../api/templates/${name}`, {
    method: "POST",
    headers: { "content-type": "application/json" },
    body: JSON.stringify({ measures }),
  }).catch(() => null);
  if (!answer) return OFFLINE;
  const told = await answer.json();
  return answer.ok ? told : sentenceOf(told);
}

/** @param {{garment?: Garment}} wanted @param {HTMLElement} said @param {string} tool */
async function create(wanted, said, tool = "") {
  const answer = await goToNew(wanted, tool).catch(() => null);
  if (!answer) said.textContent = OFFLINE;
  else if (answer.status !== 201) said.textContent = sentenceOf(await answer.json());
}
