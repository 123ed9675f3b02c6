/**
 * A card in the 3D view's corner, on a phone below what is said of the rehearsal: at the time that is shown, the cloth
 * from above beside its plan, and what the robot's camera saw last. From there can be planned.
 */

import { boxOf } from "../board/geometry.js";
import { path } from "../board/sheet.js";
import { openDialog } from "../dialogs/dialog.js";
import { button, byId, element, svg } from "../dom.js";
import { icon } from "../icons.js";
import { say } from "../language/say.js";
import { inWords } from "../messages/in_words.js";
import { length } from "../messages/lengths.js";
import { PHONE } from "../phone.js";
import { present } from "../present.js";
import { inAWord } from "./words.js";

/** @import { Look, Point, TraceStep } from "pleat" */

const INSTANT_S = 1e-3;
/** On a lower 3D view the pictures are folded away until they are asked for (px). */
const OPEN_FROM_PX = 320;

export class RehearsalCard {
  /**
   * @param {import("../store.js").Store} store
   * @param {import("../dock/clock.js").Clock} clock
   * @param {import("./rehearsal.js").Rehearsal} rehearsal
   * @param {HTMLElement} box where it stands on a phone
   */
  constructor(store, clock, rehearsal, box) {
    this.store = store;
    this.clock = clock;
    this.rehearsal = rehearsal;
    /** What is shown. */
    this.shown = "";
    /** Whether somebody chose to see the pictures, or not to; null before. @type {boolean|null} */
    this.chosen = null;
    this.fold = button("rehearsal-fold", () => this.toggle(), element("span", "", say("rehearsal.pictures")), icon("back"));
    this.pictures = element("div", "rehearsal-pictures");
    this.root = element("section", "rehearsal-card", this.fold, this.pictures);
    this.root.setAttribute("aria-label", say("rehearsal.pictures"));
    this.phone = matchMedia(PHONE);
    const stand = () => {
      (this.phone.matches ? box : byId("view3d-pane")).append(this.root);
      this.draw();
    };
    this.phone.addEventListener("change", stand);
    addEventListener("resize", () => this.draw());
    stand();
    rehearsal.addEventListener("change", () => this.show());
    clock.addEventListener("tick", () => this.show());
    addEventListener("unit", () => this.draw());
    this.show();
  }

  toggle() {
    this.chosen = !this.isOpen;
    this.draw();
  }

  get isOpen() {
    return this.chosen ?? (this.phone.matches || byId("view3d-pane").clientHeight >= OPEN_FROM_PX);
  }

  get steps() {
    const { plan } = this.store.plan ?? {};
    return plan?.id === this.rehearsal.plan ? (plan?.primitives ?? []) : [];
  }

  /** What was judged last at the time that is shown. @returns {TraceStep|null} */
  get step() {
    const now = this.clock.now + INSTANT_S;
    const done = (this.rehearsal.trace?.steps ?? []).filter(({ of_plan: index }) => {
      const step = this.steps[index];
      return step && step.start_s + step.duration_s <= now;
    });
    return done.at(-1) ?? null;
  }

  /** What was seen last at that time. @returns {Look|null} */
  get look() {
    const now = this.clock.now + INSTANT_S;
    const looks = (this.rehearsal.trace?.pictures ?? []).filter(({ of_plan: index }) => this.steps[index ?? -1]);
    return looks.findLast(({ of_plan: index }) => this.steps[index ?? 0].start_s <= now) ?? looks[0] ?? null;
  }

  show() {
    const { step, look, rehearsal } = this;
    const all = rehearsal.trace?.pictures ?? [];
    const wanted = rehearsal.trace ? JSON.stringify([rehearsal.run?.trace, step?.of_plan, look && all.indexOf(look)]) : "";
    if (wanted === this.shown) return;
    this.shown = wanted;
    this.draw();
  }

  draw() {
    const { step, look } = this;
    this.root.hidden = !step && !look;
    this.pictures.hidden = !this.isOpen;
    this.fold.setAttribute("aria-expanded", String(this.isOpen));
    this.fold.setAttribute("aria-label", this.isOpen ? say("rehearsal.hide_pictures") : say("rehearsal.show_pictures"));
    this.fold.title = this.fold.getAttribute("aria-label") ?? "";
    this.pictures.replaceChildren(...present([step && this.outlines(step), look && this.seen(look)]));
  }

  /** @param {TraceStep} step */
  outlines(step) {
    const verdict = this.rehearsal.verdicts.get(step.of_plan);
    const told = verdict ? say("rehearsal.after", { step: step.of_plan + 1, verdict: inAWord(verdict) }) : "";
    const larger = () => openDialog(told, "rehearsal-large", outlinesPicture(step), legend());
    return figure(told, outlinesPicture(step), larger, legend());
  }

  /** @param {Look} look */
  seen(look) {
    const told = say("rehearsal.seen", { step: (look.of_plan ?? 0) + 1 });
    const larger = () => openDialog(told, "rehearsal-large", lookPicture(look, true), element("p", "hint", about(look)));
    const { start } = look;
    const plan = button("chip", () => start && this.store.command({ do: "plan_from_state", start }), say("rehearsal.plan_from_seen"));
    plan.title = start ? say("rehearsal.plan_from_seen_hint") : about(look);
    plan.disabled = !start;
    return figure(told, lookPicture(look, false), larger, element("p", "hint", about(look)), plan);
  }
}

/** What the outlines in the picture are, or why it is not known where the cloth lies. @param {Look} look */
function about({ known, says, reason, fit }) {
  if (known && fit) return say("rehearsal.known", { error: length(fit.error_m) });
  return say("rehearsal.not_known", { why: inWords({ says, message: reason ?? "" }, []) });
}

/** @param {string} told @param {SVGElement} picture @param {() => void} larger @param {...Node} below */
function figure(told, picture, larger, ...below) {
  const seen = button("rehearsal-picture", larger, picture);
  seen.title = say("rehearsal.larger");
  seen.setAttribute("aria-label", `${told}: ${say("rehearsal.larger")}`);
  return element("figure", "", element("figcaption", "", told), seen, ...below);
}

function legend() {
  const parts = /** @type {const} */ (["planned", "simulated", "difference"]);
  const entries = parts.map((part) =>
    element("span", "", element("span", `rehearsal-swatch is-${part}`), say(`rehearsal.${part}`)),
  );
  return element("p", "rehearsal-legend hint", ...entries);
}

/** Millimetres are the picture's units: its stripes have a width then. */
const MM = 1000;
const STRIPE_MM = 14;
const ROUND_MM = 30;
/** How much larger than the outline a cut of the camera's picture is. */
const CUT = 1.7;

/** A point of the table's frame (m), whose y is up, in the picture. @param {Point} at @returns {Point} */
const up = ([x, y]) => [MM * x, -MM * y];

/** @param {Point[][]} rings @returns {string} */
const outline = (rings) => rings.map((ring) => path(ring.map(up))).join("");

/** The cloth after a step: as planned, as simulated over it, and what only one of them covers striped. @param {TraceStep} step */
function outlinesPicture({ found, planned }) {
  const box = boxOf([...found, ...planned].flat().map(up));
  const { low, high } = box ?? { low: [0, 0], high: [1, 1] };
  const [wide, tall] = [high[0] - low[0] + 2 * ROUND_MM, high[1] - low[1] + 2 * ROUND_MM];
  const viewBox = `${low[0] - ROUND_MM} ${low[1] - ROUND_MM} ${wide} ${tall}`;
  const made = svg("svg", { class: "rehearsed", viewBox, "aria-hidden": "true" });
  const stripes = svg("pattern", {
    id: "hatch-difference",
    width: STRIPE_MM,
    height: STRIPE_MM,
    patternUnits: "userSpaceOnUse",
    patternTransform: "rotate(45)",
  });
  stripes.append(svg("path", { class: "hatch-difference", d: `M0 0V${STRIPE_MM}` }));
  const defs = svg("defs");
  defs.append(stripes);
  made.append(
    defs,
    svg("path", { class: "rehearsed-planned", d: outline(planned) }),
    svg("path", { class: "rehearsed-found", d: outline(found) }),
    svg("path", { class: "rehearsed-difference", d: outline([...planned, ...found]) }),
  );
  return made;
}

/** What the camera saw, with where the stack ought to lie dashed and what was fitted. @param {Look} look @param {boolean} isWhole */
function lookPicture({ jpeg, size_px: [width, height], fitted_px: fitted, expected_px: expected }, isWhole) {
  const viewBox = isWhole ? `0 0 ${width} ${height}` : cut([...fitted, ...expected], width, height);
  const made = svg("svg", { class: "looked", viewBox, "aria-hidden": "true" });
  made.append(svg("image", { href: `data:image/jpeg;base64,${jpeg}`, width, height }));
  for (const [name, ring] of /** @type {[string, Point[]][]} */ ([["expected", expected], ["fitted", fitted]])) {
    for (const layer of ring.length ? ["under", "over"] : [])
      made.append(svg("path", { class: `looked-${name} is-${layer}`, d: path(ring) }));
  }
  return made;
}

/** The part of a picture round some points, of its shape. @param {Point[]} points @param {number} width @param {number} height */
function cut(points, width, height) {
  const box = boxOf(points);
  if (!box) return `0 0 ${width} ${height}`;
  const { low, high } = box;
  const share = Math.min(1, CUT * Math.max((high[0] - low[0]) / width, (high[1] - low[1]) / height));
  /** @param {number} middle @param {number} size */
  const begin = (middle, size) => Math.min(Math.max(middle - (share * size) / 2, 0), size - share * size);
  const [x, y] = [begin((low[0] + high[0]) / 2, width), begin((low[1] + high[1]) / 2, height)];
  return `${x} ${y} ${share * width} ${share * height}`;
}
