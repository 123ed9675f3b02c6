"""A message of every code that Pleat sends, as JSON, and the codes that are found in its sources."""

import ast
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
FOLDS = [{"name": ""}, {"name": "edge 3, 5 cm from mum's hem"}]
HEM = "\u201cedge 3, 5 cm from mum's hem\u201d"
REACH: dict[str, Any] = {
    "code": "out_of_reach",
    "arm": "left",
    "at": [-0.5, 0.25, -0.05],
    "moment": "top",
    "demand": "driving",
    "cause": "too_far",
    "joint": "shoulder pan",
    "towards": [0.0, 0.0, -1.0],
    "short_by_m": 0.04,
    "is_at_least": False,
    "comfort_m": None,
    "wanted_comfort_m": 0.03,
    "station": "front_right",
    "back_off_m": 0.2,
    "dragged": [-0.1, 0.0],
    "is_held": True,
    "shift_m": 0.05,
    "shift_towards": [-1.0, 0.0, 0.0],
    "movable": ["cloth", "station"],
    "enough_comfort_m": None,
    "enough_cone_rad": None,
    "tried_m": 0.2,
}
LOOSE = {"code": "hangs_loose", "layer": 0, "edge": "near", "at": [0.1, -0.2], "beyond_m": 0.05}
RADII = {"grip_radius_m": 0.127, "needed_grip_radius_m": 0.1502}
COLLISION = {"station": "front_left", "drag": [-0.1, 0.05], "dragged": [0.0, 0.0], "is_held": False}
FOLDED: dict[str, Any] = {"label": "folded width", "value_m": 0.7, "than_m": 0.666}
MESSAGES: list[dict[str, Any]] = [
    {"code": "outline_points", "points": 401, "most": 400},
    {"code": "outline_area", "area_m2": 0.00005, "least_m2": 0.0001},
    {"code": "curves_replaced", "corners": 40, "off_m": 0.002},
    {"code": "corners_left_out", "corners": 40, "off_m": 0.002},
    {"code": "unit_taken", "unit_m": 0.01, "is_said": True, "size": [0.6, 0.4]},
    {"code": "lines_cut", "lines": [{"fold": 0, "by_m": 0.015}, {"fold": 1, "by_m": 0.02}]},
    {"code": "line_does_not_fit", "fold": 0, "message": "RUBBISH", "says": {"code": "would_tear", "along_m": 0.1}},
    {
        "code": "not_finished",
        "message": "RUBBISH",
        "says": {"code": "edges_cross", "edges": [0, 2], "at": [0.25, 0.25]},
    },
    {"code": "no_plan", "fold": 0, "message": "RUBBISH", "says": {"code": "beside_table", "off_m": 0.2}},
    {"code": "garment_of_plan", "folds_done": 0},
    {"code": "garment_of_plan", "folds_done": 2},
    {"code": "short_lines", "shorter_m": 0.001, "lines": 3},
    {"code": "unit_unlikely", "unit_m": 0.000001, "longest_m": 0.0004},
    {"code": "unit_out_of_range", "unit_m": 4000.0},
    {"code": "drawing_too_large", "what": "the outline", "size": [60.0, 40.0], "most_m": 10.0},
    {"code": "outline_too_large", "far_m": 12.5, "most_m": 10.0},
    {"code": "measure_out_of_range", "label": "width", "value_m": 12.0, "least_m": 0.001, "most_m": 10.0},
    {"code": "measure_not_less", **FOLDED, "what": "the width less {}", "by_m": 0.02},
    {"code": "measure_too_small", **FOLDED, "what": "a third of the width", "by_m": 0.0},
    {"code": "edge_too_short", "edge": 3, "from": 3, "to": 0, "length_m": 0.000012, "least_m": 0.001},
    {"code": "edges_cross", "edges": [0, 2], "at": [0.25, 0.25]},
    {"code": "line_too_short", "length_m": 0.0005, "least_m": 0.001},
    {"code": "end_off_boundary", "at": [0.42, 0.75], "off_m": 0.1047, "most_m": 0.005},
    {"code": "would_tear", "along_m": 0.0123},
    {"code": "unknown_station", "station": "far_left", "stations": ["front", "front_left"]},
    {"code": "dropped_too_near", "apart_m": 0.0005, "least_m": 0.001},
    {"code": "not_on_flap", "at": [0.1, 0.2]},
    {"code": "no_cloth_there", "at": [0.1, 0.2]},
    {"code": "line_misses_cloth"},
    {"code": "fewer_folds", "asked": 3, "legal": 1},
    {"code": "folds_full", "most": 64},
    REACH,
    {**REACH, "cause": "comfort_only", "comfort_m": 0.0151, "joint": None, "movable": None},
    {**REACH, "movable": ["torso"], "shift_towards": [0.0, 0.0, -1.0]},
    {**REACH, "movable": None, "enough_comfort_m": 0.0151},
    {**REACH, "movable": None, "enough_comfort_m": 0.0151, "is_enough": False},
    {**REACH, "movable": None, "enough_cone_rad": 1.8326, "is_enough": False},
    {**REACH, "movable": None, "enough_cone_rad": 1.8326},
    {**REACH, "movable": [], "shift_m": None, "shift_towards": None},
    {**REACH, "movable": [], "is_at_least": True, "moment": "pick", "dragged": [0.0, 0.0], "is_held": False},
    {"code": "too_many_grips", "points": [[0.42, 0.75], [0.6, 0.4], [0.6, 0.0]], "hands": 2, **RADII},
    {"code": "grips_too_close", "points": [[0.0, 0.1], [0.0, 0.18]], "apart_m": 0.08, "needed_apart_m": 0.1, **RADII},
    {"code": "red_unheld", "at": [0.2, 0.2], "before": 0},
    {"code": "red_held_too_far", "at": [0.2, 0.2], "before": 1, **RADII},
    {"code": "arms_cannot_get_there", **COLLISION},
    {
        "code": "collision",
        **COLLISION,
        "arm": "left",
        "at": [-0.45, 0.15, -0.05],
        "parts": ["left forearm", "table top"],
        "depth_m": 0.031,
    },
    {"code": "line_off_table", "off_m": 0.1, "dragged": [0.0, 0.0], "is_held": False},
    {"code": "behind_line", "behind_m": 0.1, "dragged": [0.0, 0.0], "is_held": False},
    {"code": "at_start", "what": LOOSE, "is_too_large": False, "dragged": [0.0, 0.0], "is_held": False},
    {"code": "afterwards", "what": LOOSE, "dragged": [-0.1, 0.2], "is_held": False},
    {"code": "beside_table", "off_m": 0.2},
    {"code": "beside_table", "off_m": 0.0},
    {"code": "corner_covered", "corner": [-0.8, 0.49], "depth_m": 0.05},
    {"code": "hangs_from_several", "area_m2": 0.0123, "edges": ["right", "near"]},
    LOOSE,
    {"code": "slips", "hanging_m2": {"near": 0.08}, "lying_m2": 0.04, "friction": 1.0, "needed_friction": 2.0},
    {"code": "waits_for", "folds": [0, 1]},
    {"code": "not_with_the_others"},
    {"code": "place", "quarters": 1, "by": [-0.08, 0.05]},
    {"code": "shift_fold", "fold": 1, "by_m": 0.0125, "towards": [0.0, 1.0]},
    {
        "code": "shift_folds",
        "shifts": [{"fold": fold, "by_m": 0.025, "towards": [1.0, 0.0]} for fold in (0, 1)],
    },
    {"code": "slips_on_the_way", "friction": 0.0, "needed_friction": 0.2},
    {"code": "wider_grip", "grip_radius_m": 0.02, "needed_grip_radius_m": 0.0301, "in_drags": False},
    {"code": "wider_grip", "grip_radius_m": 0.02, "needed_grip_radius_m": 0.0301, "in_drags": True},
    {"code": "stiffer_cloth", "support_angle_rad": 0.0873, "needed_support_angle_rad": 0.5236},
    {"code": "one_more_hand", "hands": 2},
    {"code": "split_fold", "fold": 1, "depth_m": 0.175},
    {"code": "halve_first", "fold": 0},
    {"code": "flip_fold", "fold": 1},
    {"code": "fold_before", "fold": 1, "before": 0},
    {"code": "fold_in_order", "folds": [1, 0]},
    {"code": "stand_also_at", "station": "middle_left", "at": [0.0, 400.0]},
    {"code": "other_robot", "robot": "ur5e-pair", "title": "Two UR5e"},
    {"code": "assume_comfort", "comfort_m": 0.01, "now_m": 0.03},
    {"code": "assume_friction", "friction": 1.5, "now": 1.0},
    {"code": "assume_grip_radius", "grip_radius_m": 0.15, "folds": [0, 1]},
    {
        "code": "assume_together",
        "parts": [
            {"code": "assume_friction", "friction": 0.11, "now": 0.0},
            {"code": "assume_comfort", "comfort_m": 0.01, "now_m": 0.03},
        ],
    },
    {"code": "make_blue", "fold": 1},
    {"code": "put_onto_cloth", "fold": 0},
    {"code": "put_onto_flap", "fold": 0},
    {"code": "delete_fold", "fold": 0},
    {"code": "merge_two"},
    {"code": "merge_near", "nearer_m": 0.001},
    {"code": "exchange_two"},
    {"code": "smaller", "by": 0.35, "size_m": [0.6, 0.4]},
    {"code": "straighten"},
    {"code": "uncross"},
    {"code": "delete_corner"},
    {"code": "start_at", "station": "front_left"},
    {"code": "take_back", "step": "Move vertex"},
    {"code": "corners_seen", "corners": 10},
    {"code": "seam_allowance", "line": "seam", "width_m": 0.01},
    {"code": "seam_allowance", "line": "cut", "width_m": 0.01},
    {"code": "made_symmetric", "off_m": 0.0021},
    {"code": "edges_do_not_fit", "share": 0.8, "within_m": 0.01},
    {"code": "likeness_does_not_fit", "share": 0.7, "within_m": 0.01},
    {"code": "states_alike", "states": 2},
    {"code": "cut_off", "share": 0.1},
    {"code": "ways_disagree", "agreement": 0.5, "least": 0.8},
    {"code": "faint_edge", "contrast": 2.5},
    {"code": "size_uncertain", "share": 0.12},
    {"code": "scale_needed"},
    {"code": "picture_size", "size": [20, 30], "sides": [160, 12000], "most": 50000000},
    {"code": "seen_does_not_fit", "share": 0.4, "residual_m": 0.02},
    {"code": "too_little_seen", "share": 0.3},
    {"code": "too_uncertain", "error_m": 0.03},
    {"code": "looks_alike", "placements": 2},
    {"code": "outline_hidden"},
    {"code": "no_cloth_seen"},
    {"code": "physics_missing"},
]


def codes_in(*folders: str, made_by: tuple[str, ...] = ("Message", "worded")) -> set[str]:
    """Return the code of every message made in some folders of Python; of a code that is composed, its beginning."""
    found: set[str] = set()
    for path in (path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in made_by:
                code = node.args[0]
                if isinstance(code, ast.JoinedStr):
                    code = code.values[0]
                if isinstance(code, ast.Constant) and code.value:
                    found.add(str(code.value))
    return found
