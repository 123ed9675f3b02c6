/** What an import says of the garment that it has read, and on which cloth its lines are drawn. */

import { boxOf } from "../board/geometry.js";
import { length } from "../board/units.js";
import { element } from "../dom.js";
import { say } from "../language/say.js";
import { inWords } from "../messages/in_words.js";
import { length as shortLength } from "../messages/lengths.js";

/** @import { Garment, Imported } from "pleat" */
/** @import { Told } from "../messages/in_words.js" */
/** @import { Creases } from "./import.js" */

/**
 * On which cloth the fold lines are drawn, where that matters.
 * @param {Creases} creases
 * @param {(chosen: Creases) => void} onChoice
 */
export const onWhichCloth = (creases, onChoice) =>
  choices(
    "creases",
    say("import.lines_drawn_on"),
    { folded: say("import.on_folded"), flat: say("import.on_flat") },
    creases,
    onChoice,
  );

/**
 * Which of two parallel lines the garment ends at.
 * @param {NonNullable<Imported["allowance"]>} allowance
 * @param {(line: "seam"|"cut") => void} onChoice
 */
export const whichLine = ({ line, width_m: width }, onChoice) =>
  choices(
    "line",
    say("import.outline_is"),
    { seam: say("import.seam_line"), cut: say("import.cut_line", { width: shortLength(width) }) },
    line,
    onChoice,
  );

/**
 * Which of the sizes of a pattern that is graded.
 * @param {NonNullable<Imported["graded"]>} graded
 * @param {(size: string) => void} onChoice
 */
export const whichSize = ({ size, sizes }, onChoice) =>
  choices("size", say("import.size_is"), Object.fromEntries(sizes.map((one) => [one, one])), size, onChoice);

/**
 * One of several, as radio buttons.
 * @template {string} T
 * @param {string} name
 * @param {string} legend
 * @param {Record<T, string>} texts
 * @param {T} chosen
 * @param {(value: T) => void} onChoice
 */
function choices(name, legend, texts, chosen, onChoice) {
  const made = /** @type {[T, string][]} */ (Object.entries(texts)).map(([value, text]) => {
    const input = /** @type {HTMLInputElement} */ (element("input", ""));
    Object.assign(input, { type: "radio", name, value, checked: value === chosen });
    input.addEventListener("change", () => onChoice(value));
    return element("label", "choice", input, text);
  });
  return element("fieldset", "choices", element("legend", "", legend), ...made);
}

/** @param {Garment} garment */
export function sizeOf({ outline }) {
  const box = boxOf(outline);
  return box
    ? say("import.by", { wide: length(box.high[0] - box.low[0]), tall: length(box.high[1] - box.low[1]) })
    : "";
}

/** What is to be said of how the garment was read. @param {Told} told @param {{name?: string}[]} folds */
export function note(told, folds) {
  const text = inWords(told, folds);
  return element("li", "", text[0].toUpperCase() + text.slice(1) + (text.endsWith(".") ? "" : "."));
}

/** @param {Garment} garment */
export const counted = ({ outline, folds }) =>
  `${say("import.corners", { count: outline.length })}, ${say("import.folds", { count: folds.length })}`;
