"""Cloth turned over on the board: a stroke along its edge, in the kind of fold that turns."""

import pytest
from playwright.sync_api import Page, expect

from tests.browser.board_desk import Desk, expect_step
from tests.browser.board_hand import Hand

SQUARE = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]]


def test_a_stroke_along_the_edge_turns_all_of_the_cloth_over_it(page: Page, desk: Desk) -> None:
    desk.lay({"name": "towel", "outline": SQUARE, "folds": []})
    hand = Hand(page)
    hand.tool("Draw fold")
    hand.tool("Turn: all of it over")
    hand.drag((0.05, 0.0), (0.35, 0.0))
    expect_step(page, "Draw fold")
    (turn,) = desk.drawing["folds"]
    # The whole edge, its corners tied, and all cloth to its left.
    assert turn["kind"] == "turn"
    assert (turn["start"]["point"], turn["end"]["point"]) == (pytest.approx([0.0, 0.0]), pytest.approx([0.4, 0.0]))
    assert [turn[end]["on"]["kind"] for end in ("start", "end")] == ["vertex", "vertex"]
    page.keyboard.press("[")
    expect(page.locator(".fold.is-turn")).to_have_count(1)
    (ring,) = desk.state["steps"][1]["silhouette"]
    assert sorted(map(tuple, ring)) == [(0.0, -0.3), (0.0, 0.0), (0.4, -0.3), (0.4, 0.0)]


def test_the_letter_o_makes_a_fold_a_turn_which_says_why_it_is_none_there(page: Page, desk: Desk) -> None:
    middle = {"name": "half", "kind": "blue", "start": [0.0, 0.15], "end": [0.4, 0.15]}
    desk.lay({"name": "towel", "outline": SQUARE, "folds": [middle]})
    hand = Hand(page)
    hand.click((0.1, 0.15))
    page.keyboard.press("o")
    expect_step(page, "Make fold a turn")
    assert desk.drawing["folds"][0]["kind"] == "turn"
    assert desk.state["problems"][0]["says"]["code"] == "turn_off_edge"
