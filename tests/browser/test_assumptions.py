"""Assumptions of a plan that differ from the defaults are marked, and removed by a click."""

from typing import Any

import pytest
from playwright.sync_api import Page, expect

from app.drawing.garment_drawing import COMFORT_RADIUS_M
from planner import Scene
from tests.browser.board.conftest import desk as desk
from tests.browser.board.conftest import page as page
from tests.browser.board_desk import Desk, expect_step
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned

ASSUMED = ["grip 50 cm", "friction 1.5", "reach margin 1 cm"]


@pytest.fixture
def assumed(page: Page, desk: Desk) -> Desk:
    """Return a napkin with a wide grip in two of its folds, a rougher table, and a smaller reach margin."""
    desk.lay(napkin())

    def assume(drawing: dict[str, Any]) -> None:
        drawing["scene"]["friction"] = 1.5
        drawing["comfort_radius_m"] = 0.01
        for fold, radius_m in zip(drawing["folds"], (0.2, 0.5, None), strict=True):
            fold["grip_radius_m"] = radius_m

    desk.edit(assume)
    expect_planned(page, desk.state["version"])
    return desk


def marks(page: Page) -> list[str]:
    return page.get_by_role("group", name="Assumptions").get_by_role("button").all_inner_texts()


def test_what_is_assumed_is_marked_beside_the_status_and_at_the_folds(page: Page, assumed: Desk) -> None:
    assert [text.split("\n")[0].rstrip("\N{MULTIPLICATION X}") for text in marks(page)] == ASSUMED
    rows = page.locator(".fold-row")
    expect(rows.nth(0).get_by_role("button", name="Assumed: grip 20 cm")).to_be_visible()
    expect(rows.nth(1).get_by_role("button", name="Assumed: grip 50 cm")).to_be_visible()
    expect(rows.nth(2).get_by_role("button", name="Assumed")).to_have_count(0)


def test_each_is_taken_off_by_a_click_as_one_step(page: Page, assumed: Desk) -> None:
    page.locator(".fold-row").nth(0).get_by_role("button", name="Assumed: grip 20 cm").click()
    expect_step(page, "Set grip radius")
    assert [fold["grip_radius_m"] for fold in assumed.drawing["folds"]] == [None, 0.5, None]
    for text in ASSUMED:
        mark = page.get_by_role("group", name="Assumptions").get_by_role("button", name=f"Assumed: {text}")
        mark.click()
        expect(mark).to_have_count(0)
    expect(page.get_by_role("group", name="Assumptions")).to_be_hidden()
    drawing = assumed.drawing
    assert [fold["grip_radius_m"] for fold in drawing["folds"]] == [None, None, None]
    assert drawing["scene"]["friction"] == Scene().friction
    assert drawing["comfort_radius_m"] == COMFORT_RADIUS_M
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_role("group", name="Assumptions").get_by_role("button")).to_have_count(1)


def test_what_is_stricter_than_usual_is_no_assumption(page: Page, desk: Desk) -> None:
    desk.lay(napkin(grip_radius_m=0.2))

    def be_strict(drawing: dict[str, Any]) -> None:
        drawing["scene"]["friction"] = 0.9
        drawing["comfort_radius_m"] = 0.04
        drawing["folds"][0]["grip_radius_m"] = 0.1

    desk.edit(be_strict)
    expect_planned(page, desk.state["version"])
    expect(page.get_by_role("group", name="Assumptions")).to_be_hidden()


def test_a_station_that_was_added_is_marked_and_taken_off(page: Page, assumed: Desk) -> None:
    def add(drawing: dict[str, Any]) -> None:
        drawing["scene"]["stations"]["far"] = {"x_m": 0.95, "y_m": 0.0, "yaw_rad": 3.1}
        drawing["start_station"] = "far"

    assumed.edit(add)
    mark = page.get_by_role("button", name="Assumed: station far. Take it off")
    mark.click()
    expect_step(page, "Assume no station far")
    scene = assumed.at_rest()["drawing"]["scene"]
    assert "far" not in scene["stations"]
    assert assumed.state["drawing"]["start_station"] in scene["stations"]
