/** What stands where the plan would be: all the reasons, with their numbers. What would help is over the board. */

import { element } from "../dom.js";
import { say } from "../language/say.js";
import { details, explanation } from "./reasons.js";

/** @import { DocumentState, PlanMessage } from "pleat" */

export class NoPlan {
  constructor() {
    this.all = element("ul", "reasons");
    this.all.setAttribute("aria-label", say("reasons.label"));
    this.brief = element("p", "hint");
    this.root = element("div", "no-plan", this.brief, this.all);
  }

  /**
   * @param {PlanMessage} message without a plan
   * @param {DocumentState} state
   */
  show(message, state) {
    const all = details(message, state);
    this.all.replaceChildren(...all.map((text) => element("li", "", text)));
    this.all.hidden = !all.length;
    this.brief.textContent = all.length ? "" : explanation(message, state);
  }
}
