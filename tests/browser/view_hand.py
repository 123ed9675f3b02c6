"""A hand on the 3D view: where things are in its picture, and its camera."""

import numpy as np
from playwright.sync_api import Page

from planner.geometry.pose import Point2, Pose2
from tests.browser.conftest import IN_VIEW, Sheet

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


def drag(page: Page, start: Point2, end: Point2) -> None:
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
    page.mouse.move(*end)
