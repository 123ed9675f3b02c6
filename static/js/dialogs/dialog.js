/** A dialog in the middle of the page, closed by Esc, its cross, or a click beside it. */

import { button, element } from "../dom.js";
import { icon } from "../icons.js";
import { say } from "../language/say.js";
import { inWords } from "../messages/in_words.js";

/** @import { Problem } from "pleat" */

/**
 * @param {string} title
 * @param {string} className
 * @param {...Node} children
 * @returns {HTMLDialogElement} open; it is removed when it is closed
 */
export function openDialog(title, className, ...children) {
  const heading = element("h2", "dialog-title", title);
  heading.id = `title-${Date.now().toString(36)}`;
  const cross = button("icon-button", () => dialog.close(), icon("close"));
  cross.setAttribute("aria-label", say("dialog.close"));
  const dialog = /** @type {HTMLDialogElement} */ (
    element("dialog", `dialog ${className}`, element("header", "dialog-head", heading, cross), ...children)
  );
  dialog.setAttribute("aria-labelledby", heading.id);
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}

/** What a server's problem says, as a sentence. @param {Problem} problem */
export function sentenceOf(problem) {
  const [first] = problem.errors ?? [];
  const text = first ? inWords(first, []) : String(problem.detail ?? problem.title ?? say("server.refused"));
  return text[0].toUpperCase() + text.slice(1);
}

export const OFFLINE = say("server.unreachable");
