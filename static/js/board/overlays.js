/** "See why": asks the server for what is switched on, at the moment that is looked at. */

import { RefusedError } from "../live.js";
import { present } from "../present.js";
import { drawOver, drawUnder } from "./draw_overlays.js";
import { reasonWithPlace } from "./draw_reason.js";

/** @import { Command, Overlays as Found, Places } from "pleat" */

/** What the server's overlays are made of; grips come with the plan. */
const PARTS = ["reach", "slip", "base", "paths"];
const SHORTFALL = "shortfall";
const EVERY_MS = 200;
/** A server that is too busy, or away, is asked again after this. */
const AGAIN_MS = 1000;
const BUSY = [429, 503];

/** The work that the cost map may take, and so much time that mostly the work ends it. @type {Command} */
const MAPPED = { do: "places", work_limit_s: 6, time_limit_s: 60 };

export class Overlays {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    /** @type {Found|null} */
    this.found = null;
    /** @type {Places|null} */
    this.places = null;
    this.asked = "";
    this.askedPlaces = "";
    /** @type {string[]} what `found` was asked for */
    this.known = [];
    this.isMapping = false;
    /** The map that was made last, and for which version and start. @type {{key: string, places: Places|null}} */
    this.mapped = { key: "", places: null };
    /** @type {import("./sheet.js").Item[]} what was drawn last beneath the cloth */
    this.beneath = [];
    /** @type {import("./sheet.js").Item[]} and above it */
    this.above = [];
    this.stopPlaces = new AbortController();
    const { store } = board;
    for (const name of ["overlays", "plan", "playback", "hover-time", "document"])
      store.addEventListener(name, () => this.look());
  }

  /** What is switched on. */
  get shown() {
    return PARTS.filter((name) => this.board.store.overlays.has(name));
  }

  /** That, and the reach that belongs to the reason why there is no plan. */
  get wanted() {
    return reasonWithPlace(this.board.store)?.towards ? [...this.shown, SHORTFALL] : this.shown;
  }

  /** Ask soon, unless all is known already. */
  look() {
    this.lookForPlaces();
    if (!this.wanted.length) this.forget();
    if (!this.wanted.includes("base")) this.board.framing.showAlso(null);
    const isKnown = !this.wanted.length || this.query === this.asked;
    if (!isKnown && this.timer === undefined) this.timer = setTimeout(() => this.ask(), this.found ? EVERY_MS : 0);
    this.tellPending();
  }

  /** What is asked for now. @returns {Command} */
  get question() {
    const { store, isPlacing, drawing } = this.board;
    const show = this.wanted.join(",");
    if (isPlacing) return { do: "overlays", station: drawing.start_station, show };
    return { do: "overlays", t_s: Number((store.hoverTime ?? store.playback?.t_s ?? 0).toFixed(2)), show };
  }

  /** The same again has the same answer. */
  get query() {
    const { state, plan } = this.board.store;
    return `${JSON.stringify(this.question)}#${state?.version}:${plan?.plan?.version}`;
  }

  async ask() {
    const [query, names] = [this.query, this.wanted];
    this.asked = query;
    const isWanted = () => this.wanted.length > 0 && this.query === query;
    const found = /** @type {Found|null} */ (await told(this.board.store, this.question, isWanted));
    this.timer = undefined;
    this.found = found;
    this.known = found ? names : [];
    const way = found?.base && names.includes("base") ? [...found.base.way, ...found.robot.outline] : null;
    if (way) this.board.framing.showAlso(way);
    this.board.render();
    this.look();
  }

  /** What is switched on later is asked for anew, also where it is what was asked for last. */
  forget() {
    this.asked = "";
    this.found = null;
    this.known = [];
  }

  /** Say what is switched on and not there yet. */
  tellPending() {
    const isAsking = this.timer !== undefined;
    const parts = isAsking ? this.shown.filter((name) => !this.known.includes(name)) : [];
    this.board.store.setPending(this.isMapping ? [...parts, "places"] : parts);
  }

  async lookForPlaces() {
    const { store } = this.board;
    const state = store.overlays.has("places") ? store.state : null;
    const key = state ? `${state.version}#${JSON.stringify(startOf(store))}` : "";
    if (key === this.askedPlaces) return;
    this.askedPlaces = key;
    this.places = null;
    this.isMapping = false;
    this.stopPlaces.abort();
    if (!state || state.gesture) return;
    if (key === this.mapped.key) {
      this.places = this.mapped.places;
      this.board.render();
      return;
    }
    this.stopPlaces = new AbortController();
    const { signal } = this.stopPlaces;
    this.isMapping = true;
    const isWanted = () => key === this.askedPlaces;
    const places = /** @type {Places|null} */ (await told(store, MAPPED, isWanted, signal));
    if (key !== this.askedPlaces) return;
    this.places = places;
    this.isMapping = false;
    if (places) this.mapped = { key, places };
    this.tellPending();
    this.board.render();
  }

  under() {
    this.beneath = present(drawUnder(this.board, this.shown.length ? this.found : null, this.places));
    return this.beneath;
  }

  over() {
    this.above = present(drawOver(this.board, this.shown.length ? this.found : null));
    return this.above;
  }

  /** All that was drawn last. */
  get drawn() {
    return [...this.beneath, ...this.above];
  }
}

/**
 * The state of the world from which the drawing is planned; null for its own start.
 * @param {import("../store.js").Store} store
 */
const startOf = ({ plan, state }) => (plan && plan.version === state?.version ? plan.start : null);

/**
 * What the server answers; null where it has no answer, or none before it is no longer waited for.
 * @param {import("../store.js").Store} store
 * @param {Command} question
 * @param {() => boolean} isWanted whether a server that is too busy is asked again
 * @param {AbortSignal} [signal]
 */
async function told(store, question, isWanted, signal) {
  for (;;) {
    try {
      return (await store.ask(question, signal)).result;
    } catch (error) {
      if (error instanceof RefusedError && !BUSY.includes(error.problem.status)) return null;
    }
    await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
    if (!isWanted()) return null;
  }
}
