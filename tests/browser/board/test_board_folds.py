"""Folds on the board: dragged, flipped, mirrored, made by dropping cloth where it is to lie."""

import pytest
from playwright.sync_api import Page, expect

from tests.browser.board_desk import Desk, expect_step
from tests.browser.board_hand import Hand
from tests.browser.conftest import Sheet

PX_M = 0.003


def fold(sheet: Sheet, index: int) -> dict[str, list[float]]:
    found = sheet.drawing["folds"][index]
    return {end: found[end]["point"] for end in ("start", "end")}


def test_the_end_of_a_fold_is_dragged_along_the_boundary(page: Page, shirt: Desk) -> None:
    hand = Hand(page)
    hand.click((0.1, 0.15))
    expect(page.locator(".fold.is-selected")).to_have_count(1)
    hand.drag((0.1, 0.0), (0.07, 0.03))
    expect_step(page, "Move fold")
    assert fold(shirt, 2)["start"] == pytest.approx([0.07, 0.0], abs=PX_M)
    assert fold(shirt, 2)["end"] == pytest.approx([0.1, 0.61], abs=1e-9)


def test_a_whole_fold_is_dragged_and_keeps_to_the_cloth(page: Page, shirt: Desk) -> None:
    Hand(page).drag((0.2, 0.305), (0.2, 0.25))
    expect_step(page, "Move fold")
    found = fold(shirt, 4)
    assert found["start"] == pytest.approx([0.357, 0.25], abs=PX_M)
    assert found["end"] == pytest.approx([0.1, 0.25], abs=PX_M)


def test_flip_and_red_act_on_the_selected_fold(page: Page, shirt: Desk) -> None:
    before = fold(shirt, 4)
    hand = Hand(page)
    hand.click((0.2, 0.305))
    hand.tool("Flip")
    expect_step(page, "Flip fold")
    assert fold(shirt, 4) == {"start": before["end"], "end": before["start"]}
    hand.tool("Red: last flap")
    expect_step(page, "Make fold red")
    assert shirt.drawing["folds"][4]["kind"] == "red"


def test_a_fold_mirrored_is_linked_with_its_twin(page: Page, desk: Desk) -> None:
    square = [[0.0, 0.0], [0.6, 0.0], [0.6, 0.6], [0.0, 0.6]]
    side = {"name": "left side", "kind": "blue", "start": [0.15, 0.0], "end": [0.15, 0.6]}
    desk.lay({"name": "square", "outline": square, "folds": [side]})
    hand = Hand(page)
    hand.click((0.15, 0.1))
    hand.tool("Mirror")
    expect_step(page, "Mirror fold")
    # The axis is at x = 0.3, and the mirrored fold runs the other way, so that its left is the outer side.
    assert fold(desk, 1)["start"] == pytest.approx([0.45, 0.6], abs=1e-6)
    assert fold(desk, 1)["end"] == pytest.approx([0.45, 0.0], abs=1e-6)
    assert desk.drawing["folds"][1]["name"] == "right side"
    hand.drag((0.15, 0.3), (0.1, 0.3))
    expect_step(page, "Move fold")
    assert fold(desk, 0)["start"] == pytest.approx([0.1, 0.0], abs=PX_M)
    assert fold(desk, 1)["end"][0] == pytest.approx(0.6 - fold(desk, 0)["start"][0], abs=1e-6)


def test_a_point_grabbed_and_dropped_makes_the_fold_that_takes_it_there(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    hand.tool("Draw fold")
    hand.drag((0.13, 0.07), (0.13, 0.43))
    expect_step(page, "Draw fold")
    # The crease halves the way: y = 0.25, and what is below it moves.
    found = fold(cloth, 0)
    assert found["start"] == pytest.approx([0.457, 0.25], abs=PX_M)
    assert found["end"] == pytest.approx([0.0, 0.25], abs=PX_M)
    expect(page.locator(".strip-moment")).to_have_text("After 1: bottom up")


def test_a_corner_is_grabbed_once_grabbing_is_on(page: Page, desk: Desk) -> None:
    """Otherwise a stroke that begins at a corner is the crease itself."""
    lower_left, lower_right, upper_right, upper_left = square = [[0.0, 0.0], [0.6, 0.0], [0.6, 0.6], [0.0, 0.6]]
    desk.lay({"name": "square", "outline": square, "folds": []})
    hand = Hand(page)
    page.keyboard.press("g")
    grab = page.get_by_role("button", name="Grab", exact=True)
    expect(grab).to_have_attribute("aria-pressed", "true")
    hand.drag((0.0, 0.0), (0.6, 0.6), is_released=False)
    expect(page.locator(".carry")).to_have_count(1)
    page.mouse.up()
    expect_step(page, "Draw fold")
    assert fold(desk, 0) == {"start": pytest.approx(lower_right), "end": pytest.approx(upper_left)}
    page.keyboard.press("Control+z")
    expect_step(page, "Begin")
    hand.tool("Grab")
    expect(grab).to_have_attribute("aria-pressed", "false")
    hand.drag((0.0, 0.0), (0.6, 0.6))
    expect_step(page, "Draw fold")
    assert fold(desk, 0) == {"start": pytest.approx(lower_left), "end": pytest.approx(upper_right)}


def test_a_stroke_beside_the_cloth_is_no_fold_and_says_so(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    hand.tool("Draw fold")
    hand.drag((0.75, 0.2), (0.75, 0.3), is_released=False)
    expect(hand.board).to_have_css("cursor", "not-allowed")
    expect(page.locator(".layer-cursor")).to_contain_text("No fold there")
    expect(page.locator(".ghost-moving")).to_have_count(0)
    page.mouse.move(*hand.px((0.2, 0.3)), steps=3)  # now it does
    expect(page.locator(".ghost-moving")).not_to_have_count(0)
    page.mouse.move(*hand.px((0.75, 0.3)), steps=3)
    page.mouse.up()
    expect(page.locator("#notices")).to_contain_text("does not touch the cloth")
    assert cloth.drawing["folds"] == []


def test_cloth_grabbed_by_an_edge_and_dropped_on_another_lays_edge_on_edge(page: Page, desk: Desk) -> None:
    square = [[0.0, 0.0], [0.6, 0.0], [0.6, 0.6], [0.0, 0.6]]
    desk.lay({"name": "square", "outline": square, "folds": []})
    hand = Hand(page)
    hand.tool("Draw fold")
    # Grabbed a little above the lower edge, dropped somewhere on the left one: halved is the corner between them.
    above = 14 / float(str(hand.board.get_attribute("data-px-per-m")))
    hand.drag((0.2, above), (0.004, 0.37), is_released=False)
    expect(page.locator(".snap-name")).to_have_text("edge onto edge")
    page.mouse.up()
    expect_step(page, "Draw fold")
    found = fold(desk, 0)
    assert sorted(found["start"] + found["end"]) == pytest.approx([0.0, 0.0, 0.6, 0.6], abs=1e-6)


def test_a_crease_from_a_corner_snaps_to_where_it_lays_one_edge_on_the_other(page: Page, desk: Desk) -> None:
    desk.lay({"name": "slanted", "outline": [[0.0, 0.0], [0.6, 0.0], [0.5, 0.4], [0.0, 0.4]], "folds": []})
    hand = Hand(page)
    hand.tool("Draw fold")
    # Halved is the corner between the lower edge and the slanted one, which is sqrt(0.17) m long: with the stretch of
    # the upper edge as far as the crease it makes a triangle with two equal angles, so that stretch is as long.
    across = (0.5 - 0.17**0.5, 0.4)
    hand.drag((0.6, 0.0), (across[0] + 0.005, across[1] + 0.004), is_released=False)
    expect(page.locator(".snap-name")).to_have_text("edge onto edge")
    page.mouse.up()
    expect_step(page, "Draw fold")  # the smaller part moves: its line runs the other way
    assert fold(desk, 0)["start"] == pytest.approx(across, abs=1e-6)
    hand.tool("Select")
    page.get_by_role("button", name="Step before").click()
    desk.edit(lambda drawing: drawing["folds"][0].update(start={"point": [0.25, 0.4], "on": None}))
    expect_step(page, "Elsewhere")
    hand.click((0.425, 0.2))
    hand.drag((0.25, 0.4), (across[0] + 0.005, across[1] + 0.004))
    expect_step(page, "Move fold")
    assert fold(desk, 0)["start"] == pytest.approx(across, abs=1e-6)


def test_the_first_fold_is_not_drawn_red_and_the_reason_is_told(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    hand.tool("Draw fold")
    hand.tool("Red: last flap")
    hand.drag((0.2, 0.0), (0.2, 0.61))
    expect(page.get_by_role("log", name="Notices")).to_contain_text("first fold cannot be red")
    assert cloth.drawing["folds"] == []


def test_the_moments_of_the_folds_are_stepped_through(page: Page, shirt: Desk) -> None:
    after = page.get_by_role("button", name="Step after")
    after.click()
    expect(page.locator(".strip-moment")).to_have_text("After 1: left sleeve")
    expect(page.locator(".cloth.is-back")).to_have_count(1)
    expect(page.locator(".corner")).to_have_count(0)
    for _ in range(4):
        after.click()
    expect(after).to_be_disabled()
    expect(page.locator(".strip-moment")).to_have_text("After 5: bottom up")


def test_a_fold_just_drawn_gets_its_twin_by_mirror(page: Page, desk: Desk) -> None:
    square = [[0.0, 0.0], [0.6, 0.0], [0.6, 0.6], [0.0, 0.6]]
    desk.lay({"name": "square", "outline": square, "folds": []})
    hand = Hand(page)
    hand.tool("Draw fold")
    hand.drag((0.15, 0.0), (0.15, 0.6))
    expect_step(page, "Draw fold")
    hand.tool("Mirror")
    expect_step(page, "Mirror fold")
    # The axis is at x = 0.3: the quarter from the left has its twin a quarter from the right.
    assert fold(desk, 1)["start"] == pytest.approx([0.45, 0.6], abs=PX_M)
    assert [found["status"] for found in desk.state["solved"]] == ["legal", "legal"]
    expect(page.locator(".strip-moment")).to_have_text("After 2: right side over")


def test_a_fold_that_goes_while_it_is_pressed_is_dragged_nowhere(page: Page, shirt: Desk) -> None:
    faults: list[str] = []

    def note(error: object) -> None:
        faults.append(str(error))

    page.on("pageerror", note)
    hand = Hand(page)
    page.mouse.move(*hand.px((0.2, 0.305)))
    page.mouse.down()
    shirt.edit(lambda drawing: drawing["folds"].pop(4))
    expect(page.locator(".fold-focus")).to_have_count(4)
    page.mouse.move(*hand.px((0.2, 0.25)), steps=3)
    page.mouse.up()
    expect_step(page, "Elsewhere")
    assert faults == []
    page.remove_listener("pageerror", note)
