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
  openDialog(say("share.title"), "", about, link, said, element("div", "dialog-buttons", revoke, copy));
  make(path, link, said).then((isMade) => (copy.disabled = !isMade));
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
