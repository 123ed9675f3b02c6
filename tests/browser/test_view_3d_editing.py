"""Editing in the 3D view of the real page with the mouse, tested through the 3D view's own scene."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from planner.geometry.pose import Point2, Pose2
from tests.app.conftest import Served
from tests.browser.conftest import IN_VIEW, IS_THERE, VIEW_PATIENCE_MS, Sheet

CAMERA = f"() => {IN_VIEW}.camera.matrixWorld.elements.map((value) => value.toFixed(4)).join(' ')"
FROM_ABOVE = f"({IN_VIEW}.camera.matrixWorld.elements[9] > 0.99)"
TO_PICTURE = f"""(place) => {{
  const viser = {IN_VIEW}, world = viser.nodeRefFromName[""];
  const seen = world.position.clone().set(...place).applyMatrix4(world.matrixWorld).project(viser.camera);
  const frame = document.getElementById("view3d").getBoundingClientRect();
  const picture = viser.canvas.getBoundingClientRect();
  return [
    frame.x + picture.x + ((seen.x + 1) / 2) * picture.width,
    frame.y + picture.y + ((1 - seen.y) / 2) * picture.height,
  ];
}}"""


@pytest.fixture
def page(view_page: Page) -> Page:
    return view_page


def until(condition: Callable[[], Any]) -> None:
    deadline = time.monotonic() + VIEW_PATIENCE_MS / 1000
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.05)


def still_camera(page: Page) -> str:
    """Return the camera's place once it has come to rest."""
    before = ""
    while (now := str(page.evaluate(CAMERA))) != before:
        before = now
        page.wait_for_timeout(500)  # longer than from one picture to the next
    return now


def corner_in_picture(page: Page, sheet: Sheet, index: int) -> Point2:
    drawing = sheet.drawing
    placed = Pose2(**drawing["placement"]).to_outer(np.array(drawing["outline"][index]["point"]))
    x, y = page.evaluate(TO_PICTURE, [*placed.tolist(), 0.0015])
    return (x, y)


def look_from_above(page: Page) -> str:
    """Look from the side first, so that the camera comes to its place from above anew; return it."""
    for name, is_there in (("Side", f"!{FROM_ABOVE}"), ("Top", FROM_ABOVE)):
        page.get_by_role("toolbar", name="Look from").get_by_role("button", name=name).click()
        page.wait_for_function(is_there)
        still_camera(page)
    return still_camera(page)


def middle(a: Point2, b: Point2) -> Point2:
    return ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)


def drag(page: Page, start: Point2, end: Point2) -> None:
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
    page.mouse.move(*end)


def test_a_corner_is_dragged_from_above_and_undone_and_the_camera_stays(page: Page, designer: Served) -> None:
    sheet = Sheet(designer.url, page.url.rpartition("/")[2])
    before = sheet.drawing
    above = look_from_above(page)
    x, y = corner_in_picture(page, sheet, 0)
    page.mouse.move(x, y)
    overlay = page.locator(".view3d-surface")
    expect(overlay).to_be_visible()
    drag(page, (x, y), (x + 20, y - 12))
    until(lambda: sheet.state["gesture"] == "Move vertex")
    page.mouse.up()
    until(lambda: sheet.state["gesture"] is None)
    assert sheet.can_undo == "Move vertex"
    u, v = corner_in_picture(page, sheet, 0)
    assert (u, v) == pytest.approx((x + 20, y - 12), abs=3.0)  # as near as the board's snapping lets it come
    assert [c["point"] for c in sheet.drawing["outline"][1:]] == [c["point"] for c in before["outline"][1:]]
    assert page.evaluate(CAMERA) == above

    page.keyboard.press("Control+z")
    until(lambda: sheet.drawing == before)
    page.locator("#drafting-board").hover()
    expect(overlay).to_be_hidden()


def test_where_there_is_nothing_to_take_the_pointer_turns_the_camera(page: Page, designer: Served) -> None:
    sheet = Sheet(designer.url, page.url.rpartition("/")[2])
    before, above = sheet.drawing, look_from_above(page)
    x, y = corner_in_picture(page, sheet, 0)
    drag(page, (x + 40, y - 40), (x + 90, y - 80))  # on the cloth, with the tool that selects
    page.mouse.up()
    until(lambda: page.evaluate(CAMERA) != above)
    assert sheet.drawing == before


@pytest.mark.long
def test_what_is_dragged_when_the_3d_view_is_loaded_anew_is_let_go_where_it_is(page: Page, designer: Served) -> None:
    sheet = Sheet(designer.url, page.url.rpartition("/")[2])
    before = sheet.drawing
    look_from_above(page)
    x, y = corner_in_picture(page, sheet, 0)
    drag(page, (x, y), (x + 20, y - 12))
    until(lambda: sheet.state["gesture"] == "Move vertex")
    page.evaluate("document.getElementById('view3d').contentWindow.location.reload()")
    until(lambda: sheet.state["gesture"] is None)
    page.mouse.up()
    assert sheet.drawing["outline"][0] != before["outline"][0]
    expect(page.get_by_role("toolbar", name="Look from")).to_be_visible()
    page.wait_for_function(IS_THERE, arg="/cloth/front")
    look_from_above(page)
    drag(page, corner_in_picture(page, sheet, 0), (x, y))
    page.mouse.up()
    until(lambda: sheet.can_undo == "Move vertex" and sheet.state["gesture"] is None)
    for _ in range(2):
        page.keyboard.press("Control+z")
    until(lambda: sheet.drawing == before)


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
    until(lambda: len(sheet.drawing["folds"]) == count + 1)
    fold = sheet.drawing["folds"][0]
    # From half the height of one side to half the height of the other, as near as a hand comes: a pixel is some 4 mm.
    # The smaller part moves, which is the lower one: it lies to the left of a line back from the other side.
    assert fold["start"]["point"] == pytest.approx([0.457, 0.21], abs=0.02)
    assert fold["end"]["point"] == pytest.approx([0.0, 0.21], abs=0.02)
    assert page.evaluate(CAMERA) == above
