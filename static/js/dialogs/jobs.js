/** Jobs: work that goes on when nobody looks. The list follows them while it is open. */

import { button, element, sayable } from "../dom.js";
import { openDialog } from "./dialog.js";
import { fetched } from "./fetched.js";

/** @import { Job } from "pleat" */

const JOBS = "../api/jobs";
const LISTED = 50;
const LOOK_EVERY_MS = 1000;

const WORDS = { queued: "Waiting", running: "Running", done: "Done", failed: "Failed", cancelled: "Cancelled" };

/** Show the button only where there are jobs. @param {HTMLElement} opener */
export async function offerJobs(opener) {
  try {
    const { jobs } = await fetched(`${JOBS}?limit=1`);
    opener.hidden = !jobs.length;
  } catch {
    opener.hidden = true;
  }
}

export function showJobs() {
  const list = new JobList();
  const dialog = openDialog("Jobs", "", list.root, list.said);
  const timer = setInterval(() => list.look(), LOOK_EVERY_MS);
  dialog.addEventListener("close", () => clearInterval(timer));
  list.look();
}

class JobList {
  constructor() {
    this.root = element("ul", "jobs");
    this.said = element("p", "dialog-problem");
    this.said.setAttribute("role", "alert");
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
      const row = this.rows.get(job.id) ?? new JobRow(job, (id) => this.cancel(id));
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

  /** @param {string} sentence */
  say(sentence) {
    if (this.said.textContent !== sentence) this.said.textContent = sentence;
  }
}

class JobRow {
  /**
   * @param {Job} job
   * @param {(id: string) => void} cancel
   */
  constructor(job, cancel) {
    const name = job.kind[0].toUpperCase() + job.kind.slice(1).replaceAll("_", " ");
    const when = new Date(job.created).toLocaleString([], { dateStyle: "short", timeStyle: "short" });
    this.status = element("span", "job-status");
    this.status.setAttribute("role", "status");
    this.bar = /** @type {HTMLProgressElement} */ (element("progress", "job-progress"));
    this.bar.setAttribute("aria-label", `Progress of ${name}`);
    this.message = element("span", "dialog-text");
    this.stop = button("quiet", () => cancel(job.id), "Cancel");
    this.stop.setAttribute("aria-label", `Cancel ${name}, ${when}`);
    this.link = /** @type {HTMLAnchorElement} */ (element("a", "", "Result"));
    this.link.href = `${JOBS}/${job.id}`;
    this.link.setAttribute("aria-label", `Result of ${name}, ${when}`);
    const head = element("span", "job-name", `${name}, ${when}`);
    this.root = element("li", "job", head, this.status, this.bar, this.message, this.stop, this.link);
  }

  /** @param {Job} job as it is now */
  show({ status, progress, message }) {
    const isOpen = status === "queued" || status === "running";
    const word = WORDS[status];
    if (this.status.textContent !== word) this.status.textContent = word;
    this.bar.value = progress;
    this.bar.hidden = !isOpen;
    this.message.textContent = message;
    this.stop.hidden = !isOpen;
    this.link.hidden = status !== "done";
  }
}
