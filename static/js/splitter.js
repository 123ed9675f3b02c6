/** The bar between board and 3D view: dragged, or moved by the arrow keys; a double click puts it back. */

import { byId } from "./dom.js";

const KEY = "pleat-split";
const FIRST = 0.52;
const STEP = 0.02;
const LEAST = 0.2;
const MOST = 0.85;

export function mountSplitter() {
  const splitter = byId("splitter");
  const work = byId("work");
  const kept = Number(localStorage.getItem(KEY));
  let share = kept >= LEAST && kept <= MOST ? kept : FIRST;

  /** @param {number} wanted the board's share */
  const put = (wanted) => {
    share = Math.min(Math.max(wanted, LEAST), MOST);
    work.style.setProperty("--board-share", `${100 * share}fr`);
    work.style.setProperty("--view3d-share", `${100 - 100 * share}fr`);
    splitter.setAttribute("aria-valuenow", String(Math.round(100 * share)));
    localStorage.setItem(KEY, String(share));
  };
  /** @param {PointerEvent} event */
  const at = (event) => {
    const left = byId("board").getBoundingClientRect().left;
    const right = byId("view3d-pane").getBoundingClientRect().right;
    return (event.clientX - left) / (right - left);
  };

  splitter.setAttribute("aria-valuemin", String(100 * LEAST));
  splitter.setAttribute("aria-valuemax", String(100 * MOST));
  splitter.addEventListener("pointerdown", (event) => {
    splitter.setPointerCapture(event.pointerId);
    work.classList.add("is-splitting"); // the 3D view's frame would swallow the pointer
  });
  splitter.addEventListener("pointermove", (event) => {
    if (splitter.hasPointerCapture(event.pointerId)) put(at(event));
  });
  splitter.addEventListener("lostpointercapture", () => work.classList.remove("is-splitting"));
  splitter.addEventListener("dblclick", () => put(FIRST));
  splitter.addEventListener("keydown", (event) => {
    /** @type {Record<string, number>} */
    const places = { ArrowLeft: share - STEP, ArrowRight: share + STEP, Home: LEAST, End: MOST };
    const wanted = places[event.key];
    if (wanted === undefined) return;
    event.preventDefault();
    put(wanted);
  });
  put(share);
}
