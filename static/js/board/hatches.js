/** Stripes at 45 degrees: on the backs of cloth, and where cloth will land; the other way where a hand cannot go
 * or no table is. */

import { svg } from "./sheet.js";

const WIDTH_PX = 7;

/** @returns {SVGElement} */
export function hatches() {
  const defs = svg("defs");
  for (const [name, turn_deg] of Object.entries({ back: 45, ghost: 45, beyond: -45 })) {
    const pattern = svg("pattern", {
      id: `hatch-${name}`,
      width: WIDTH_PX,
      height: WIDTH_PX,
      patternUnits: "userSpaceOnUse",
      patternTransform: `rotate(${turn_deg})`,
    });
    pattern.append(svg("path", { class: `hatch-${name}`, d: `M0 0V${WIDTH_PX}` }));
    defs.append(pattern);
  }
  return defs;
}
