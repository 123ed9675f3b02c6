/** The dialog `Who can fold this?`: the garment planned for every robot, one after the other, each at its own table. */

import { button, element, sayable, toldAloud } from "../dom.js";
import { sentence } from "../dock/reasons.js";
import { capital, seconds } from "../dock/words.js";
import { say } from "../language/say.js";
import { inWords } from "../messages/in_words.js";
import { length } from "../messages/lengths.js";
import { openDialog } from "./dialog.js";
import { fetched } from "./documents.js";

/** @import { Job, Reason, RobotEntry, Says } from "pleat" */
/** @import { Named } from "../messages/names.js" */

/**
 * What a robot makes of the garment; see `POST /api/comparisons`.
 * @typedef {object} Found
 * @property {"solved"|"infeasible"|"budget_exceeded"} status
 * @property {number|null} cost_s
 * @property {number|null} margin_m
 * @property {Reason[]} reasons
 * @property {{says: Says, message: string, cost_s: number|null}|null} help
 */

const COLUMNS = [say("robot.label"), say("robots.time"), say("robots.margin"), say("robots.take"), ""];
const MARGIN = say("robots.margin_hint");
const TIME_LIMIT_S = 10;
const LOOK_EVERY_MS = 300;

/** @param {import("../store.js").Store} store */
export function showWhoFolds(store) {
  if (!store.state) return;
  const { garment, robot } = store.state;
  const said = toldAloud("dialog-problem", "alert");
  const body = element("tbody", "");
  const heads = COLUMNS.map((word) => element("th", "", word));
  heads[2].title = MARGIN;
  const table = element("table", "who-folds", element("thead", "", element("tr", "", ...heads)), body);
  const about = element("p", "dialog-text", say("robots.about"));
  const dialog = openDialog(say("robots.who"), "is-wide", about, table, said);
  const comparing = new Comparing(garment);
  dialog.addEventListener("close", () => comparing.stop());

  /** @param {string} name */
  const use = async (name) => {
    if (await store.putRobot(name)) dialog.close();
  };

  (async () => {
    const robots = /** @type {RobotEntry[]} */ (await fetched("../api/robots"));
    robots.sort((one, other) => Number(other.name === robot.name) - Number(one.name === robot.name));
    const rows = robots.map((entry) => new Row(entry, entry.name === robot.name, use, garment.folds));
    body.replaceChildren(...rows.map(({ root }) => root));
    for (const row of rows) {
      if (comparing.isStopped) return;
      row.begin();
      row.show(await comparing.find(row.name));
    }
  })().catch((error) => comparing.isStopped || (said.textContent = sayable(error)));
}

/** One job after the other; the one that runs is cancelled when nobody looks any more. */
class Comparing {
  /** @param {object} garment */
  constructor(garment) {
    this.garment = garment;
    this.isStopped = false;
    /** @type {string|null} the path of the job that runs */
    this.job = null;
  }

  stop() {
    this.isStopped = true;
    if (this.job) fetched(`${this.job}/cancel`, "POST").catch(() => {});
  }

  /** @param {string} robot @returns {Promise<Found>} */
  async find(robot) {
    const asked = { garment: this.garment, robots: [robot], time_limit_s: TIME_LIMIT_S };
    let job = /** @type {Job} */ (await fetched("../api/comparisons", "POST", asked));
    this.job = `../api/jobs/${job.id}`;
    if (this.isStopped) this.stop();
    while (job.status === "queued" || job.status === "running") {
      await new Promise((resolve) => setTimeout(resolve, LOOK_EVERY_MS));
      job = await fetched(this.job);
    }
    this.job = null;
    if (job.status !== "done") throw new Error(`${capital(job.message || say("robots.ended"))}.`);
    return /** @type {{result: {robots: Found[]}}} */ (/** @type {unknown} */ (job)).result.robots[0];
  }
}

class Row {
  /**
   * @param {RobotEntry} robot
   * @param {boolean} isOwn whether the document has it now
   * @param {(name: string) => void} use
   * @param {Named[]} folds
   */
  constructor({ name, title }, isOwn, use, folds) {
    this.name = name;
    this.folds = folds;
    this.cost = element("td", "");
    this.margin = element("td", "");
    this.what = element("td", "what-then");
    this.use = button("quiet", () => use(name), say("robots.use"));
    this.use.setAttribute("aria-label", say("robots.use_one", { title }));
    this.use.hidden = isOwn;
    const last = element("td", "", this.use);
    const head = element("th", "", title);
    head.setAttribute("scope", "row");
    this.root = element("tr", "", head, this.cost, this.margin, this.what, last);
  }

  begin() {
    this.cost.textContent = say("status.planning");
  }

  /** @param {Found} found */
  show({ status, cost_s: cost, margin_m: margin, reasons, help }) {
    this.root.dataset.status = status;
    this.cost.textContent =
      cost === null ? (status === "infeasible" ? say("plan.none") : say("robots.none_found")) : seconds(cost);
    this.margin.textContent = margin === null ? "" : length(margin);
    const reason = reasons.find(({ message }) => message);
    const why = reason && cost === null ? sentence(reason, this.folds) : "";
    const then = help?.cost_s ? `${capital(inWords(help, this.folds))}: ${seconds(help.cost_s)}.` : "";
    this.what.textContent = [why, then].filter(Boolean).join(" ");
  }
}
