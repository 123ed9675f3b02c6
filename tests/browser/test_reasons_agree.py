"""Strip, board and panel tell a reason with the same amounts."""

import re
from typing import Any

import pytest
from playwright.sync_api import Page

from tests.messages import FOLDS, RADII, REACH

REASON: dict[str, Any] = {"fold": 0, "message": "so it is", "set": 0, "arm": "left", "station": "front_right"}
SHORT = {"code": "out_of_reach", "point": [-0.5, 0.25, 0.2], "towards": [-1.0, 0.0, 0.0], "is_at_least": False}
LACK = {**REACH, "at": [-0.5, 0.25, 0.2], "dragged": [-0.4, 0.1], "short_by_m": 0.1, "towards": [-1.0, 0.0, 0.0]}
PLACED = {**REASON, **SHORT, "short_by_m": 0.1, "offset_m": [-0.4, 0.1], "cause": "too_far", "joint": None}
COLLISION = {"code": "collision", "drag": [-0.1, 0.0], "dragged": [0.0, 0.0], "is_held": False, "depth_m": 0.012}
TOUCHED = {"station": "front_right", "arm": "left", "at": [-0.5, 0.25, 0.2], "parts": ["left palm", "table"]}
REASONS: dict[str, dict[str, Any]] = {
    "short": {**PLACED, "says": LACK},
    "short at least": {**PLACED, "is_at_least": True, "says": {**LACK, "is_at_least": True}},
    "too low": {**PLACED, "towards": [0.0, 0.0, 1.0], "says": {**LACK, "towards": [0.0, 0.0, 1.0]}},
    "without margin": {
        **PLACED,
        "cause": "comfort_only",
        "says": {**LACK, "cause": "comfort_only", "comfort_m": 0.021},
    },
    "collision in a drag": {
        **PLACED,
        "code": "collision",
        "towards": None,
        "offset_m": [-0.0412, 0.0],
        "says": {**COLLISION, **TOUCHED},
    },
    "turned about an edge off the table": {
        **REASON,
        "code": "line_off_table",
        "short_by_m": 0.1234,
        "offset_m": [-0.4, 0.1],
        "says": {"code": "turn_off_table", "off_m": 0.1234, "dragged": [-0.4, 0.1], "is_held": False},
    },
    "behind the line": {
        **REASON,
        "code": "not_a_g_state",
        "short_by_m": 0.1234,
        "offset_m": [-0.4, 0.1],
        "says": {"code": "behind_line", "behind_m": 0.1234, "dragged": [-0.4, 0.1], "is_held": False},
    },
    "slips": {
        **REASON,
        "code": "slips",
        "needed_friction": 0.2 + 0.1,
        "says": {"code": "slips_on_the_way", "friction": 0.1, "needed_friction": 0.2 + 0.1},
    },
    "too few hands": {
        **REASON,
        "code": "too_many_grips",
        "needed_grip_radius_m": RADII["needed_grip_radius_m"],
        "says": {"code": "wider_grip", **RADII, "in_drags": False},
    },
}


def told(modules: Page, reason: dict[str, Any], unit: str) -> tuple[str, str, str]:
    """Return what strip, board and panel say."""
    strip, board, panel = modules.evaluate(
        """async ([reason, folds, name]) => {
          const { unit } = await import("/static/js/board/units.js");
          const { details, explanation } = await import("/static/js/dock/reasons.js");
          const { drawReason } = await import("/static/js/board/draw_reason.js");
          unit.name = name;
          const plan = { status: "infeasible", plan: { reasons: [reason], is_stale: false } };
          const drawing = { folds, placement: { x_m: 0, y_m: 0, yaw_rad: 0 } };
          const view = { toPx: ([x, y]) => [400 + 400 * x, 400 - 400 * y], width: 800, height: 800, scale: 400 };
          const board = { draft: null, drawing, view, store: { plan }, overlays: {} };
          const items = reason.point ? drawReason(board).flatMap(({ text }) => text ?? []) : [];
          const state = { drawing, problems: [] };
          return [explanation(plan, state), items.join("; "), details(plan, state).join(" ")];
        }""",
        [reason, FOLDS, unit],
    )
    return strip, board, panel


def amounts(words: str) -> set[str]:
    """Return the numbers of a text, with their units."""
    return set(re.findall(r"\b\d+(?:\.\d+)?(?: (?:cm|in)\b)?", words))


@pytest.mark.parametrize("unit", ["cm", "in"])
@pytest.mark.parametrize("name", REASONS)
def test_strip_and_board_name_no_amount_that_the_panel_does_not(modules: Page, name: str, unit: str) -> None:
    strip, board, panel = told(modules, REASONS[name], unit)
    strip = strip.replace("Fold 1", "")
    assert amounts(strip) | amounts(board) <= amounts(panel)
    assert amounts(strip) or name == "collision in a drag"


def test_the_amount_that_is_missing_and_the_way_of_a_drag_have_one_wording(modules: Page) -> None:
    way = "40 cm towards the robot and 10 cm to the left"
    for name, by in (("short", "10 cm"), ("short at least", "at least 10 cm"), ("without margin", "10 cm")):
        for words in told(modules, REASONS[name], "cm"):
            assert by in words
            assert way in words


@pytest.mark.parametrize("name", ["turned about an edge off the table", "behind the line", "short"])
def test_strip_and_panel_tell_the_drag_once(modules: Page, name: str) -> None:
    strip, _, panel = told(modules, REASONS[name], "cm")
    assert (strip.count("dragged"), panel.count("dragged")) == (1, 1)


@pytest.mark.parametrize("name", ["short", "short at least", "too low", "without margin"])
def test_strip_and_panel_word_a_shortfall_alike(modules: Page, name: str) -> None:
    strip, _, panel = told(modules, REASONS[name], "cm")
    lack = strip.partition(" grip ")[2].partition(", at best from")[0]
    assert "reach" in lack
    assert lack in panel
