/** The combobox `Garment`: what is drawn, and what could be opened in its place. */

import { byId } from "./dom.js";

/** @param {import("./store.js").Store} store */
export function mountGarments(store) {
  const select = /** @type {HTMLSelectElement} */ (byId("garment"));
  /** @type {{name: string, title: string}[]} */
  let entries = [];

  const show = () => {
    if (!store.state) return;
    const { name, title } = store.state.drawing;
    const own = { name, title: title || name };
    const isKnown = entries.some((entry) => entry.name === name);
    const shown = isKnown ? entries.map((entry) => (entry.name === name ? own : entry)) : [own, ...entries];
    select.replaceChildren(...shown.map((entry) => new Option(entry.title, entry.name)));
    select.value = name;
  };
  const load = async () => {
    const answer = await fetch("../api/garments").catch(() => null);
    if (!answer?.ok) return;
    entries = await answer.json();
    show();
  };

  select.addEventListener("change", () => store.open(select.value));
  store.addEventListener("document", show);
  store.addEventListener("refused", show);
  store.addEventListener("connection", () => store.isLive && load());
}
