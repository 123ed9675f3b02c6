/**
 * A robot of one's own, a zip archive of `robot.json`, its URDF and its meshes, or without a card, which is drafted then:
 * it is saved, and folds from then on.
 */

import { say } from "../language/say.js";
import { warningInWords } from "../messages/robot_warnings.js";
import { notice } from "../notices.js";
import { OFFLINE, sentenceOf } from "./dialog.js";
import { showMyRobot } from "./my_robot.js";

/** @import { RobotTaken } from "pleat" */

/** How long a warning is shown (ms): there may be several. */
const WARNING_MS = 30_000;

/**
 * @param {import("../store.js").Store} store
 * @param {File} file
 * @returns {Promise<string>} why it was not taken; nothing if it was
 */
export async function takeRobot(store, file) {
  const headers = { "content-type": "application/octet-stream" };
  const query = new URLSearchParams({ filename: file.name });
  const answer = await fetch(`../api/robots/imports?${query}`, { method: "POST", headers, body: file }).catch(() => null);
  const told = answer ? await answer.json() : null;
  if (!answer?.ok) return told ? `${file.name}: ${sentenceOf(told)}` : OFFLINE;
  const { name, title, draft } = /** @type {RobotTaken} */ (told);
  dispatchEvent(new Event("robots"));
  const isNew = answer.status === 201;
  notice(isNew ? say("robots.taken", { title }) : say("robots.replaced", { title }));
  void warn(name);
  await store.putRobot(name);
  if (draft) void showMyRobot(store, name, draft);
  return "";
}

/** Say what of a robot's card is probably not meant. @param {string} name */
async function warn(name) {
  const answer = await fetch(`../api/robots/${name}/warnings`).catch(() => null);
  const warnings = answer?.ok ? /** @type {import("../messages/robot_warnings.js").Warning[]} */ (await answer.json()) : [];
  for (const said of warnings.flatMap(warningInWords)) notice(said, WARNING_MS);
}
