/**
 * Two words to someone new, each where it is needed: how to draw an outline, how to play. A word goes away
 * when it is followed or has been read, or when anything else is pressed or opened, and does not come again in this
 * browser.
 */

import { element } from "./dom.js";
import { say } from "./language/say.js";
import { PHONE } from "./phone.js";
import { isViewOnly } from "./view_only.js";

/** How long a word is there at most (ms). */
const READING_MS = 5_000;
/** Where there is no keyboard to speak of. */
const TOUCHED = matchMedia(`${PHONE}, (hover: none) and (pointer: coarse)`);
const KEPT = "pleat-coached";
const GAP_PX = 10;

/**
 * @typedef {object} Mark
 * @property {string} name
 * @property {string} text
 * @property {string} at the part of the page that it stands at
 * @property {"above"|"over"} side of that part
 * @property {(board: import("./board/board.js").Board) => boolean} isDue
 */

/** @type {Mark[]} */
const MARKS = [
  {
    name: "outline",
    text: say("coach.outline"),
    at: "#drafting-board",
    side: "over",
    isDue: ({ drawing, tools }) => !isViewOnly && !drawing.outline.length && !tools.outline.isBusy,
  },
  {
    name: "play",
    text: say(TOUCHED.matches ? "coach.play_touch" : "coach.play"),
    at: ".main-button.play",
    side: "above",
    isDue: ({ store, drawing }) =>
      drawing.folds.length > 0 && store.plan?.status === "solved" && !store.playback?.playing && !store.playback?.t_s,
  },
];

/** @param {import("./board/board.js").Board} board */
export function mountCoach(board) {
  const known = new Set((localStorage.getItem(KEPT) ?? "").split(" "));
  const root = element("p", "coach");
  root.setAttribute("aria-live", "polite");
  root.hidden = true;
  document.body.append(root);
  /** @type {Mark|null} */
  let shown = null;
  let timer = 0;

  const end = () => {
    clearTimeout(timer);
    shown = null;
    root.hidden = true;
  };
  /** @param {Mark} mark */
  const begin = (mark) => {
    shown = mark;
    known.add(mark.name);
    localStorage.setItem(KEPT, [...known].join(" ").trim());
    root.textContent = mark.text;
    root.hidden = false;
    timer = setTimeout(end, READING_MS);
  };
  const look = () => {
    const isElsewhere = board.tool.name === "propose" || document.hidden || document.querySelector("dialog[open]");
    if (shown && (isElsewhere || !shown.isDue(board))) end();
    if (!board.state || isElsewhere) return;
    const due = shown ? null : MARKS.find((mark) => !known.has(mark.name) && mark.isDue(board));
    if (due && seen(due)) begin(due);
    if (shown) place(root, shown);
  };
  for (const name of ["document", "plan", "playback", "begun", "propose"]) board.store.addEventListener(name, look);
  addEventListener("resize", look);
  document.addEventListener("visibilitychange", look);
  for (const name of ["pointerdown", "keydown"]) document.addEventListener(name, end, true);
}

/** The box of the part that a mark stands at, where it is seen. @param {Mark} mark */
function seen({ at }) {
  const part = /** @type {HTMLElement|null} */ (document.querySelector(at));
  const box = part?.getBoundingClientRect();
  return part?.checkVisibility({ visibilityProperty: true }) && box?.width ? box : null;
}

/** @param {HTMLElement} root @param {Mark} mark */
function place(root, mark) {
  const box = seen(mark);
  if (!box) return;
  const { offsetWidth: width, offsetHeight: height } = root;
  const left = box.left + box.width / 2 - width / 2;
  const top = mark.side === "above" ? box.top - GAP_PX - height : box.top + 3 * GAP_PX;
  root.dataset.side = mark.side;
  root.style.left = `${Math.max(GAP_PX, Math.min(left, innerWidth - width - GAP_PX))}px`;
  root.style.top = `${Math.max(GAP_PX, top)}px`;
}
