/**
 * On a phone one of board and 3D view is large and the other a small inset; the dock is a sheet that pulls up. The 3D
 * view comes first where a garment has folds, and for those who came by a link for looking.
 */

import { byId } from "./dom.js";
import { say } from "./language/say.js";
import { isViewOnly } from "./view_only.js";

export const PHONE = "(max-width: 720px)";
const PULL_PX = 24;

/** @param {import("./store.js").Store} store */
export function mountPhone(store) {
  const phone = matchMedia(PHONE);
  const work = byId("work");
  const swap = byId("swap");
  const grip = byId("sheet");

  const show = () => {
    const isView3DLarge = work.classList.contains("is-view3d-large");
    swap.hidden = !phone.matches;
    swap.setAttribute("aria-label", isView3DLarge ? say("phone.board_large") : say("phone.view3d_large"));
  };
  /** @param {boolean} isOpen */
  const open = (isOpen) => {
    document.body.classList.toggle("is-sheet-open", isOpen);
    grip.setAttribute("aria-expanded", String(isOpen));
    grip.setAttribute("aria-label", isOpen ? say("phone.hide_sheet") : say("phone.show_sheet"));
  };
  const isOpen = () => document.body.classList.contains("is-sheet-open");

  const turn = (isView3DLarge = !work.classList.contains("is-view3d-large")) => {
    work.classList.toggle("is-view3d-large", isView3DLarge);
    show();
  };
  store.addEventListener("document", () => turn(isViewOnly || Boolean(store.state?.drawing.folds.length)), { once: true });
  swap.addEventListener("click", () => turn());
  /** @type {number|null} where the pull began (px) */
  let from = null;
  let hasPulled = false;
  grip.addEventListener("pointerdown", (event) => {
    from = event.clientY;
    hasPulled = false;
    grip.setPointerCapture(event.pointerId);
  });
  grip.addEventListener("pointermove", (event) => {
    if (from === null || Math.abs(event.clientY - from) < PULL_PX) return;
    hasPulled = true;
    open(event.clientY < from);
  });
  grip.addEventListener("lostpointercapture", () => (from = null));
  grip.addEventListener("click", () => {
    if (!hasPulled) open(!isOpen());
    hasPulled = false;
  });
  phone.addEventListener("change", show);
  open(false);
  turn(isViewOnly);
}
