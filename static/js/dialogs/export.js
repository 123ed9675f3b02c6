/** `Export`: every format in which the document can be taken along. */

import { button, element, sayable } from "../dom.js";
import { say, translated } from "../language/say.js";
import { inWords } from "../messages/in_words.js";
import { openDialog, OFFLINE, sentenceOf } from "./dialog.js";

/** @import { FileEntry } from "pleat" */
/** @import { Store } from "../store.js" */

/** What files are for. @type {Record<FileEntry["group"], string>} */
const TITLES = { look: say("export.group.look"), robot: say("export.group.robot"), open: say("export.group.open") };

/** @param {import("../store.js").Store} store */
export async function showExport(store) {
  const said = element("p", "dialog-problem");
  const lists = Object.entries(TITLES).map(([group, title]) => {
    const list = element("ul", "exports");
    list.setAttribute("aria-label", title);
    return { group, list, section: element("section", "", element("h3", "", title), list) };
  });
  const stopped = new AbortController();
  const { signal } = stopped;
  const dialog = openDialog(say("export.title"), "", ...lists.map(({ section }) => section), said);
  dialog.addEventListener("close", () => stopped.abort());
  /** @type {Map<string, Element>} by what the server said: what it still says keeps its row, and the focus in it */
  let rows = new Map();
  let asked = 0;

  async function look() {
    const mine = ++asked;
    const [files, problem] = await filesOf(store);
    if (mine !== asked || signal.aborted) return;
    const before = rows;
    rows = new Map();
    for (const file of files) {
      const text = JSON.stringify(file);
      rows.set(text, before.get(text) ?? row(store, file, signal));
    }
    said.textContent = problem;
    for (const { group, list, section } of lists) {
      const own = files.filter((file) => file.group === group);
      section.hidden = !own.length;
      fill(list, own.flatMap((file) => rows.get(JSON.stringify(file)) ?? []));
    }
  }

  for (const name of ["document", "plan", "connection"]) store.addEventListener(name, look, { signal });
  await look();
}

/** Show these rows; one that stays in place keeps the focus. @param {HTMLElement} list @param {Element[]} shown */
function fill(list, shown) {
  for (const item of [...list.children]) if (!shown.includes(item)) item.remove();
  for (const [place, item] of shown.entries())
    if (list.children[place] !== item) list.insertBefore(item, list.children[place] ?? null);
}

/**
 * What the document can be made into now, and why that is not known.
 * @param {Store} store
 * @returns {Promise<[FileEntry[], string]>}
 */
async function filesOf(store) {
  const answer = await fetch(`${store.path}/files`).catch(() => null);
  if (!answer) return [[], OFFLINE];
  return answer.ok ? [await answer.json(), ""] : [[], sentenceOf(await answer.json())];
}

/** @param {Store} store @param {FileEntry} file @param {AbortSignal} signal when the dialog is closed */
function row(store, file, signal) {
  const url = `${store.path}/files/${file.what}`;
  const said = element("small", "", file.available ? translated(file.text) : whyNot(store, file));
  const name = element("span", "export-name", translated(file.title), said);
  return element("li", "export", name, verb(url, file, said, signal));
}

/** Why a file is not there now, as a sentence. @param {Store} store @param {FileEntry} file */
function whyNot(store, { reason, says }) {
  const text = inWords({ says, message: translated(reason ?? "") }, store.state?.drawing.folds ?? []);
  return text.charAt(0).toUpperCase() + text.slice(1) + (text.endsWith(".") ? "" : ".");
}

/** @param {string} url @param {FileEntry} file @param {HTMLElement} said @param {AbortSignal} signal */
function verb(url, file, said, signal) {
  if (!file.available || file.is_slow) {
    const slow = button("plain-button", () => record(slow, url, file, said, signal), say("export.save"));
    slow.disabled = !file.available;
    slow.setAttribute("aria-label", say("export.save_as", { title: translated(file.title) }));
    return slow;
  }
  const link = element("a", "plain-button", say("export.save"));
  link.setAttribute("href", url);
  link.setAttribute("download", file.filename);
  link.setAttribute("aria-label", say("export.save_as", { title: translated(file.title) }));
  return link;
}

/**
 * Fetch what takes a while, saying so.
 * @param {HTMLButtonElement} pressed
 * @param {string} url
 * @param {FileEntry} file
 * @param {HTMLElement} said
 * @param {AbortSignal} signal
 */
async function record(pressed, url, file, said, signal) {
  pressed.disabled = true;
  said.textContent = say("export.being_made");
  try {
    const answer = await fetch(url, { signal });
    if (!answer.ok) throw new Error(sentenceOf(await answer.json()));
    const link = document.createElement("a");
    link.href = URL.createObjectURL(await answer.blob());
    link.download = file.filename;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
    said.textContent = translated(file.text);
  } catch (error) {
    said.textContent = error instanceof TypeError ? OFFLINE : sayable(error);
  }
  pressed.disabled = false;
}
