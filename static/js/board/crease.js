/** Asks the server where a fold would be; while the hand moves, again and again, of which only the newest counts. */

import { sayable } from "../dom.js";
import { say } from "../language/say.js";
import { RefusedError } from "../live.js";
import { inWords } from "../messages/in_words.js";
import { lineOf } from "./stroke.js";

/** @import { Command, Crease, Fold, FoldKind, Point, Problem } from "pleat" */

const EVERY_MS = 80;

/** @typedef {{isGrab: boolean, from: Point, to: Point}} Stroke */
/** @typedef {{ok: true, told: Crease}|{ok: false, told: {detail: string}}} Answer */

export class CreaseQuestion {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.turn = 0;
    this.isAsking = false;
    /** @type {{stroke: Stroke, tell: (answer: Answer) => void}|null} */
    this.wanted = null;
  }

  /** @param {Stroke} stroke @param {(answer: Answer) => void} tell */
  ask(stroke, tell) {
    this.wanted = { stroke: { ...stroke }, tell };
    if (!this.isAsking) this.work();
  }

  async work() {
    this.isAsking = true;
    const turn = this.turn;
    while (this.wanted && turn === this.turn) {
      const { stroke, tell } = this.wanted;
      this.wanted = null;
      const began = performance.now();
      const answer = await this.answer(stroke);
      if (turn === this.turn) tell(answer);
      await new Promise((resolve) => setTimeout(resolve, Math.max(EVERY_MS - (performance.now() - began), 0)));
    }
    this.isAsking = false;
    if (this.wanted) this.work();
  }

  forget() {
    this.turn += 1;
    this.wanted = null;
  }

  /** @param {Stroke} stroke @returns {Promise<Answer>} */
  async answer(stroke) {
    const { step, rings } = this.board;
    const { isFlipped, kind } = this.board.paint;
    const { isGrab, from, to } = stroke;
    const [along, until] = lineOf(stroke, rings, isFlipped);
    const wanted = isGrab ? { grab: { from, to } } : { line: { start: along, end: until } };
    const answer = await this.post({ after: step, kind, ...wanted });
    if (!isGrab || !isFlipped || !answer.ok) return answer;
    const { start, end } = answer.told;
    return this.post({ after: step, kind, line: { start: end.point, end: start.point } });
  }

  /**
   * @param {{after: number, kind: FoldKind, grab?: {from: Point, to: Point}, line?: {start: Point, end: Point}}} body
   * @returns {Promise<Answer>}
   */
  async post(body) {
    try {
      const { result } = await this.board.store.ask(/** @type {Command} */ ({ do: "crease", ...body }));
      return { ok: true, told: /** @type {Crease} */ (result) };
    } catch (error) {
      if (!(error instanceof RefusedError)) return { ok: false, told: { detail: sayable(error) } };
      return { ok: false, told: { detail: sentence(error.problem, this.board.drawing.folds) } };
    }
  }
}

/** @param {Problem} problem @param {Fold[]} folds */
function sentence({ errors, detail }, folds) {
  return say("crease.none", { why: inWords(errors?.[0] ?? { message: detail }, folds) });
}
