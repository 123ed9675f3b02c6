"""Editing in the 3D view of the real page with the mouse, tested through the 3D view's own scene."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import FrameLocator, Page, expect

from planner.geometry.pose import Point2, Pose2
from tests.app.conftest import Served
from tests.browser.conftest import IN_VIEW, IS_THERE, VIEW_PATIENCE_MS, Sheet

CAMERA = f"() => {IN_VIEW}.camera.matrixWorld.elements.map((value) => value.toFixed(4)).join(' ')"
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
        page.wait_for_timeout(300)
    return now


def corner_in_picture(page: Page, sheet: Sheet, index: int) -> Point2:
    drawing = sheet.drawing
    placed = Pose2(**drawing["placement"]).to_outer(np.array(drawing["outline"][index]["point"]))
    x, y = page.evaluate(TO_PICTURE, [*placed.tolist(), 0.0015])
    return (x, y)


def choose(view: FrameLocator, mode: str) -> None:
    view.get_by_label("Mode").locator("visible=true").click()
    view.get_by_role("option", name=mode).click()


def test_a_corner_is_dragged_from_above_and_undone_and_the_camera_stays(page: Page, designer: Served) -> None:
    sheet, view = Sheet(designer.url, page.url.rpartition("/")[2]), page.frame_locator("#view3d")
    before = sheet.drawing
    opening = still_camera(page)
    view.get_by_text("Table").locator("visible=true").click()
    page.get_by_role("toolbar", name="Look from").get_by_role("button", name="Top").click()
    until(lambda: page.evaluate(CAMERA) != opening)
    above = still_camera(page)
    choose(view, "Move points")
    page.wait_for_function(IS_THERE, arg="/editor/handles")

    x, y = corner_in_picture(page, sheet, 0)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 10, y - 6)
    page.mouse.move(x + 20, y - 12)
    until(lambda: sheet.state["gesture"] == "Move vertex")
    page.mouse.up()
    until(lambda: sheet.state["gesture"] is None)
    assert sheet.can_undo == "Move vertex"
    u, v = corner_in_picture(page, sheet, 0)
    assert (u, v) == pytest.approx((x + 20, y - 12), abs=1.0)
    assert [c["point"] for c in sheet.drawing["outline"][1:]] == [c["point"] for c in before["outline"][1:]]

    view.get_by_role("button", name="Undo: Move vertex").click()
    until(lambda: sheet.drawing == before)

    page.mouse.move(x + 60, y - 60)  # on the cloth, where there is no corner
    page.mouse.down()
    page.mouse.move(x + 90, y - 90)
    page.mouse.up()
    expect(view.get_by_text("There is no corner there")).to_be_visible()
    assert sheet.drawing == before
    assert still_camera(page) == above
