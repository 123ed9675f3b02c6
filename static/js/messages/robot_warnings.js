/** What of a robot's card is allowed but probably not meant, in words. */

import { say } from "../language/say.js";
import { armTitle } from "./arms.js";
import { length } from "./lengths.js";
import { stand } from "./names.js";

/**
 * @typedef {{code: string, link?: string, size_m?: number, most_m?: number, arm?: string, arms?: string[],
 *   apart_m?: number, left_m?: number, station?: string, mount?: string, beyond_m?: number, beside_m?: number | null}} Warning
 */

/** Fingertips off the tool point by more than these are warned of (m). */
const BEYOND_M = 0.012;
const BEFORE_M = 0.015;
const BESIDE_M = 0.005;

/** @type {Record<string, (warning: Warning) => string[]>} */
const WORDS = {
  part_too_large: ({ link = "", size_m = 0, most_m = 0 }) => [
    say("robot_warning.part_too_large", { link, length: length(size_m), most: length(most_m) }),
  ],
  part_too_small: ({ link = "", size_m = 0 }) => [
    say("robot_warning.part_too_small", { link, length: length(size_m) }),
  ],
  arms_together: ({ arms: [one, other] = [], apart_m = 0 }) => [
    say("robot_warning.arms_together", { one, other, length: length(apart_m) }),
  ],
  arms_crossed: ({ arms: [one, other] = [], left_m = 0 }) => [
    say("robot_warning.arms_crossed", { one, other, length: length(left_m) }),
  ],
  station_faces_away: ({ station = "" }) => [say("robot_warning.station_faces_away", { station: stand(station) })],
  mount_faces_away: ({ mount = "" }) => [
    mount ? say("robot_warning.mount_faces_away", { mount }) : say("robot_warning.arms_face_away"),
  ],
  station_in_table: ({ station = "" }) => [say("robot_warning.station_in_table", { station: stand(station) })],
  tool_off_tips: ({ arm = "", beyond_m = 0, beside_m = 0 }) => {
    const said = [];
    if (beyond_m > BEYOND_M) said.push(say("robot_warning.tool_beyond", { arm: armTitle(arm), length: length(beyond_m) }));
    if (beyond_m < -BEFORE_M) said.push(say("robot_warning.tool_before", { arm: armTitle(arm), length: length(-beyond_m) }));
    const beside = Math.abs(beside_m ?? 0);
    if (beside > BESIDE_M) said.push(say("robot_warning.tool_beside", { arm: armTitle(arm), length: length(beside) }));
    return said;
  },
};

/** The sentences for a warning; none for one of a newer server. @param {Warning} warning */
export const warningInWords = (warning) => WORDS[warning.code]?.(warning) ?? [];
