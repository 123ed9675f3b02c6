"""Editing the outline by hand: corners dragged, nudged, typed, snapped, mirrored, dropped, undone."""

import pytest
from playwright.sync_api import Page, expect

from tests.browser.board_desk import Desk, corner, expect_no_step, expect_step
from tests.browser.board_hand import Hand
from tests.browser.status_pill import expect_planned

# The T-shirt's corners and folds, as its file has them (m).
SLEEVE_TIP = (0.61, 0.572)
BOTTOM_RIGHT = (0.457, 0.0)
PX_M = 0.003


def test_a_dragged_corner_goes_along_with_folds_and_plan_as_one_step(page: Page, shirt: Desk) -> None:
    Hand(page).drag(SLEEVE_TIP, (0.633, 0.531))
    expect_step(page, "Move vertex")
    assert corner(shirt, 6) == pytest.approx([0.633, 0.531], abs=PX_M)
    expect_planned(page)
    page.keyboard.press("Control+z")
    expect_no_step(page)
    assert corner(shirt, 6) == list(SLEEVE_TIP)
    page.keyboard.press("Control+Shift+Z")
    expect_step(page, "Move vertex")
    assert corner(shirt, 6) == pytest.approx([0.633, 0.531], abs=PX_M)


def test_a_corner_pulled_into_the_cloth_is_told_of_where_it_is(page: Page, shirt: Desk) -> None:
    Hand(page).drag(BOTTOM_RIGHT, (-0.08, 0.2))
    expect(page.get_by_role("status")).to_contain_text("No plan: ")
    expect(page.locator(".callout")).to_contain_text("cross")
    expect(page.locator(".problem-cross")).not_to_have_count(0)
    expect(page.locator(".problem-line")).not_to_have_count(0)
    page.get_by_role("button", name="Undo").click()
    expect(page.locator(".callout")).to_be_hidden()
    expect_planned(page)


def test_escape_drops_a_drag_without_a_step(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    before = page.locator(".corner").nth(6).get_attribute("aria-label")  # not where it is drawn: the board may move
    hand.drag(SLEEVE_TIP, (0.66, 0.5), is_released=False)
    page.wait_for_function(f"fetch('{cloth.path}').then((a) => a.json()).then((s) => s.gesture === 'Move vertex')")
    page.keyboard.press("Escape")
    page.mouse.up()
    expect_no_step(page)
    expect(page.locator(".corner").nth(6)).to_have_attribute("aria-label", str(before))
    assert cloth.at_rest()["history"] == {"can_undo": "Begin", "can_redo": None}
    assert corner(cloth, 6) == list(SLEEVE_TIP)


def test_a_second_window_follows_the_drag_of_the_first(page: Page, cloth: Desk) -> None:
    other = page.context.new_page()
    other.goto(cloth.page_url)
    shown = other.locator(".corner").nth(6)
    expect(other.locator(".corner")).to_have_count(10)
    before = shown.get_attribute("aria-label")
    hand = Hand(page)
    hand.drag(SLEEVE_TIP, (0.66, 0.5), is_released=False)
    expect(shown).not_to_have_attribute("aria-label", str(before))
    page.mouse.up()
    expect_step(other, "Move vertex")
    other.get_by_role("button", name="Undo").click()
    expect_no_step(page)
    expect(shown).to_have_attribute("aria-label", str(before))
    other.close()


def test_the_view_stays_where_it_is_when_the_drawing_changes(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    page.mouse.move(*hand.px((0.2, 0.3)))
    unzoomed = str(hand.board.get_attribute("data-px-per-m"))
    page.mouse.wheel(0, -240)
    expect(hand.board).not_to_have_attribute("data-px-per-m", unzoomed)
    before = [hand.board.get_attribute(name) for name in ("data-origin-px", "data-px-per-m")]
    cloth.edit(lambda drawing: drawing["outline"][6].update(point=[0.9, 0.6]))
    expect(page.locator(".corner").nth(6)).to_have_attribute("aria-label", "Vertex 7: 90.0, 60.0 cm")
    assert [hand.board.get_attribute(name) for name in ("data-origin-px", "data-px-per-m")] == before


def test_the_wheel_zooms_at_the_cursor_and_the_origin_is_told_truly(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    at = tuple(round(part) for part in hand.px(SLEEVE_TIP))  # a wheel's place is in whole pixels
    page.mouse.move(*at)
    x0, y0 = hand.px((0.0, 0.0))
    before = float(str(hand.board.get_attribute("data-px-per-m")))
    page.mouse.wheel(0, -300)
    page.wait_for_function(f"Number(document.getElementById('drafting-board').dataset.pxPerM) > {1.2 * before}")
    under = ((at[0] - x0) / before, (y0 - at[1]) / before)  # what was under the cursor, garment frame
    assert hand.px(under) == pytest.approx(at, abs=0.01)
    box = page.locator(".corner").nth(6).bounding_box()
    assert box is not None
    assert (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2) == pytest.approx(hand.px(SLEEVE_TIP), abs=1.0)


def test_arrow_keys_nudge_and_a_run_of_them_is_one_step(page: Page, cloth: Desk) -> None:
    Hand(page).click(SLEEVE_TIP)
    for key in ("ArrowRight", "ArrowRight", "Shift+ArrowUp"):
        page.keyboard.press(key)
    expect_step(page, "Move vertex")
    page.wait_for_function("document.querySelectorAll('.number-at input')[1].value === '58.2'")
    assert corner(cloth, 6) == pytest.approx([0.612, 0.582], abs=1e-9)
    page.keyboard.press("Control+z")
    expect_no_step(page)
    assert corner(cloth, 6) == list(SLEEVE_TIP)


def test_a_double_click_puts_a_corner_on_an_edge_and_delete_takes_it_away(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    page.mouse.dblclick(*hand.px((0.2, 0.0)))
    expect(page.locator(".corner")).to_have_count(11)
    expect_step(page, "Add vertex")
    page.keyboard.press("Delete")
    expect(page.locator(".corner")).to_have_count(10)
    expect_step(page, "Delete vertex")
    assert corner(cloth, 0) == [0.0, 0.0]


def test_mirroring_a_garment_pulled_out_of_shape_keeps_to_its_own_axis(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    hand.drag(BOTTOM_RIGHT, (0.52, -0.06))
    expect_step(page, "Move vertex")
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Mirror").hover()
    expect(page.locator(".mirror-axis")).to_have_count(1)
    hand.tool("Mirror")
    expect_step(page, "Mirror outline")
    found = [point["point"] for point in cloth.drawing["outline"]]
    assert any(point == pytest.approx(BOTTOM_RIGHT, abs=0.002) for point in found)
    assert len(found) == 10
    page.mouse.move(*hand.px((0.2, 0.3)))
    expect(page.locator(".mirror-axis")).to_have_count(0)


def test_mirroring_a_garment_that_is_alike_on_both_sides_leaves_its_folds_where_they_are(
    page: Page, shirt: Desk
) -> None:
    before = [[fold[end]["point"] for end in ("start", "end")] for fold in shirt.drawing["folds"]]
    Hand(page).tool("Mirror")
    expect_step(page, "Mirror outline")
    for fold, ends in zip(shirt.drawing["folds"], before, strict=True):
        for end, point in zip(("start", "end"), ends, strict=True):
            assert fold[end]["point"] == pytest.approx(point, abs=0.002)


def test_the_snap_in_force_is_named_and_control_suspends_it(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    hand.tool("Measure")
    middle = hand.px((0.2285, 0.0))
    page.mouse.move(middle[0] + 3, middle[1] + 3)
    expect(page.locator(".snap-name")).to_have_text("midpoint")
    page.keyboard.down("Control")
    page.mouse.move(middle[0] + 4, middle[1] + 3)
    expect(page.locator(".snap-name")).to_have_count(0)
    page.keyboard.up("Control")
    page.mouse.move(middle[0] + 4, middle[1] + 4)
    page.mouse.down()
    page.mouse.move(*hand.px((0.2285, 0.3)), steps=3)
    page.mouse.move(*hand.px((0.2285, 0.61)), steps=3)
    page.mouse.up()
    expect(page.locator(".length.is-tape")).to_contain_text("61.0 cm")


def test_the_garment_is_placed_on_the_table_and_turned(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    hand.tool("Place")
    page.keyboard.press("ArrowUp")
    expect_step(page, "Place garment")
    assert cloth.drawing["placement"]["x_m"] == pytest.approx(-0.598 + 0.001, abs=1e-9)
    page.get_by_label("Turn in degrees").fill("90")
    page.keyboard.press("Enter")
    expect_step(page, "Turn garment")
    placement = cloth.drawing["placement"]
    assert placement["yaw_rad"] == pytest.approx(1.5707963267948966, abs=1e-9)
    # Turned about the middle of its box, (0.229, 0.305): that point keeps its place on the table.
    assert placement["x_m"] - 0.305 == pytest.approx(-0.597 + 0.229, abs=1e-9)
    assert placement["y_m"] + 0.229 == pytest.approx(-0.305 + 0.305, abs=1e-9)


def test_what_holds_the_garment_on_the_table_is_named(page: Page, cloth: Desk) -> None:
    """Its middle lies on the line between the table's left and right, 36.95 cm before the middle of the table."""
    hand = Hand(page)
    hand.tool("Place")
    expect(page.locator(".yaw-knob")).to_be_visible()
    box = page.locator(".layer-cloth").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    scale = float(str(hand.board.get_attribute("data-px-per-m")))
    name = page.locator(".snap-name")
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 2, y - 0.1 * scale, steps=3)
    expect(name).to_have_text("table's middle line")
    page.mouse.move(x + 2, y - 0.3695 * scale, steps=3)
    expect(name).to_have_text("table's middle")
    page.mouse.up()
    expect(name).to_have_count(0)
    expect_step(page, "Place garment")


def test_tab_walks_from_fold_to_fold_and_corner_to_corner_and_enter_edits(page: Page, shirt: Desk) -> None:
    page.get_by_role("button", name="Fit").focus()
    for _ in range(2):
        page.keyboard.press("Tab")
    expect(page.get_by_role("button", name="Fold 1: left sleeve, blue")).to_be_focused()
    expect(page.locator(".fold.is-selected")).to_have_count(1)
    for _ in range(5):
        page.keyboard.press("Tab")
    expect(page.get_by_role("button", name="Vertex 1: 0.0, 0.0 cm")).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.get_by_label("x of the vertex")).to_be_focused()
    page.keyboard.type("-1")
    page.keyboard.press("Enter")
    expect_step(page, "Move vertex")
    assert corner(shirt, 0) == pytest.approx([-0.01, 0.0], abs=1e-9)


def test_the_robot_starts_where_it_is_clicked_beside_the_table(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    hand.tool("Place")
    name = page.locator(".station-name", has_text="front right").bounding_box()
    assert name is not None
    page.mouse.click(name["x"] + name["width"] / 2, name["y"] + name["height"] / 2)
    expect_step(page, "Start at front right")
    assert cloth.drawing["start_station"] == "front_right"
    expect(page.locator(".station-name", has_text="(start)")).to_have_text("front right (start)")


def test_near_a_crossing_of_the_grid_a_corner_snaps_to_both_of_its_lines(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    x, y = hand.px((0.65, 0.25))  # lines of the grid cross there at every zoom that shows the T-shirt whole
    corner = cloth.drawing["outline"][5]["point"]
    page.mouse.move(*hand.px(tuple(corner)))
    page.mouse.down()
    page.mouse.move(x - 20, y - 20, steps=3)
    page.mouse.move(x + 2, y + 1, steps=2)
    page.mouse.up()
    expect_step(page, "Move vertex")
    assert cloth.drawing["outline"][5]["point"] == pytest.approx([0.65, 0.25], abs=1e-9)
