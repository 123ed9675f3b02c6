/**
 * The page's words, by what they mean, in the reader's language. They stand in `static/words`, one file for each
 * language; every module of the page waits until they are there.
 *
 * A text has places for values, as in `{count} folds`. One that depends on a number has a form for each kind of it that
 * the language tells apart (`Intl.PluralRules`), chosen by the value `count`.
 */

import { language } from "./language.js";

/** @typedef {typeof import("../../words/en.json")} Catalogue */
/** @typedef {keyof Catalogue} Key */
/** @typedef {string|{one: string, other: string}} Text */

/** @param {string} code @returns {Promise<Catalogue>} */
async function catalogue(code) {
  const answer = await fetch(`../static/words/${code}.json`);
  return answer.json();
}

const english = await catalogue("en");
/** @type {Record<Key, Text>} */
const texts = language === "en" ? english : await catalogue(language);

const plurals = new Intl.PluralRules(language);
const figures = new Intl.NumberFormat(language);

document.documentElement.lang = language;

/**
 * @param {Key} key
 * @param {Record<string, string|number>} [values] of the places in the text; numbers come in the language's digits
 */
export function say(key, values = {}) {
  return filled(texts[key], values);
}

/** @param {Text} text @param {Record<string, string|number>} values */
function filled(text, values) {
  const form = /** @type {"one"|"other"} */ (typeof text === "string" ? "" : plurals.select(Number(values.count)));
  const words = typeof text === "string" ? text : (text[form] ?? text.other);
  return words.replace(/\{(\w+)\}/g, (_, name) => {
    const value = values[name];
    return typeof value === "number" ? figures.format(value) : value;
  });
}

/** Whether there are words of that name. @param {string} key @returns {key is Key} */
export const isSaid = (key) => key in english;

/** Texts that come in English from elsewhere, each by the start of its keys: names that Pleat gives, and steps. */
const GIVEN = ["name.", "step.", "file.", "measure.", "template.", "rule.", "assumption.", "station."];
const given = Object.entries(english).flatMap(([key, text]) =>
  GIVEN.some((start) => key.startsWith(start)) && typeof text === "string" ? [[key, text]] : [],
);
const keys = new Map(given.map(([key, text]) => [text, /** @type {Key} */ (key)]));
const patterns = given.filter(([, text]) => text.includes("{")).map(([key, text]) => ({ key, sample: pattern(text) }));

/** What texts with places look like when these are filled. @param {string} text */
function pattern(text) {
  const plain = text.replace(/[.*+?^$()|[\]\\]/g, "\\$&");
  return new RegExp(`^${plain.replace(/\{(\w+)\}/g, "(?<$1>.+)")}$`);
}

/**
 * A text that Pleat itself has given in English, as a document's step or the name of a shipped garment's fold, in the
 * reader's language; any other text as it is.
 * @param {string} text
 * @returns {string}
 */
export function translated(text) {
  if (language === "en") return text;
  const key = keys.get(text);
  if (key) return say(key);
  const [, name, number] = /^(.+) (\d+)$/.exec(text) ?? []; // the second fold of a name has a number
  if (keys.has(name)) return `${translated(name)} ${number}`;
  for (const { key: name, sample } of patterns) {
    const found = sample.exec(text)?.groups;
    if (found) return say(/** @type {Key} */ (name), mapped(found));
  }
  return text;
}

/** @param {Record<string, string>} values */
const mapped = (values) => Object.fromEntries(Object.entries(values).map(([name, value]) => [name, translated(value)]));

/** The English text, for what is stored and read by others. @param {Key} key @param {Record<string, string>} [values] */
export const inEnglish = (key, values = {}) => filled(english[key], values);

/**
 * Fill in the words of the page's own elements, which name them in `data-say`, `data-say-label` and `data-say-title`.
 * @param {ParentNode} root
 */
export function fillIn(root) {
  for (const found of root.querySelectorAll("[data-say], [data-say-label], [data-say-title]")) {
    const { say: text, sayLabel: label, sayTitle: title } = /** @type {HTMLElement} */ (found).dataset;
    if (text) found.textContent = say(/** @type {Key} */ (text));
    if (label) found.setAttribute("aria-label", say(/** @type {Key} */ (label)));
    if (title) found.setAttribute("title", say(/** @type {Key} */ (title)));
  }
}
