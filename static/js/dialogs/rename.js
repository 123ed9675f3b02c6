/** What the garment is called; its file is named after that. */

import { element, field } from "../dom.js";
import { inEnglish, say } from "../language/say.js";
import { openDialog } from "./dialog.js";

const LONGEST_NAME = 63;
const LONGEST_TITLE = 200;

/** @param {import("../store.js").Store} store */
export async function showRename(store) {
  if (!store.state) return;
  const title = await askTitle(store.state.drawing.title);
  if (title)
    store.edit(inEnglish("step.rename_garment"), (drawing) => Object.assign(drawing, { title, name: fileName(title) }));
}

/** Ask what a garment is to be called. @param {string} before @returns {Promise<string>} empty if nothing was said */
export function askTitle(before) {
  const input = field({ className: "field title-field", value: before, maxLength: LONGEST_TITLE, required: true });
  const form = element(
    "form",
    "rename",
    element("label", "", element("span", "dialog-text", say("rename.name")), input),
    element("div", "dialog-buttons", element("button", "main-button", say("rename.do"))),
  );
  const dialog = openDialog(say("step.rename_garment"), "", form);
  input.select();
  input.focus();
  return new Promise((resolve) => {
    let title = "";
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      title = input.value.trim();
      if (title) dialog.close();
    });
    dialog.addEventListener("close", () => resolve(title));
  });
}

/** The name of a garment's file: small letters without accents, digits and dashes. @param {string} title */
export function fileName(title) {
  const plain = title.normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase();
  const dashed = plain.replace(/[^a-z0-9]+/g, "-").replace(/^-+/, "");
  return dashed.slice(0, LONGEST_NAME).replace(/-+$/, "") || "garment";
}
