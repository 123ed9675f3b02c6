/** The dialog `Who can fold this?`: the garment planned for every robot, one after the other, each at its own table. */

import { button, element, sayable, toldAloud } from "../dom.js";
import { sentence } from "../dock/reasons.js";
import { capital, seconds } from "../dock/words.js";
import { jobEvents } from "../event_stream.js";
import { say } from "../language/say.js";
import { inWords } from "../messages/in_words.js";
import { length } from "../messages/lengths.js";
import { openDialog } from "./dialog.js";
import { fetched } from "./documents.js";

/** @import { Reason, RobotEntry, Says } from "pleat" */
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
  const closing = new AbortController();
  dialog.addEventListener("close", () => closing.abort());

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
      row.begin();
      row.show(await compared(garment, row.name, closing.signal));
    }
  })().catch((error) => closing.signal.aborted || (said.textContent = sayable(error)));
}

/**
 * What a robot makes of a garment, by a job that is cancelled when nobody looks any more.
 * @param {object} garment @param {string} robot @param {AbortSignal} signal
 * @returns {Promise<Found>}
 */
async function compared(garment, robot, signal) {
  const asked = { garment, robots: [robot], time_limit_s: TIME_LIMIT_S };
  /** @type {{status: string, message: string, result: {robots: Found[]}}|null} */
  let end = null;
  for await (const { event, data } of jobEvents("../api/comparisons", asked, signal)) if (event === "end") end = data;
  if (end?.status !== "done") throw new Error(`${capital(end?.message || say("robots.ended"))}.`);
  return end.result.robots[0];
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
