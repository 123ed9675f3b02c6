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

const name = document.body.dataset.document ?? "main";
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
live.addEventListener("document", (event) => {
  const message = event.detail;
  say(message.text, message.status);
  garments.show(message.garment.name);
  folds.show(message.garment, message.plan);
  plan.show(message.garment, message.plan, message.status);
  lanes.show(message.garment, message.plan);
  showNumbers(message);
});
clock.addEventListener("tick", () => {
  for (const part of [folds, plan, lanes]) part.tick(clock.now);
});

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
