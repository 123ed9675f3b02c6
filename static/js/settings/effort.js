/** How much work a search may be, as the reader has chosen it in this browser: every document opened here is told. */

const KEY = "pleat-effort";
export const EFFORTS = /** @type {const} */ (["quick", "usual", "thorough"]);

/** The work of each (s on the machine that plans are measured on); null for the server's own. */
const WORK_S = { quick: 3, usual: null, thorough: 60 };

/** @returns {typeof EFFORTS[number]} */
export const effort = () => EFFORTS.find((name) => name === localStorage.getItem(KEY)) ?? "usual";

/** @param {import("../store.js").Store} store @param {typeof EFFORTS[number]} name */
export function keepEffort(store, name) {
  localStorage.setItem(KEY, name);
  tellEffort(store);
}

/** @param {import("../store.js").Store} store */
export const tellEffort = (store) => store.command({ do: "effort", work_s: WORK_S[effort()] });
