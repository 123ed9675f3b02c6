"""Edges bent on the board: pulled, pulled again, straightened, by hand, by finger, by keys; and what goes along."""

import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from playwright.sync_api import Page, expect

from app.drawing.curve import Curve
from app.drawing.drawing import Corner
from app.drawing.ring import ring_of
from tests.browser.board_desk import Desk, expect_no_step, expect_step
from tests.browser.board_hand import Hand

SQUARE = {"name": "square", "outline": [[0.0, 0.0], [0.4, 0.0], [0.4, 0.4], [0.0, 0.4]], "folds": []}
TOP = (0.2, 0.4)
"""The middle of the third edge, which runs from right to left."""


@pytest.fixture
def square(desk: Desk) -> Desk:
    desk.lay(SQUARE)
    return desk


def curves(desk: Desk) -> list[dict[str, Any] | None]:
    return [corner.get("curve") for corner in desk.at_rest()["drawing"]["outline"]]


def take_hold(page: Page, point: tuple[float, float]) -> None:
    """Point at the middle of an edge and away again within its reach, so that its handle is there."""
    page.mouse.move(*Hand(page).px(point))
    expect(page.locator(".handle.middle")).to_have_count(1)


def test_the_middle_of_an_edge_is_pulled_into_an_arc_pulled_again_and_straightened(page: Page, square: Desk) -> None:
    hand = Hand(page)
    take_hold(page, TOP)
    hand.drag(TOP, (0.205, 0.3))  # 5 mm aside: the arc of a circle is near
    expect_step(page, "Bend edge")
    (bent,) = (curve for curve in curves(square) if curve)
    assert bent == {"along": pytest.approx(0.0, abs=1e-9), "across": pytest.approx(0.25, abs=2e-3)}
    expect(page.locator(".handle.middle.is-curved")).to_have_count(1)
    hand.drag((0.2, 0.3), (0.3, 0.28))
    expect_step(page, "Bend edge")
    assert curves(square)[2] == {"along": pytest.approx(-0.25, abs=2e-3), "across": pytest.approx(0.3, abs=2e-3)}
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    expect_no_step(page)
    assert curves(square) == [None] * 4
    page.keyboard.press("Control+Shift+z")
    expect_step(page, "Bend edge")
    hand.drag((0.2, 0.3), (0.21, 0.398))
    expect(page.locator(".handle.middle.is-curved")).to_have_count(0)
    assert curves(square) == [None] * 4


def test_with_alt_the_middle_of_an_edge_becomes_a_corner(page: Page, square: Desk) -> None:
    take_hold(page, TOP)
    page.keyboard.down("Alt")
    Hand(page).drag(TOP, (0.2, 0.5))
    page.keyboard.up("Alt")
    expect_step(page, "Add vertex")
    assert square.at_rest()["drawing"]["outline"][3]["point"] == pytest.approx([0.2, 0.5], abs=2e-3)


def test_a_written_bulge_bends_the_edge_outwards_and_nought_straightens_it(page: Page, square: Desk) -> None:
    Hand(page).click((0.4, 0.4))
    page.keyboard.press("c")
    field = page.get_by_label("Bulge from straight")
    expect(field).to_be_focused()
    field.fill("10")
    page.keyboard.press("Enter")
    expect_step(page, "Bend edge")
    assert curves(square)[2] == {"along": pytest.approx(0.0, abs=1e-9), "across": pytest.approx(-0.25)}
    page.keyboard.press("c")
    expect(field).to_have_value("10.0")
    field.fill("0")
    page.keyboard.press("Enter")
    expect(page.locator(".handle.middle.is-curved")).to_have_count(0)
    assert curves(square) == [None] * 4


def test_a_corner_on_an_arc_parts_it_and_taken_away_leaves_it_whole(page: Page, square: Desk) -> None:
    hand = Hand(page)
    take_hold(page, TOP)
    hand.drag(TOP, (0.2, 0.3))
    expect_step(page, "Bend edge")
    page.keyboard.press("Escape")
    before = curves(square)[2]
    turn = 0.6  # on the arc through (0.4, 0.4), (0.2, 0.3) and (0, 0.4), of 0.25 m about (0.2, 0.55)
    page.mouse.dblclick(*hand.px((0.2 + 0.25 * math.sin(turn), 0.55 - 0.25 * math.cos(turn))))
    expect_step(page, "Add vertex")
    outline = square.at_rest()["drawing"]["outline"]
    ring = ring_of(tuple(Corner("", tuple(c["point"]), Curve(**c["curve"]) if "curve" in c else None) for c in outline))
    assert all(math.dist(p, (0.2, 0.55)) == pytest.approx(0.25, abs=1e-6) for p in ring.points if p[1] > 0.01)
    page.keyboard.press("Delete")
    expect_step(page, "Delete vertex")
    after = curves(square)[2]
    assert after is not None
    assert before is not None
    assert after["across"] == pytest.approx(before["across"], abs=1e-6)


def test_a_notch_is_cut_into_the_selected_edge(page: Page, square: Desk) -> None:
    Hand(page).click((0.13, 0.4))
    page.get_by_role("button", name="Notch").click()
    expect_step(page, "Cut notch")
    drawing = square.at_rest()["drawing"]
    assert [corner["point"] for corner in drawing["outline"][3:5]] == [
        pytest.approx([0.28, 0.4]),
        pytest.approx([0.12, 0.4]),
    ]
    assert drawing["outline"][3]["curve"]["across"] > 0  # into the cloth
    assert square.state["problems"] == []


def test_mirror_takes_curves_to_the_other_side(page: Page, square: Desk) -> None:
    hand = Hand(page)
    take_hold(page, (0.0, 0.2))
    hand.drag((0.0, 0.2), (-0.1, 0.25))
    expect_step(page, "Bend edge")
    hand.tool("Mirror")
    expect_step(page, "Mirror edge")
    left, right = curves(square)[3], curves(square)[1]
    assert left is not None
    assert right == {"along": pytest.approx(-left["along"]), "across": pytest.approx(left["across"])}
    page.keyboard.press("Control+z")
    page.keyboard.press("Escape")
    hand.tool("Mirror")
    expect_step(page, "Mirror outline")
    assert [curve for curve in curves(square) if curve] == [
        {"along": pytest.approx(left["along"]), "across": pytest.approx(left["across"])},
        {"along": pytest.approx(-left["along"]), "across": pytest.approx(left["across"])},
    ]


def test_a_fold_ends_anywhere_on_a_curve_and_goes_along_when_it_is_pulled(page: Page, square: Desk) -> None:
    hand = Hand(page)
    take_hold(page, TOP)
    hand.drag(TOP, (0.2, 0.3))
    expect_step(page, "Bend edge")
    hand.tool("Draw fold")
    hand.drag((0.2, 0.3), (0.2, 0.0))
    expect_step(page, "Draw fold")
    page.keyboard.press("Escape")
    assert square.at_rest()["drawing"]["folds"][0]["start"]["on"]["kind"] == "edge"
    hand.tool("Draw outline")  # it shows the cloth spread out
    hand.tool("Select")
    hand.click((0.35, 0.35))
    page.keyboard.press("c")
    page.get_by_label("Bulge from straight").fill("-4")
    page.keyboard.press("Enter")
    expect_step(page, "Bend edge")
    assert square.at_rest()["drawing"]["folds"][0]["start"]["point"] == pytest.approx([0.2, 0.36], abs=2e-3)


parts = st.floats(-1.2, 1.2)


@settings(max_examples=30, deadline=None)
@given(along=parts, across=parts, x=parts, y=parts)
def test_the_board_flattens_a_curve_as_the_server_does(
    page: Page, along: float, across: float, x: float, y: float
) -> None:
    outline = [
        {"id": "a", "point": [0.1, 0.2], "curve": {"along": along, "across": across}},
        {"id": "b", "point": [x, y]},
        {"id": "c", "point": [0.5, 0.9]},
    ]
    made = page.evaluate("async (outline) => (await import('page/board/curves.js')).ringOf({outline})", outline)
    ring = ring_of((Corner("a", (0.1, 0.2), Curve(along, across)), Corner("b", (x, y)), Corner("c", (0.5, 0.9))))
    assert len(made) == len(ring.points)
    for point, known in zip(made, ring.points, strict=True):
        assert point == pytest.approx(known, abs=1e-9)
