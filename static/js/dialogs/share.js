/** A link with which others may look at the document and play its plan. */

import { button, element, input, toldAloud } from "../dom.js";
import { say } from "../language/say.js";
import { openDialog, sentenceOf } from "./dialog.js";

/** @param {import("../store.js").Store} store */
export function showShare(store) {
  const path = `${store.path}/share`;
  const link = input("field title-field", { readOnly: true, ariaLabel: say("share.link") });
  const said = toldAloud("dialog-text");
  const copy = button("main-button", async () => {
    link.select();
    await navigator.clipboard.writeText(link.value);
    said.textContent = say("share.copied");
  }, say("share.copy"));
  const revoke = button("quiet", async () => {
    const answer = await fetch(path, { method: "DELETE" });
    said.textContent = answer.ok ? say("share.revoked") : sentenceOf(await answer.json());
    if (answer.ok) link.value = "";
    copy.disabled = link.value === "";
  }, say("share.revoke"));
  copy.disabled = true;
  const about = element("p", "dialog-text", say("share.about"));
  const shown = element("div", "share-preview");
  openDialog(say("share.title"), "share", about, link, said, shown, element("div", "dialog-buttons", revoke, copy));
  shown.hidden = store.plan?.status !== "solved"; // without a plan a link has no picture
  if (!shown.hidden) shown.append(preview(store, () => (shown.hidden = true)));
  make(path, link, said).then((isMade) => (copy.disabled = !isMade));
}

/** The picture that previews of the link show. @param {import("../store.js").Store} store @param {() => void} onNone */
function preview(store, onNone) {
  const made = document.createElement("img");
  made.alt = say("share.preview");
  made.title = made.alt;
  made.addEventListener("error", onNone);
  made.src = `${store.path}/files/picture.png`;
  return made;
}

/**
 * @param {string} path
 * @param {HTMLInputElement} link
 * @param {HTMLElement} said
 * @returns {Promise<boolean>} whether there is a link now
 */
async function make(path, link, said) {
  const answer = await fetch(path, { method: "POST" });
  const told = await answer.json();
  if (answer.ok) link.value = new URL(told.path, location.href).href;
  else said.textContent = sentenceOf(told);
  return answer.ok;
}
