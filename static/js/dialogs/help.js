/** The keys and gestures, on one page; those of fingers first where there are fingers. */

import { element } from "../dom.js";
import { openDialog } from "./dialog.js";

const TOUCH = {
  "With a finger": [
    ["Tap", "Set a corner, select; the first corner again closes"],
    ["Drag", "Pull what is there, or draw with the tool in hand; a loupe shows what is below"],
    ["Two fingers", "Pan and zoom; they drop what one finger has begun"],
    ["Double tap", "New corner on an edge"],
    ["Small picture", "Tap it to swap board and stage; Play is on the large stage too"],
    ["Lower grip", "Pull it up for folds, timeline and plan"],
  ],
};
const SECTIONS = {
  Tools: [
    ["V", "Select"],
    ["P", "Draw outline"],
    ["F", "Draw fold"],
    ["M", "Place on the table"],
    ["T", "Measure"],
    ["I", "Photo under the board"],
    ["S", "Mirror"],
    ["N", "Snapping on or off"],
  ],
  Drawing: [
    ["Click", "Set a corner; the first one again closes"],
    ["Drag", "A fold from edge to edge, or a point of the cloth to where it shall land"],
    ["G", "Grab the cloth also at its edge or corner; Alt for one stroke"],
    ["Edge to edge", "Grab beside an edge, drop on another: edge onto edge"],
    ["30  18in  91.4/2", "Exact length"],
    ["Shift", "Steps of 15\u00B0"],
    ["Ctrl", "No snapping"],
    ["Backspace", "Take the last corner back"],
    ["Esc", "Drop what was begun"],
  ],
  "Folds and selection": [
    ["B  R", "Blue: all layers, red: last flap"],
    ["X", "Flip: the other side moves"],
    ["Delete", "Remove what is selected"],
    ["Arrows", "1 mm, with Shift 1 cm"],
    ["Double-click", "New corner on an edge"],
    ["Tab", "Number at the selection"],
    ["[  ]", "Moment before, after"],
  ],
  "Without a mouse": [
    ["Arrows", "Lead the cross by 1 cm; Shift 10 cm, Alt 1 mm"],
    ["Enter", "Set a point; twice at the same place closes"],
    ["Alt + Enter", "Grab the cloth there"],
    ["Tab", "From corner to corner, from fold to fold"],
    [",  .", "Turn the garment on the table"],
  ],
  Plan: [
    ["H", "Help where there is no plan: to the cards over the board; arrows from one to the next"],
    ["Click", "Go to where a step begins"],
    ["Right-click", "Plan from there; so do a long press, Shift + F10 and the menu key"],
  ],
  View: [
    ["/", "Gallery: all garments, templates, examples"],
    ["Wheel", "Zoom at the cursor"],
    ["Space + drag", "Pan; so does the middle button"],
    ["0", "Show the whole cloth"],
    ["Space", "Play and pause"],
  ],
  Document: [
    ["Ctrl + Z", "Undo"],
    ["Ctrl + Shift + Z", "Redo; so does Ctrl + Y"],
    ["Ctrl + S", "Save the garment as a file"],
    ["?", "This page"],
  ],
};

export function showHelp() {
  const isTouched = matchMedia("(pointer: coarse)").matches;
  const ordered = isTouched ? { ...TOUCH, ...SECTIONS } : { ...SECTIONS, ...TOUCH };
  const sections = Object.entries(ordered).map(([title, keys]) =>
    element(
      "section",
      "help-section",
      element("h3", "", title),
      element("dl", "keys", ...keys.flatMap(([key, text]) => [element("dt", "", key), element("dd", "", text)])),
    ),
  );
  const more = element("p", "dialog-note", "Programs talk to Pleat by ");
  const link = element("a", "", "its REST interface");
  link.setAttribute("href", "../docs");
  more.append(link, ".");
  openDialog("Help", "is-wide", element("div", "help", ...sections), more);
}
