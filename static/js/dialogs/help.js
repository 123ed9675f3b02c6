/** The keys and gestures, on one page; those of fingers first where there are fingers. */

import { element } from "../dom.js";
import { FOLD_KINDS, KIND_NAMES } from "../fold_kinds.js";
import { say } from "../language/say.js";
import { isViewOnly } from "../view_only.js";
import { openDialog } from "./dialog.js";

/** @import { FoldKind } from "pleat" */

/** Titles, with keys and what they do. @typedef {[string, [string, string][]]} Section */

/** @type {Section[]} */
const TOUCH = [
  [
    say("help.section.touch"),
    [
      [say("key.tap"), say("help.tap")],
      [say("key.drag"), say("help.touch_drag")],
      [say("key.two_fingers"), say("help.two_fingers")],
      [say("key.double_tap"), say("help.new_corner")],
      [say("help.edge_middle"), say("help.touch_bend")],
      [say("help.small_picture"), say("help.swap")],
      [say("help.lower_grip"), say("help.pull_up")],
    ],
  ],
];
/** @param {FoldKind} kind @returns {[string, string]} the key of a kind of fold, and what it moves */
function helpOf(kind) {
  return [FOLD_KINDS[kind].key.toUpperCase(), say(`colour.${kind}.moves`)];
}

/** @type {Section[]} */
const SECTIONS = [
  [
    say("help.section.tools"),
    [
      ["V", say("tool.select")],
      ["P", say("tool.outline")],
      ["F", say("tool.fold")],
      ["M", say("help.place_on_table")],
      ["A", say("proposal.do")],
      ["T", say("tool.measure")],
      ["I", say("help.photo")],
      ["S", say("rail.mirror")],
      ["N", say("help.snap")],
    ],
  ],
  [
    say("help.section.drawing"),
    [
      [say("key.click"), say("help.click")],
      [say("key.drag"), say("help.drag")],
      ["G", say("help.grab")],
      [say("help.edge_to_edge"), say("help.edge_onto_edge")],
      [say("help.lengths"), say("help.exact_length")],
      [say("key.shift"), say("help.steps_of_15")],
      [say("key.ctrl"), say("help.no_snapping")],
      [say("key.backspace"), say("help.take_back")],
      [say("key.esc"), say("help.drop")],
    ],
  ],
  [
    say("help.section.folds"),
    [
      ...KIND_NAMES.map(helpOf),
      ["X", say("help.flip")],
      [say("key.delete"), say("help.remove")],
      ["C", say("help.bend")],
      [say("key.arrows"), say("help.nudge")],
      [say("key.double_click"), say("help.new_corner")],
      [say("key.tab"), say("help.number")],
      ["[  ]", say("help.moment")],
    ],
  ],
  [
    say("help.section.keyboard"),
    [
      [say("key.arrows"), say("help.cross")],
      [say("key.enter"), say("help.set_point")],
      [say("key.alt_enter"), say("help.grab_there")],
      [say("key.tab"), say("help.from_to")],
      [",  .", say("help.turn")],
    ],
  ],
  [
    say("help.section.plan"),
    [
      ["H", say("help.cards")],
      [say("key.click"), say("help.go_to_step")],
      [say("key.right_click"), say("help.plan_from")],
    ],
  ],
  [
    say("help.section.view"),
    [
      ["/", say("help.gallery")],
      [say("key.wheel"), say("help.zoom")],
      [say("key.space_drag"), say("help.pan")],
      ["0", say("help.fit")],
      [say("key.space"), say("help.play")],
    ],
  ],
  [
    say("help.section.document"),
    [
      [say("key.undo"), say("history.undo")],
      [say("key.redo"), say("help.redo")],
      [say("key.save"), say("help.save")],
      [say("key.settings"), say("help.settings")],
      ["?", say("help.this_page")],
    ],
  ],
];

/** What is done by those who came by a link for looking. */
const LOOKING = new Set([
  say("help.two_fingers"),
  say("help.swap"),
  say("help.pull_up"),
  say("help.go_to_step"),
  say("help.zoom"),
  say("help.pan"),
  say("help.play"),
  say("help.this_page"),
]);

export function showHelp() {
  const isTouched = matchMedia("(pointer: coarse)").matches;
  const ordered = isTouched ? [...TOUCH, ...SECTIONS] : [...SECTIONS, ...TOUCH];
  const shown = ordered.map(([title, keys]) => /** @type {Section} */ ([
    title,
    keys.filter(([, text]) => !isViewOnly || LOOKING.has(text)),
  ]));
  const sections = shown.filter(([, keys]) => keys.length).map(([title, keys]) =>
    element(
      "section",
      "help-section",
      element("h3", "", title),
      element("dl", "keys", ...keys.flatMap(([key, text]) => [element("dt", "", key), element("dd", "", text)])),
    ),
  );
  const link = element("a", "", say("help.rest"));
  link.setAttribute("href", "../docs");
  const [before, after] = say("help.programs", { link: "\0" }).split("\0");
  const about = element("p", "dialog-text", say("help.about"));
  const more = element("p", "dialog-note", before, link, after);
  openDialog(say("help.title"), "is-wide", about, element("div", "help", ...sections), more);
}
