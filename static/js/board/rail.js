/** The tools, at the board's left side or along a phone's lower edge. */

import { button, element } from "../dom.js";
import { icon } from "../icons.js";
import { say } from "../language/say.js";

/** @import { ToolName } from "./tools/tool.js" */

/** Name, label, key. @type {[Exclude<ToolName, "propose">, string, string][]} */
const TOOLS = [
  ["select", say("tool.select"), "V"],
  ["outline", say("tool.outline"), "P"],
  ["fold", say("tool.fold"), "F"],
  ["place", say("tool.place"), "M"],
  ["measure", say("tool.measure"), "T"],
  ["photo", say("tool.photo"), "I"],
];

export class Rail {
  /** @param {import("./board.js").Board} board @param {HTMLElement} root */
  constructor(board, root) {
    this.board = board;
    /** @type {Map<string, HTMLButtonElement>} */
    this.tools = new Map();
    for (const [name, label, key] of TOOLS) {
      const made = railButton(name, label, `${label} (${key})`, () => board.choose(name));
      made.dataset.tool = name;
      this.tools.set(name, made);
    }
    const what = say("rail.mirror_hint");
    this.mirror = railButton("mirror", say("rail.mirror"), what, () => board.mirroring.mirror());
    this.showAxisAtHand();
    this.snap = railButton("snap", say("rail.snap"), say("rail.snap_hint"), () => board.toggleSnap());
    const [select, outline, fold, place, measure, photo] = this.tools.values();
    root.append(select, outline, fold, place, divider(), this.mirror, this.snap, divider(), measure, photo);
  }

  /** The axis is seen before anything is mirrored. */
  showAxisAtHand() {
    const { board, mirror } = this;
    mirror.addEventListener("pointerenter", () => board.mirroring.showAxis(true));
    mirror.addEventListener("focus", () => mirror.matches(":focus-visible") && board.mirroring.showAxis(true));
    for (const name of ["pointerleave", "blur"]) mirror.addEventListener(name, () => board.mirroring.showAxis(false));
  }

  draw() {
    for (const [name, made] of this.tools) made.setAttribute("aria-pressed", String(this.board.tool.name === name));
    this.snap.setAttribute("aria-pressed", String(this.board.snapper.isOn));
  }
}

/** @param {Parameters<typeof icon>[0]} name @param {string} label @param {string} title @param {() => void} onClick */
function railButton(name, label, title, onClick) {
  const made = button("rail-button", onClick, icon(name), element("span", "rail-word", label));
  made.setAttribute("aria-label", label);
  made.title = title;
  return made;
}

function divider() {
  const made = element("span", "rail-divider");
  made.setAttribute("aria-hidden", "true");
  return made;
}
