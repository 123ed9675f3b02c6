/** What a job has come to: its numbers by name, what there is several of as a table. The JSON is one link away. */

import { element } from "../dom.js";
import { numeral } from "../language/numeral.js";
import { say } from "../language/say.js";
import { openDialog } from "./dialog.js";
import { fetched } from "./documents.js";

/** @typedef {Record<string, unknown>} Fields */

const DIGITS = 3;
const ROWS_MAX = 100;
/** Names end in their unit. */
const UNIT = /_(s|m|m2|mm|kg|rad|hz)$/;

/** @param {string} title @param {string} path of the job */
export async function showResult(title, path) {
  const { result } = await fetched(path);
  const link = element("a", "", say("jobs.as_json"));
  link.setAttribute("href", path);
  openDialog(title, "is-wide result", shown(result), element("p", "dialog-note", link));
}

/** @param {unknown} value @returns {Node} */
function shown(value) {
  if (Array.isArray(value)) return several(value);
  if (isFields(value)) {
    const entries = Object.entries(value).map(([name, one]) => [
      element("dt", "", named(name)),
      element("dd", "", shown(one)),
    ]);
    return element("dl", "result-fields", ...entries.flat());
  }
  return document.createTextNode(inShort(value));
}

/** Short ones in a row, those with fields as a table. @param {unknown[]} values */
function several(values) {
  if (!values.length || !values.every(isFields)) return document.createTextNode(inShort(values));
  const names = Object.keys(values[0]);
  const head = element("tr", "", ...names.map((name) => element("th", "", named(name))));
  const rows = values
    .slice(0, ROWS_MAX)
    .map((fields) => element("tr", "", ...names.map((name) => element("td", "", inShort(fields[name])))));
  const table = element("table", "result-table", element("thead", "", head), element("tbody", "", ...rows));
  const left = values.length - rows.length;
  const more = element("p", "hint", left ? say("repair.more", { count: left }) : "");
  return element("div", "result-scroll", table, more);
}

/** A value in a cell: of what is long only how much there is. @param {unknown} value @returns {string} */
function inShort(value) {
  if (value === null || value === undefined) return "–";
  if (typeof value === "number") return numeral(value, DIGITS, 0);
  if (typeof value === "boolean") return value ? "✓" : "–";
  if (typeof value === "string") return value;
  if (isFields(value)) return String(value.title ?? Object.values(value).map(inShort).join(", "));
  const values = /** @type {unknown[]} */ (value);
  const isShort = values.length <= 3 && values.every((one) => typeof one !== "object");
  return isShort ? values.map(inShort).join(", ") : say("jobs.entries", { count: values.length });
}

/** @param {unknown} value @returns {value is Fields} */
const isFields = (value) => typeof value === "object" && value !== null && !Array.isArray(value);

/** A field's name, with its unit. @param {string} name */
const named = (name) => name.replace(UNIT, " ($1)").replaceAll("_", " ");
