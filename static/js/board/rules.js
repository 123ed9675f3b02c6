/**
 * Rules of drawing by hand: what a pointer snaps to, when an outline closes, what folds are called, what is refused.
 * Tests hold the numbers and sentences that the server has too against it.
 */

/** How near each kind of target holds a pointer (px), the strongest kind first. */
export const REACH_PX = {"close": 12.0, "vertex": 10.0, "dropped": 8.0, "fraction": 9.0, "bisector": 8.0, "edge": 8.0, "guides": 6.0, "guide": 6.0, "grid": 4.0, "line": 4.0};

/** The fractions of an edge to which a pointer snaps: numerator, denominator. */
export const FRACTIONS = [[1, 2], [1, 3], [2, 3], [1, 4], [3, 4]];

/** How near a mouse grabs a handle (px). */
export const HANDLE_PX = 12.0;

/** How near a finger does. */
export const FINGER_PX = 22.0;

/** The fewest corners with which an outline is closed. */
export const LEAST_CORNERS = 3;

export const MOST_CORNERS = 400;

/** Corners nearer to each other are one (m). */
export const SAME_CORNER_M = 0.001;

/** A shorter line is no fold yet (m). */
export const STROKE_MIN_M = 0.002;

export const CURVE_TOLERANCE_M = 0.001;

export const CURVE_MAX = 2.0;

/** A fold's first name by the direction of its line: the side from which the cloth comes; garment frame, y up. */
export const SIDES = {"along_y": "left side over", "against_y": "right side over", "along_x": "top down", "against_x": "bottom up"};

/** What a garment is called before anybody has named it. */
export const UNTITLED = "Untitled";

export const DRAW_FOLD = "Draw fold";

export const DRAW_OUTLINE = "Draw outline";

export const MOVE_CORNER = "Move vertex";

export const NO_CLOTH = "There is no cloth yet: draw an outline first.";

export const FIRST_IS_RED = "The first fold cannot be red: red takes the flap of the fold before it.";

export const CORNER_TAKEN = "There is a corner already.";

export const TOO_MANY_CORNERS = "An outline has at most 400 corners.";

export const TOO_FEW_CORNERS = "An outline has at least three corners.";
