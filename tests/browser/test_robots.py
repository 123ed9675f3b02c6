"""Robots in the page: compared, chosen, and brought along as an archive."""

import json
import re
from collections.abc import Callable
from typing import Any

from playwright.sync_api import Page, Route, expect

from tests.app.conftest import REST
from tests.app.robot_archives import archive, box_card, box_urdf
from tests.browser.conftest import Garment, Sheet
from tests.browser.napkin import napkin
from tests.required import required
from tests.robots.drafted import single_urdf

SHORT = {"fold": 0, "code": "out_of_reach", "cause": "too_far", "arm": "left", "short_by_m": 0.3, "message": "short"}
FOUND: dict[str, dict[str, Any]] = {
    "pr2": {"status": "solved", "cost_s": 21.34, "margin_m": 0.04, "reasons": []},
    "so101-pair": {"status": "infeasible", "cost_s": None, "margin_m": None, "reasons": [SHORT]},
}


def few(route: Route) -> None:
    """Answer with two robots only: the others take their time."""
    robots = route.fetch().json()
    route.fulfill(json=[robot for robot in robots if robot["name"] in FOUND])


def compare(route: Route) -> None:
    """Begin a comparison, with the robot's name as the job's."""
    (robot,) = required(route.request.post_data_json)["robots"]
    route.fulfill(status=202, json={"id": robot})


def end_comparison(route: Route) -> None:
    """Tell the result of a comparison at once: it takes its time too."""
    robot = route.request.url.split("/")[-2]
    result = {"robots": [{"robot": robot, "help": None, **FOUND[robot]}]}
    end = {"status": "done", "progress": 1.0, "message": "", "result": result}
    route.fulfill(content_type="text/event-stream", body=f"event: end\ndata: {json.dumps(end)}\n\n")


def test_robots_are_compared_and_one_is_chosen(page: Page, new_sheet: Callable[[Garment], Sheet]) -> None:
    page.route("**/api/robots", few)
    page.route("**/api/comparisons", compare)
    page.route("**/api/jobs/*/events", end_comparison)
    page.goto(new_sheet(napkin(folds=napkin()["folds"][:1])).page_url)
    page.get_by_role("button", name="Who can fold this?").click()
    dialog = page.get_by_role("dialog", name="Who can fold this?")
    rows = dialog.locator("tbody tr")
    expect(rows.nth(0)).to_contain_text("PR2")
    expect(rows.nth(0)).to_have_attribute("data-status", "solved")
    expect(rows.nth(0).get_by_role("button")).to_be_hidden()
    expect(rows.nth(0)).to_contain_text(re.compile(r"21\.3.s4"))
    expect(rows.nth(1)).to_have_attribute("data-status", "infeasible")
    expect(rows.nth(1)).to_contain_text("the left grip is 30 cm out of reach")
    dialog.get_by_role("button", name="Use Two SO-101").click()
    expect(dialog).to_be_hidden()
    expect(page.get_by_role("combobox", name="Robot")).to_have_value("so101-pair")
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_role("combobox", name="Robot")).to_have_value("pr2")


def test_a_robot_of_ones_own_is_brought_along_and_one_that_lacks_something_is_refused(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    card = json.dumps(box_card())
    whole = archive({"robot.json": card, "urdf/box.urdf": box_urdf()})
    handless = archive({"robot.json": card, "urdf/box.urdf": box_urdf(last="hand")})
    page.goto(new_sheet(napkin()).page_url)
    page.get_by_role("button", name="Import").click()
    dialog = page.get_by_role("dialog", name="Import")
    given = dialog.get_by_label("File")
    given.set_input_files({"name": "bench.zip", "mimeType": "application/zip", "buffer": handless})
    expect(dialog.get_by_role("alert")).to_contain_text("no moving joint 'left_wrist_roll'")
    given.set_input_files({"name": "bench.zip", "mimeType": "application/zip", "buffer": whole})
    expect(dialog).to_be_hidden()
    expect(page.get_by_role("combobox", name="Robot")).to_have_value("bench")
    expect(page.get_by_role("combobox", name="Robot")).to_contain_text("My bench")


def test_a_robot_without_a_card_is_drafted_and_what_was_guessed_is_corrected_and_saved(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    sheet = new_sheet(None)
    page.goto(sheet.page_url)
    page.get_by_role("button", name="Import").click()
    given = page.get_by_role("dialog", name="Import").get_by_label("File")
    given.set_input_files({"name": "My arm.urdf", "mimeType": "application/xml", "buffer": single_urdf().encode()})
    robot = page.get_by_role("dialog", name="My robot")
    expect(robot).to_be_visible()
    table = robot.get_by_label("Height of the table")
    expect(table).to_have_value("75.0")
    table.fill("high")
    table.press("Tab")
    expect(robot.get_by_role("alert")).to_contain_text("is no number")
    table.fill("70")
    table.press("Tab")
    expect(page.get_by_role("combobox", name="Robot")).to_have_value("my-arm@scene.table.height_m=0.7")
    sheet.edit(lambda drawing: drawing.update(comfort_radius_m=0.02))  # the drawing goes on with it
    robot.get_by_label("Name").fill("Bench arm")
    robot.get_by_role("button", name="Save the robot").click()
    expect(robot).to_be_hidden()
    expect(page.get_by_role("combobox", name="Robot")).to_have_value("my-arm")
    card = REST.get(f"{sheet.path.partition('/api/')[0]}/api/robots/my-arm").json()
    drawing = sheet.drawing
    assert (card["title"], card["scene"]["table"]["height_m"]) == ("Bench arm", 0.7)
    assert (drawing["robot"], drawing["scene"]["table"]["height_m"]) == ("my-arm", 0.7)
