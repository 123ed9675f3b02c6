/** The settings: those of the reader, kept in this browser, and those of the document, changed as one step. */

import { unit, UNITS } from "../board/units.js";
import { openDialog } from "../dialogs/dialog.js";
import { byId, element } from "../dom.js";
import { LANGUAGES, language, ownName, speak } from "../language/language.js";
import { inEnglish, say } from "../language/say.js";
import { EFFORTS, effort, keepEffort } from "./effort.js";
import { fieldsOf, withValues } from "./scene_fields.js";

/** @typedef {import("../store.js").Store} Store */

/** @param {Store} store */
export function showSettings(store) {
  const own = element("section", "settings-part", element("h3", "", say("settings.yours")), ...readers(store));
  const parts = store.state ? [own, documents(store, store.state.drawing)] : [own];
  const dialog = openDialog(say("settings.title"), "is-settings", ...parts);
  const again = () => {
    dialog.close();
    showSettings(store);
  };
  addEventListener("unit", again, { once: true });
  dialog.addEventListener("close", () => removeEventListener("unit", again));
}

/** What the reader has chosen, done as soon as it is chosen. @param {Store} store */
function readers(store) {
  const languages = choice(
    say("settings.language"),
    LANGUAGES.map((code) => ({ value: code, text: ownName(code) })),
    language,
    (code) => store.settled().then(() => speak(/** @type {typeof language} */ (code))),
  );
  const units = choice(
    say("settings.unit"),
    [
      { value: "cm", text: say("settings.centimetres") },
      { value: "in", text: say("settings.inches") },
      { value: "mm", text: say("settings.millimetres") },
    ],
    unit.name,
    (name) => (unit.name = UNITS.find((other) => other === name) ?? unit.name),
  );
  const colours = choice(
    say("settings.colours"),
    /** @type {const} */ (["light", "dark"]).map((name) => ({ value: name, text: say(`theme.${name}`) })),
    document.documentElement.dataset.theme ?? "light",
    () => byId("theme").click(),
  );
  const efforts = choice(
    say("settings.effort"),
    EFFORTS.map((name) => ({ value: name, text: say(`effort.${name}`) })),
    effort(),
    (name) => keepEffort(store, /** @type {typeof EFFORTS[number]} */ (name)),
  );
  return [languages, units, colours, efforts, element("p", "dialog-text", say("settings.effort_hint"))];
}

/**
 * A label with a list to choose from.
 * @param {string} name
 * @param {{value: string, text: string}[]} options
 * @param {string} chosen
 * @param {(value: string) => void} onChoice
 */
function choice(name, options, chosen, onChoice) {
  const select = /** @type {HTMLSelectElement} */ (element("select", "field"));
  select.append(...options.map(({ value, text }) => new Option(text, value)));
  select.value = chosen;
  select.addEventListener("change", () => onChoice(select.value));
  return element("label", "setting", element("span", "", name), select);
}

/** The document's numbers, changed together. @param {Store} store @param {import("pleat").Drawing} drawing */
function documents(store, drawing) {
  const said = element("p", "dialog-problem");
  said.setAttribute("role", "alert");
  const fields = fieldsOf(drawing);
  const groups = [...new Set(fields.map(({ group }) => group))].map((group) => {
    const rows = fields.filter((field) => field.group === group).map(({ row }) => row);
    return element("fieldset", "settings-group", element("legend", "", group), ...rows);
  });
  const go = element("button", "main-button", say("settings.apply"));
  const form = /** @type {HTMLFormElement} */ (
    element("form", "settings-part", element("h3", "", say("settings.document")), ...groups, said)
  );
  form.append(element("div", "dialog-buttons", go));
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const wrong = fields.find(({ problem }) => problem());
    said.textContent = wrong?.problem() ?? "";
    if (wrong) return wrong.input.focus();
    if (!fields.some(({ isWritten }) => isWritten())) return form.closest("dialog")?.close();
    /** @param {Event} event */
    const refused = (event) => (said.textContent = /** @type {CustomEvent} */ (event).detail);
    store.addEventListener("refused", refused);
    const state = await store.edit(inEnglish("step.settings"), (changed) => withValues(changed, fields));
    store.removeEventListener("refused", refused);
    if (state) form.closest("dialog")?.close();
  });
  return form;
}
