/** The page: shows what the server says about the document, sends what the reader does. */

import { Clock } from "./clock.js";
import { byId } from "./dom.js";
import { Folds } from "./folds.js";
import { Garments } from "./garments.js";
import { Lanes } from "./lanes.js";
import { Live } from "./live.js";
import { showNumbers } from "./numbers.js";
import { PlanList } from "./plan.js";
import { StageFrame } from "./stage.js";
import { Theme } from "./theme.js";
import { Transport } from "./transport.js";

const name = location.pathname.split("/").at(-1) ?? "";
/** What the server said last about the drawing, and about its plan. */
const told = { document: null, plan: null };
const status = byId("status");
const clock = new Clock();
const live = new Live(name);
const transport = new Transport(live, clock);
const garments = new Garments((garment) => live.send({ do: "choose", garment }));
const folds = new Folds();
const plan = new PlanList((t_s) => transport.seek(t_s));
const lanes = new Lanes((t_s) => transport.seek(t_s));
const stage = new StageFrame(name, onKey);
const theme = new Theme();

garments.load();
stage.load();
theme.addEventListener("change", tellTheme);
document.addEventListener("keydown", onKey);

live.addEventListener("open", (event) => {
  tellTheme();
  if (!event.detail.again) return;
  stage.load();
  garments.load();
});
live.addEventListener("lost", () => say("Connection lost, trying again...", "lost"));
live.addEventListener("problem", (event) => say(event.detail.detail, "failed"));
live.addEventListener("playback", (event) => clock.set(event.detail));
live.addEventListener("gone", () => say("There is no such document.", "failed"));
live.addEventListener("document", (event) => {
  told.document = event.detail;
  show();
});
live.addEventListener("plan", (event) => {
  told.plan = event.detail;
  show();
});
clock.addEventListener("tick", () => {
  for (const part of [folds, plan, lanes]) part.tick(clock.now);
});

/** Show what was told; the plan may be that of a drawing a moment ago. */
function show() {
  if (!told.document || !told.plan) return;
  const { garment } = told.document;
  const fits = told.plan.plan?.dag.folds === garment.folds.length;
  const shown = fits ? told.plan.plan : null;
  say(told.plan.text, told.plan.status);
  garments.show(garment.name);
  folds.show(garment, shown);
  plan.show(garment, shown, told.plan.status);
  lanes.show(garment, shown);
  showNumbers(told.plan);
}

function tellTheme() {
  live.send({ do: "theme", dark: theme.isDark });
}

/**
 * @param {string} text
 * @param {string} kind
 */
function say(text, kind) {
  status.textContent = text;
  status.title = text;
  status.dataset.status = kind;
}

/** @param {KeyboardEvent} event */
function onKey(event) {
  const target = /** @type {HTMLElement} */ (event.target);
  const isOurs = event.key === " " && !["BUTTON", "SELECT", "A", "TEXTAREA"].includes(target.tagName);
  if (!isOurs) return;
  event.preventDefault();
  transport.toggle();
}
