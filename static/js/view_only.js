/** The page by a link for looking: it plays and follows, and has nothing with which something could be changed. */

import { byId } from "./dom.js";
import { say } from "./language/say.js";

/** Menus of which one entry is read and none is chosen. */
const STILL = ["#garment", ".view3d-robot"];

/** Whether the page was opened by such a link; the server refuses changes by it in any case. */
export const isViewOnly = /\/s\/[\w-]+\/d\/[^/]+$/.test(location.pathname);

/** Take away what changes something: all that has the class `for-editors`, also what is made later. */
export function viewOnly() {
  document.documentElement.classList.add("is-view-only");
  for (const part of STILL) document.querySelector(part)?.setAttribute("inert", "");
  const badge = document.createElement("span");
  badge.className = "assumptions";
  badge.textContent = say("share.view_only");
  byId("status").after(badge);
}
