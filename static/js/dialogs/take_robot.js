/** A robot of one's own, a zip archive of `robot.json`, its URDF and its meshes: it is saved, and folds from then on. */

import { say } from "../language/say.js";
import { notice } from "../notices.js";
import { OFFLINE, sentenceOf } from "./dialog.js";

/** @import { RobotEntry } from "pleat" */

/**
 * @param {import("../store.js").Store} store
 * @param {File} file
 * @returns {Promise<string>} why it was not taken; nothing if it was
 */
export async function takeRobot(store, file) {
  const headers = { "content-type": "application/zip" };
  const answer = await fetch("../api/robots/imports", { method: "POST", headers, body: file }).catch(() => null);
  const told = answer ? await answer.json() : null;
  if (!answer?.ok) return told ? `${file.name}: ${sentenceOf(told)}` : OFFLINE;
  const { name, title } = /** @type {RobotEntry} */ (told);
  dispatchEvent(new Event("robots"));
  const isNew = answer.status === 201;
  notice(isNew ? say("robots.taken", { title }) : say("robots.replaced", { title }));
  await store.putRobot(name);
  return "";
}
