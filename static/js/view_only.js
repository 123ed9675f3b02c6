/** The page by a link for looking: it plays and follows, and has nothing with which something could be changed. */

import { byId } from "./dom.js";
import { say } from "./language/say.js";

const GONE = ["gallery", "rename", "share", "undo", "redo", "new", "import", "jobs", "settings", "compare", "rail"];
const STILL = ["#garment", ".view3d-robot", "#board", ".folds", ".dock-outcome"];

/** Whether the page was opened by such a link; the server refuses changes by it in any case. */
export const isViewOnly = /\/s\/[\w-]+\/d\/[^/]+$/.test(location.pathname);

/** Take away what changes something; what is left of it can be seen, not used. */
export function viewOnly() {
  for (const id of GONE) byId(id).remove();
  for (const part of STILL) for (const found of document.querySelectorAll(part)) found.setAttribute("inert", "");
  const badge = document.createElement("span");
  badge.className = "assumptions";
  badge.textContent = say("share.view_only");
  byId("status").after(badge);
}
