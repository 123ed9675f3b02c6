"""Further editing in the 3D view of the real page with the mouse, tested through the 3D view's own scene."""

import pytest
from playwright.sync_api import Page, expect

from planner.geometry.pose import Point2
from tests.app.conftest import Served
from tests.browser.conftest import IS_THERE, Sheet
from tests.browser.view_hand import CAMERA, corner_in_picture, drag, look_from_above
from tests.patience import wait_until


@pytest.fixture
def page(view_page: Page) -> Page:
    return view_page


def middle(a: Point2, b: Point2) -> Point2:
    return ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)


@pytest.mark.long
def test_what_is_dragged_when_the_3d_view_is_loaded_anew_is_let_go_where_it_is(page: Page, designer: Served) -> None:
    sheet = Sheet(designer.url, page.url.rpartition("/")[2])
    before = sheet.drawing
    look_from_above(page)
    x, y = corner_in_picture(page, sheet, 0)
    drag(page, (x, y), (x + 20, y - 12))
    wait_until(lambda: sheet.state["gesture"] == "Move vertex")
    page.evaluate("document.getElementById('view3d').contentWindow.location.reload()")
    wait_until(lambda: sheet.state["gesture"] is None)
    page.mouse.up()
    assert sheet.drawing["outline"][0] != before["outline"][0]
    expect(page.get_by_role("toolbar", name="Look from")).to_be_visible()
    page.wait_for_function(IS_THERE, arg="/cloth/front")
    look_from_above(page)
    drag(page, corner_in_picture(page, sheet, 0), (x, y))
    page.mouse.up()
    wait_until(lambda: sheet.can_undo == "Move vertex" and sheet.state["gesture"] is None)
    for _ in range(2):
        page.keyboard.press("Control+z")
    wait_until(lambda: sheet.drawing == before)


@pytest.mark.long
def test_a_fold_is_drawn_on_the_cloth_on_the_table(page: Page, designer: Served) -> None:
    sheet = Sheet(designer.url, page.url.rpartition("/")[2])
    count, above = len(sheet.drawing["folds"]), look_from_above(page)
    page.locator("#drafting-board").focus()
    page.keyboard.press("f")
    for _ in range(count):
        page.keyboard.press("[")
    expect(page.get_by_text("Spread out")).to_be_visible()
    left = middle(corner_in_picture(page, sheet, 0), corner_in_picture(page, sheet, 1))
    right = middle(corner_in_picture(page, sheet, 8), corner_in_picture(page, sheet, 9))
    drag(page, left, right)
    page.mouse.up()
    wait_until(lambda: len(sheet.drawing["folds"]) == count + 1)
    fold = sheet.drawing["folds"][0]
    # From half the height of one side to half the height of the other, as near as a hand comes: a pixel is some 4 mm.
    # The smaller part moves, which is the lower one: it lies to the left of a line back from the other side.
    assert fold["start"]["point"] == pytest.approx([0.457, 0.21], abs=0.02)
    assert fold["end"]["point"] == pytest.approx([0.0, 0.21], abs=0.02)
    assert page.evaluate(CAMERA) == above
