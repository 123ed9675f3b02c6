/** Light or dark: as the system has it, until the reader says otherwise. */

import { byId } from "./dom.js";
import { icon } from "./icons.js";
import { say } from "./language/say.js";

const KEY = "pleat-theme";

export class Theme extends EventTarget {
  constructor() {
    super();
    this.system = matchMedia("(prefers-color-scheme: dark)");
    this.button = byId("theme");
    this.button.addEventListener("click", () => this.choose(!this.isDark));
    this.system.addEventListener("change", () => this.apply());
    this.apply();
  }

  get isDark() {
    const chosen = localStorage.getItem(KEY);
    return chosen ? chosen === "dark" : this.system.matches;
  }

  /** @param {boolean} isDark */
  choose(isDark) {
    localStorage.setItem(KEY, isDark ? "dark" : "light");
    this.apply();
  }

  apply() {
    const other = this.isDark ? "light" : "dark";
    document.documentElement.dataset.theme = this.isDark ? "dark" : "light";
    this.button.replaceChildren(icon(this.isDark ? "sun" : "moon"));
    this.button.setAttribute("aria-label", say(`theme.${other}`));
    this.button.title = say(`theme.${other}_hint`);
    this.dispatchEvent(new Event("change"));
  }
}
