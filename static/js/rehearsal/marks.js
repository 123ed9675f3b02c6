/** A lane below those of base and arms: what became of each step of the plan in the rehearsal. */

import { button, element, group } from "../dom.js";
import { say } from "../language/say.js";
import { fateOf, inAWord } from "./words.js";

/** @import { Plan } from "pleat" */
/** @import { Verdict } from "./rehearsal.js" */

export class Marks {
  /** @param {(t_s: number) => void} onSeek */
  constructor(onSeek) {
    this.onSeek = onSeek;
    this.name = element("span", "lane-name", element("b", "arm", "\u2713"), element("span", "", say("rehearsal.lane")));
    this.lane = element("div", "lane marks");
    group(this.lane, say("rehearsal.lane"));
    this.show(null, new Map());
  }

  /** @param {Plan|null} plan @param {Map<number, Verdict>} verdicts by step of the plan */
  show(plan, verdicts) {
    this.name.hidden = this.lane.hidden = !plan || !verdicts.size;
    const judged = [...verdicts.keys()].filter((step) => plan?.primitives[step]).sort((a, b) => a - b);
    /** @param {number} step */
    const end = (step) => (plan ? plan.primitives[step].start_s + plan.primitives[step].duration_s : 0);
    const whole = plan?.cost_s ?? 0;
    const made = judged.map((step, index) => {
      const verdict = /** @type {Verdict} */ (verdicts.get(step));
      return mark(step, verdict, index ? end(judged[index - 1]) : 0, end(step), whole, this.onSeek);
    });
    this.lane.replaceChildren(...made);
  }
}

/**
 * @param {number} step
 * @param {Verdict} verdict
 * @param {number} from_s
 * @param {number} to_s
 * @param {number} whole_s
 * @param {(t_s: number) => void} onSeek
 */
function mark(step, verdict, from_s, to_s, whole_s, onSeek) {
  const made = button("mark", () => onSeek(to_s), element("span", "", inAWord(verdict)));
  made.addEventListener("pointerdown", (event) => event.stopPropagation()); // the lanes would go to where it is pressed
  made.dataset.fate = fateOf(verdict);
  made.style.left = `${(100 * from_s) / whole_s}%`;
  made.style.width = `${(100 * (to_s - from_s)) / whole_s}%`;
  made.title = say("rehearsal.after", { step: step + 1, verdict: inAWord(verdict) });
  made.setAttribute("aria-label", made.title);
  return made;
}
