/** The settings: those of the reader, kept in this browser, and those of the document, changed as one step. */

import { evaluated, length, number, parsed, problemOf, unit, UNITS } from "../board/units.js";
import { openDialog } from "../dialogs/dialog.js";
import { byId, element, field, toldAloud } from "../dom.js";
import { language, LANGUAGES, ownName, speak } from "../language/language.js";
import { shortest } from "../language/numeral.js";
import { inEnglish, say } from "../language/say.js";
import { effort, EFFORTS, keepEffort } from "./effort.js";

/** @import { Drawing, Scene } from "pleat" */

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
  const said = toldAloud("dialog-problem", "alert");
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

/** Units in SI units, except that of lengths, which the reader chooses. @type {Record<string, number>} */
const FACTORS = { "deg/s": Math.PI / 180, mm: 0.001 };

/**
 * A number that can be changed; within its limits, in SI units.
 * @typedef {object} Wanted
 * @property {string} group
 * @property {string} name
 * @property {"length"|"mm"|"s"|"m/s"|"deg/s"|""} unit
 * @property {[number, number]} limits
 * @property {(drawing: Drawing) => number} get
 * @property {(drawing: Drawing, value: number) => void} put
 */

/** Numbers of the scene by themselves. @typedef {"friction"|"arm_motion_s"|"base_speed_m_s"|"base_turn_rad_s"} Single */

/**
 * @param {string} group @param {string} name @param {Wanted["unit"]} unit @param {[number, number]} limits @param {Single} field
 * @returns {Wanted}
 */
const single = (group, name, unit, limits, field) => ({
  group,
  name,
  unit,
  limits,
  get: ({ scene }) => scene[field],
  put: ({ scene }, value) => void (scene[field] = value),
});

/** @param {string} name @param {keyof Scene["table"]} side @param {[number, number]} limits @returns {Wanted} */
const ofTable = (name, side, limits) => ({
  group: say("settings.table"),
  name,
  unit: "length",
  limits,
  get: ({ scene }) => scene.table[side],
  put: ({ scene }, value) => {
    scene.stations = besides(scene, { ...scene.table, [side]: value });
    scene.table = { ...scene.table, [side]: value };
  },
});

/** @type {Wanted[]} */
const WANTED = [
  {
    group: say("settings.hold"),
    name: say("settings.comfort"),
    unit: "length",
    limits: [0, 0.1],
    get: ({ comfort_radius_m: comfort }) => comfort,
    put: (drawing, value) => void (drawing.comfort_radius_m = value),
  },
  single(say("settings.hold"), say("settings.friction"), "", [0, 10], "friction"),
  {
    group: say("settings.cloth"),
    name: say("settings.thickness"),
    unit: "mm",
    limits: [0.0001, 0.02],
    get: ({ thickness_m: thickness }) => thickness,
    put: (drawing, value) => void (drawing.thickness_m = value),
  },
  ofTable(say("settings.depth"), "depth_m", [0.2, 5]),
  ofTable(say("settings.width"), "width_m", [0.2, 5]),
  ofTable(say("settings.height"), "height_m", [0.2, 2]),
  single(say("settings.speeds"), say("settings.base_speed"), "m/s", [0.001, 1000], "base_speed_m_s"),
  single(say("settings.speeds"), say("settings.base_turn"), "deg/s", [0.001, 1000], "base_turn_rad_s"),
  single(say("settings.speeds"), say("settings.arm_motion"), "s", [0.001, 1000], "arm_motion_s"),
];

/** The stations as far from the edges of another table as they are from this one's. @param {Scene} scene @param {Scene["table"]} to */
function besides({ stations, table }, to) {
  /** @param {number} at @param {number} now @param {number} then */
  const kept = (at, now, then) => (Math.abs(at) > now / 2 ? at + (Math.sign(at) * (then - now)) / 2 : at);
  return Object.fromEntries(
    Object.entries(stations).map(([name, pose]) => {
      const x_m = kept(pose.x_m, table.depth_m, to.depth_m);
      return [name, { ...pose, x_m, y_m: kept(pose.y_m, table.width_m, to.width_m) }];
    }),
  );
}

/** @typedef {ReturnType<typeof fieldOf>} Field */

/** @param {Drawing} drawing */
const fieldsOf = (drawing) => WANTED.map((wanted) => fieldOf(wanted, wanted.get(drawing)));

/** What has been written, into a drawing; the rest stays as it is to the last digit. @param {Drawing} drawing @param {Field[]} fields */
function withValues(drawing, fields) {
  for (const { isWritten, put, value } of fields) if (isWritten()) put(drawing, value() ?? 0);
}

/** @param {Wanted} wanted @param {number} now */
function fieldOf({ group, name, unit: kind, limits: [least, most], put }, now) {
  const factor = FACTORS[kind] ?? 1;
  /** @param {number} si */
  const written = (si) => shortest(Number((si / factor).toPrecision(4)));
  const shown = kind === "length" ? number(now) : written(now);
  const input = field({ value: shown, inputMode: "decimal" });
  const word = kind === "length" ? unit.name : kind === "deg/s" ? "\u00B0/s" : kind;
  const row = element("label", "setting", element("span", "", name), input, element("span", "measure-unit", word));
  const value = () => {
    if (kind === "length") return parsed(input.value);
    const read = evaluated(input.value.trim().replaceAll(",", "."));
    return read === null ? null : read * factor;
  };
  const problem = () => {
    const read = value();
    if (kind === "length" && (read === null || read < least)) return problemOf(input.value, least);
    if (read === null) return say("length.no_number", { text: input.value });
    const shortOf = kind === "length" ? length(least) : `${written(least)} ${word}`.trim();
    const beyond = kind === "length" ? length(most) : `${written(most)} ${word}`.trim();
    if (read < least) return say("length.too_little", { text: input.value, least: shortOf });
    return read > most ? say("length.too_much", { text: input.value, most: beyond }) : "";
  };
  return {
    group,
    row,
    input,
    put,
    value,
    isWritten: () => input.value !== shown,
    problem: () => named(name, problem()),
  };
}

/** @param {string} name @param {string} problem */
const named = (name, problem) => problem && `${name}: ${problem}`;
