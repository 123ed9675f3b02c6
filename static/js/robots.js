/**
 * The combobox `Robot` in the 3D view: who folds. Another robot brings its table and stations along, as one step. The
 * window's event `robots` says that there are others.
 */

import { byId } from "./dom.js";
import { word } from "./messages/names.js";
import { pictured, robotPicture } from "./picture_menu.js";
import { isViewOnly } from "./view_only.js";

/** @import { RobotEntry } from "pleat" */

/** @param {import("./store.js").Store} store */
export function mountRobots(store) {
  const select = /** @type {HTMLSelectElement} */ (byId("robot"));
  /** @type {RobotEntry[]} */
  let robots = [];

  const show = () => {
    if (!store.state) return;
    const { name, title } = store.state.robot;
    if (![...select.options].some(({ value }) => value === name)) select.append(new Option(title, name));
    select.value = name;
    select.disabled = !store.isLive || !robots.length;
  };
  const load = async () => {
    if (isViewOnly) return;
    const answer = await fetch("../api/robots").catch(() => null);
    if (!answer?.ok) return;
    robots = await answer.json();
    select.replaceChildren(...robots.map((robot) => pictured(robotPicture(robot), called(robot), robot.name)));
    show();
  };
  const choose = async () => {
    const wanted = select.value;
    if (!(await store.putRobot(wanted))) show(); // it was refused, so the one before stays
  };

  select.addEventListener("change", choose);
  addEventListener("robots", load);
  store.addEventListener("document", show);
  store.addEventListener("connection", () => (store.isLive && !robots.length ? load() : show()));
}

/** The stations of each robot's own scene, once they have been asked for. @type {Map<string, string[]|null>} */
const known = new Map();

/**
 * The stations of a robot's own scene; null until they are known.
 * @param {string} robot
 * @param {() => void} then called when they are
 */
export function ownStations(robot, then) {
  if (!known.has(robot)) {
    known.set(robot, null);
    askStations(robot).then((stations) => {
      if (stations) known.set(robot, stations);
      if (stations) then();
    });
  }
  return known.get(robot) ?? null;
}

/** @param {string} robot @returns {Promise<string[]|null>} */
async function askStations(robot) {
  if (isViewOnly) return null;
  const answer = await fetch(`../api/robots/${encodeURIComponent(robot)}`).catch(() => null);
  if (!answer?.ok) return null;
  const { scene } = await answer.json();
  return Object.keys(scene.stations);
}

/** A robot's title and its arms, as in `Two UR5e: left, right`. @param {RobotEntry} robot */
const called = ({ title, arms }) => `${title}: ${arms.map((arm) => word("arm_name", arm)).join(", ")}`;
