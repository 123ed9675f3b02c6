/** The language that the page speaks: what the reader chose last, else the first one of the browser's that there is. */

const KEY = "pleat-language";
export const LANGUAGES = /** @type {const} */ (["en", "de", "es"]);

/** @typedef {typeof LANGUAGES[number]} Language */

/** @param {string|null} code as in `de` or `de-AT` */
const spoken = (code) => LANGUAGES.find((one) => one === code?.split("-")[0]);

/** It holds until the page is loaded again. */
export const language =
  spoken(localStorage.getItem(KEY)) ?? navigator.languages.map(spoken).find((one) => one !== undefined) ?? "en";

/** The language of dates and times; English readers have them as their browser does. */
export const times = language === "en" ? undefined : language;

/** Speak another language from now on: the page is loaded again. @param {Language} code */
export function speak(code) {
  localStorage.setItem(KEY, code);
  location.reload();
}

/** What a language calls itself, as in `Deutsch`. @param {Language} code */
export function ownName(code) {
  const name = new Intl.DisplayNames([code], { type: "language" }).of(code) ?? code;
  return name.charAt(0).toLocaleUpperCase(code) + name.slice(1);
}
