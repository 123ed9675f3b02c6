/**
 * Jobs: work that goes on when nobody looks. The list follows them while it is open, and tells the window by the event
 * `robots` of robots that jobs have imported.
 */

import { capital } from "../dock/words.js";
import { button, element, progressBar, sayable, toldAloud } from "../dom.js";
import { times } from "../language/language.js";
import { numeral } from "../language/numeral.js";
import { say } from "../language/say.js";
import { percent } from "../messages/lengths.js";
import { word } from "../messages/names.js";
import { oneRun, shareHeld } from "../rehearsal/words.js";
import { isViewOnly } from "../view_only.js";
import { openDialog } from "./dialog.js";
import { fetched } from "./documents.js";

/** @import { Job } from "pleat" */
/** @import { Rehearsal, Result } from "../rehearsal/rehearsal.js" */
/** @typedef {Record<string, unknown>} Fields */

const JOBS = "../api/jobs";
const LISTED = 50;
const LOOK_EVERY_MS = 1000;
const DIGITS = 3;
const ROWS_MAX = 100;
/** Names end in their unit. */
const UNIT = /_(s|m|m2|mm|kg|rad|hz)$/;

const WORDS = {
  queued: say("job.queued"),
  running: say("job.running"),
  done: say("job.done"),
  failed: say("job.failed"),
  cancelled: say("job.cancelled"),
};

/** Show the button only where there are jobs. @param {HTMLElement} opener */
export async function offerJobs(opener) {
  if (isViewOnly) return;
  try {
    const { jobs } = await fetched(`${JOBS}?limit=1`);
    opener.hidden = !jobs.length;
  } catch {
    opener.hidden = true;
  }
}

/** @param {Rehearsal} rehearsal of the page */
export function showJobs(rehearsal) {
  const list = new JobList(rehearsal);
  const dialog = openDialog(say("jobs.title"), "", list.root, list.said);
  const timer = setInterval(() => list.look(), LOOK_EVERY_MS);
  dialog.addEventListener("close", () => clearInterval(timer));
  list.look();
}

class JobList {
  /** @param {Rehearsal} rehearsal of the page */
  constructor(rehearsal) {
    this.rehearsal = rehearsal;
    this.root = element("ul", "jobs");
    this.said = toldAloud("dialog-problem", "alert");
    /** @type {Map<string, JobRow>} the rows stay, so that the focus does */
    this.rows = new Map();
  }

  async look() {
    try {
      const { jobs } = await fetched(`${JOBS}?limit=${LISTED}`);
      this.show(jobs);
      this.say("");
    } catch (error) {
      this.say(sayable(error));
    }
  }

  /** @param {Job[]} jobs newest first */
  show(jobs) {
    for (const job of jobs) {
      const row = this.rows.get(job.id) ?? new JobRow(job, (id) => this.cancel(id), (name, id) => this.open(name, id));
      this.rows.set(job.id, row);
      row.show(job);
    }
    const roots = jobs.flatMap(({ id }) => this.rows.get(id)?.root ?? []);
    if (roots.some((root, at) => this.root.children[at] !== root)) this.root.replaceChildren(...roots);
  }

  /** @param {string} id */
  async cancel(id) {
    try {
      await fetched(`${JOBS}/${id}/cancel`, "POST");
    } catch (error) {
      this.say(sayable(error));
      return;
    }
    this.look();
  }

  /** @param {string} name @param {string} id */
  open(name, id) {
    showResult(name, `${JOBS}/${id}`, this.rehearsal).catch((error) => this.say(sayable(error)));
  }

  /** @param {string} sentence */
  say(sentence) {
    if (this.said.textContent !== sentence) this.said.textContent = sentence;
  }
}

class JobRow {
  /**
   * @param {Job} job
   * @param {(id: string) => void} cancel
   * @param {(name: string, id: string) => void} show its result
   */
  constructor(job, cancel, show) {
    const name = [capital(word("job_kind", job.kind)), job.about].filter(Boolean).join(", ");
    const when = new Date(job.created).toLocaleString(times, { dateStyle: "short", timeStyle: "short" });
    this.status = element("span", "job-status");
    this.status.setAttribute("role", "status");
    this.bar = progressBar(say("jobs.progress", { name }));
    this.message = element("span", "dialog-text");
    this.stop = button("quiet", () => cancel(job.id), say("search.stop"));
    this.stop.setAttribute("aria-label", say("jobs.stop_one", { name, when }));
    this.result = button("quiet", () => show(name, job.id), say("jobs.result"));
    this.result.setAttribute("aria-label", say("jobs.result_of", { name, when }));
    const head = element("span", "job-name", `${name}, ${when}`);
    this.isDone = false;
    this.root = element("li", "job", head, this.status, this.bar, this.message, this.stop, this.result);
  }

  /** @param {Job} job as it is now */
  show({ kind, status, progress, message }) {
    const isOpen = status === "queued" || status === "running";
    const word = WORDS[status];
    if (this.status.textContent !== word) this.status.textContent = word;
    this.bar.value = progress;
    this.bar.hidden = !isOpen;
    this.message.textContent = isOpen ? percent(progress) : message;
    this.stop.hidden = !isOpen;
    this.result.hidden = status !== "done";
    if (status === "done" && kind === "robots" && !this.isDone) dispatchEvent(new Event("robots"));
    this.isDone = status === "done";
  }
}

/**
 * What a job has come to: a rehearsal in words, of others the numbers by name, what there is several of as a table. The
 * JSON is one link away.
 * @param {string} title
 * @param {string} path of the job
 * @param {Rehearsal} rehearsal of the page
 */
async function showResult(title, path, rehearsal) {
  const { id, kind, result } = await fetched(path);
  const link = element("a", "", say("jobs.as_json"));
  link.setAttribute("href", path);
  const parts = kind === "rehearsals" ? rehearsed(result, id, rehearsal) : [shown(result)];
  openDialog(title, "is-wide result", ...parts, element("p", "dialog-note", link));
}

/** A rehearsal in words, and a button that shows it at its plan. @param {Result} result @param {string} job @param {Rehearsal} rehearsal */
function rehearsed(result, job, rehearsal) {
  const told = result.runs.map((run, index) =>
    element("li", "", say("rehearsal.run_told", { run: index + 1, told: oneRun(run) })),
  );
  const show = button("main-button", () => {
    for (const dialog of document.querySelectorAll("dialog[open]")) /** @type {HTMLDialogElement} */ (dialog).close();
    rehearsal.showAgain(job);
  }, say("rehearsal.in_view3d"));
  show.title = say("rehearsal.in_view3d_hint");
  const open = button("plain-button", () => rehearsal.openThere(job), say("rehearsal.open_document"));
  const isHere = rehearsal.isAbout(job);
  const note = element("p", "dialog-note", isHere ? "" : say("rehearsal.other_plan"));
  const buttons = isHere ? [show] : rehearsal.elsewhere(job) ? [open] : [];
  const below = element("div", "dialog-buttons", ...buttons);
  return [element("p", "", shareHeld(result)), element("ul", "result-runs", ...told), note, below];
}

/** @param {unknown} value @returns {Node} */
function shown(value) {
  if (Array.isArray(value)) return several(value);
  if (isFields(value)) {
    const entries = Object.entries(value).map(([name, one]) => [
      element("dt", "", named(name)),
      element("dd", "", shown(one)),
    ]);
    return element("dl", "result-fields", ...entries.flat());
  }
  return document.createTextNode(inShort(value));
}

/** Short ones in a row, those with fields as a table. @param {unknown[]} values */
function several(values) {
  if (!values.length || !values.every(isFields)) return document.createTextNode(inShort(values));
  const names = Object.keys(values[0]);
  const head = element("tr", "", ...names.map((name) => element("th", "", named(name))));
  const rows = values
    .slice(0, ROWS_MAX)
    .map((fields) => element("tr", "", ...names.map((name) => element("td", "", inShort(fields[name])))));
  const table = element("table", "result-table", element("thead", "", head), element("tbody", "", ...rows));
  const left = values.length - rows.length;
  const more = element("p", "hint", left ? say("suggestions.more", { count: left }) : "");
  return element("div", "result-scroll", table, more);
}

/** A value in a cell: of what is long only how much there is. @param {unknown} value @returns {string} */
function inShort(value) {
  if (value === null || value === undefined) return "–";
  if (typeof value === "number") return numeral(value, DIGITS, 0);
  if (typeof value === "boolean") return value ? "✓" : "–";
  if (typeof value === "string") return value;
  if (isFields(value)) return String(value.title ?? Object.values(value).map(inShort).join(", "));
  const values = /** @type {unknown[]} */ (value);
  const isShort = values.length <= 3 && values.every((one) => typeof one !== "object");
  return isShort ? values.map(inShort).join(", ") : say("jobs.entries", { count: values.length });
}

/** @param {unknown} value @returns {value is Fields} */
const isFields = (value) => typeof value === "object" && value !== null && !Array.isArray(value);

/** A field's name, with its unit. @param {string} name */
const named = (name) => name.replace(UNIT, " ($1)").replaceAll("_", " ");
