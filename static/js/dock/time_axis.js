/** Where a time axis has its numbers. */

const STEPS_S = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600];
const MOST = 8;

/** @param {number} duration_s @returns {number[]} round times from 0, at most so many */
export function axisTicks(duration_s) {
  if (duration_s <= 0) return [];
  const step = STEPS_S.find((candidate) => duration_s / candidate <= MOST) ?? Math.ceil(duration_s / MOST);
  return Array.from({ length: Math.floor(duration_s / step) + 1 }, (_, index) => index * step);
}
