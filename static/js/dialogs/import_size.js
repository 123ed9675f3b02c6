/** The questions of an import about sizes: the unit or the width of a drawing, the length of what is in a picture. */

import { length, parsed, problemOf, unit } from "../board/units.js";
import { button, element } from "../dom.js";
import { say } from "../language/say.js";

/** @import { How, Sizes } from "./import.js" */

const UNITS = ["mm", "cm", "m", "in"];
/** No garment is shorter or longer (m). */
const [LEAST_M, MOST_M] = [0.01, 10];

/**
 * What an import asks a question about.
 * @typedef {object} Asked
 * @property {HTMLElement} body where it is shown
 * @property {string} filename
 * @property {How} how the file was read
 * @property {string} why it is asked
 * @property {(how: How) => void} read reads the file again
 */

/** How large the garment is: by one of the units, or by its width. @param {Asked} asked @param {Sizes} sizes */
export function askSize({ body, filename, how, why, read }, sizes) {
  /** @param {[number, number]} sides */
  const isPossible = (sides) => Math.min(...sides) > 0 && Math.max(...sides) >= LEAST_M && Math.max(...sides) <= MOST_M;
  const choices = UNITS.filter((name) => sizes[name] && isPossible(sizes[name])).map((name) => {
    const [wide, tall] = sizes[name].map((metres) => length(metres));
    return button(
      "plain-button",
      () => read({ ...how, units: name, scale: how.scale ?? 1 }),
      say("import.size", { name, wide, tall }),
    );
  });
  const { form, said } = lengthForm(say("import.its_width"), say("import.use_width"), (width_m) =>
    read({ ...how, ...scaledTo(width_m, sizes, how.scale ?? 1) }),
  );
  body.replaceChildren(
    element("p", "dialog-text", `${filename}: ${why}.`),
    element("p", "dialog-text", say("import.how_large")),
    element("div", "unit-choices", ...choices),
    form,
    said,
  );
}

/** How long the garment in a picture is, where nothing in it tells. @param {Asked} asked */
export function askLength({ body, filename, how, why, read }) {
  const { form, said } = lengthForm(say("import.end_to_end"), say("import.use_length"), (length_m) =>
    read({ ...how, measured: `${length_m.toFixed(6)}m:longest` }),
  );
  body.replaceChildren(
    element("p", "dialog-text", `${filename}: ${why}.`),
    element("p", "dialog-text", say("import.how_long")),
    form,
    said,
  );
}

/**
 * A field for a length, and what is wrong with it.
 * @param {string} name
 * @param {string} verb
 * @param {(metres: number) => void} onLength
 */
function lengthForm(name, verb, onLength) {
  const said = element("p", "dialog-problem");
  said.setAttribute("role", "alert");
  const input = /** @type {HTMLInputElement} */ (element("input", "field"));
  input.autocomplete = "off";
  const form = /** @type {HTMLFormElement} */ (element("form", "width-form"));
  const label = element("label", "measure", element("span", "measure-name", name), input);
  label.append(element("span", "measure-unit", unit.name));
  form.append(label, element("button", "plain-button", verb));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    said.textContent = problemOf(input.value, LEAST_M);
    if (!said.textContent) onLength(parsed(input.value) ?? 0);
  });
  return { form, said };
}

/**
 * The unit and the scale of it that make a garment so wide; the scale that is nearest to 1.
 * @param {number} width_m
 * @param {Sizes} sizes
 * @param {number} scale of the sizes
 * @returns {How}
 */
function scaledTo(width_m, sizes, scale) {
  const ways = UNITS.filter((name) => sizes[name]).map((units) => ({
    units,
    scale: (scale * width_m) / sizes[units][0],
  }));
  return ways.reduce((best, way) => (Math.abs(Math.log(way.scale)) < Math.abs(Math.log(best.scale)) ? way : best));
}
