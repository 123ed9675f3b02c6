/** Puts the board and its rail on the page. */

import { byId } from "../dom.js";
import { FOLD_KINDS, KIND_NAMES } from "../fold_kinds.js";
import { Blank } from "./blank.js";
import { Board } from "./board.js";
import { Rail } from "./rail.js";

/** @import { ToolName } from "./tools/tool.js" */

/**
 * @param {import("../store.js").Store} store
 * @param {{togglePlay: () => void, startNew: () => void, startImport: () => void}} verbs
 */
export function mountBoard(store, verbs) {
  const board = new Board(store, byId("board"), verbs.togglePlay);
  board.rail = new Rail(board, byId("rail"));
  board.blank = new Blank(board, verbs);
  takeUp(board, location.hash.slice(1));
  return board;
}

/**
 * Take up the tool that the address names, as soon as the document is there; later it is the reader's choice.
 * @param {Board} board
 * @param {string} name
 */
function takeUp(board, name) {
  if (!isTool(board, name)) return;
  history.replaceState(null, "", location.pathname);
  board.store.addEventListener("document", () => board.choose(name), { once: true });
}

/** @param {Board} board @param {string} name @returns {name is ToolName} */
const isTool = (board, name) => Object.hasOwn(board.tools, name);

/** The board's own keys, by letter. @param {Board} board */
export function boardKeys(board) {
  return {
    v: () => board.choose("select"),
    p: () => board.choose("outline"),
    f: () => board.choose("fold"),
    m: () => board.choose("place"),
    a: () => board.store.tell("propose"),
    t: () => board.choose("measure"),
    i: () => board.choose("photo"),
    s: () => board.store.isLost || board.mirroring.mirror(),
    n: () => board.toggleSnap(),
    ...Object.fromEntries(KIND_NAMES.map((kind) => [FOLD_KINDS[kind].key, () => board.paint.put(kind)])),
    x: () => board.paint.flip(),
    g: () => board.paint.grab(),
    escape: () => board.escape(),
    0: () => board.framing.fit(),
    "[": () => board.store.showStep(board.store.step - 1),
    "]": () => board.store.showStep(board.store.step + 1),
  };
}
