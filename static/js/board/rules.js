/** The rules of drawing of both editors: written by `make page-rules` from `app/drawing/rules.py`. */

export const REACH_PX = {"close": 12.0, "vertex": 10.0, "dropped": 8.0, "fraction": 9.0, "bisector": 8.0, "edge": 8.0, "guides": 6.0, "guide": 6.0, "grid": 4.0, "line": 4.0};

export const FRACTIONS = [[1, 2], [1, 3], [2, 3], [1, 4], [3, 4]];

export const HANDLE_PX = 12.0;

export const FINGER_PX = 22.0;

export const LEAST_CORNERS = 3;

export const MOST_CORNERS = 400;

export const SAME_CORNER_M = 0.001;

export const STROKE_MIN_M = 0.002;

export const CURVE_TOLERANCE_M = 0.001;

export const CURVE_MAX = 2.0;

export const SIDES = {"along_y": "left over", "against_y": "right over", "along_x": "top down", "against_x": "bottom up"};

export const DRAW_FOLD = "Draw fold";

export const DRAW_OUTLINE = "Draw outline";

export const MOVE_CORNER = "Move vertex";

export const NO_CLOTH = "There is no cloth yet: draw an outline first.";

export const FIRST_IS_RED = "The first fold cannot be red: red takes the flap of the fold before it.";

export const CORNER_TAKEN = "There is a corner already.";

export const TOO_MANY_CORNERS = "An outline has at most 400 corners.";

export const TOO_FEW_CORNERS = "An outline has at least three corners.";
