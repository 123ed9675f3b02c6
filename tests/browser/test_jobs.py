"""The list of jobs: there when there are jobs, led by keyboard, with what is running, a result and a way to cancel."""

import json
import re

import httpx
from playwright.sync_api import Page, expect

from tests.app.conftest import REST, Served
from tests.app.robot_archives import archive, box_card, box_urdf
from tests.browser.napkin import napkin
from tests.patience import PATIENCE_S

QUICK = {"garment": napkin(), "step_m": 0.5, "time_limit_s": 20.0}
LONG = {"garment": "shirt", "step_m": 0.02, "time_limit_s": 60.0}


def test_jobs_are_listed_cancelled_by_keyboard_and_lead_to_their_results(page: Page, served: Served) -> None:
    page.goto(served.url)
    expect(page.get_by_role("button", name="Undo")).to_be_attached()
    expect(page.get_by_role("button", name="Jobs")).to_be_hidden()
    with httpx.Client(base_url=served.url, timeout=PATIENCE_S) as rest:
        done = rest.post("/api/jobs/placements", json=QUICK).headers["location"]
        assert "event: end" in rest.get(f"{done}/events").text
        running = rest.post("/api/jobs/placements", json=LONG).headers["location"]
    page.evaluate("dispatchEvent(new Event('focus'))")
    page.get_by_role("button", name="Jobs").press("Enter")
    rows = page.get_by_role("dialog", name="Jobs").get_by_role("listitem")
    expect(rows).to_have_count(2)
    expect(rows.nth(0).get_by_role("progressbar")).to_be_visible()
    expect(rows.nth(0)).to_have_text(re.compile(r"Placements, Child's long-sleeved shirt, .*Running\s*\d+\s%\s*Stop"))
    rows.nth(1).get_by_role("button", name="Result").press("Enter")
    result = page.get_by_role("dialog", name=re.compile("Placements, Napkin"))
    expect(result.get_by_role("columnheader", name="cost (s)")).to_be_visible()
    expect(result.get_by_role("link", name="As JSON")).to_have_attribute("href", f"..{done}")
    page.keyboard.press("Escape")
    rows.nth(0).get_by_role("button", name="Stop").press("Enter")
    expect(rows.nth(0).get_by_role("status")).to_have_text("Stopped")
    assert REST.get(f"{served.url}{running}").json()["status"] == "cancelled"


def test_a_robot_that_a_job_has_imported_can_be_chosen_at_once(page: Page, served: Served) -> None:
    page.goto(served.url)
    robots = page.get_by_role("combobox", name="Robot")
    expect(robots.locator("option")).not_to_have_count(0)
    packed = archive({"robot.json": json.dumps(box_card()), "urdf/box.urdf": box_urdf()})
    headers = {"content-type": "application/zip"}
    assert REST.post(f"{served.url}/api/robots/imports", content=packed, headers=headers).status_code == 201
    now = "2026-01-01T00:00:00.000Z"
    job = {"id": "a", "kind": "robots", "status": "done", "progress": 1.0, "message": "", "created": now}
    listed = {"jobs": [{**job, "started": now, "ended": now}], "before": None}
    page.route("**/api/jobs?*", lambda route: route.fulfill(json=listed))
    page.evaluate("dispatchEvent(new Event('focus'))")
    expect(robots.locator("option", has_text="My bench")).to_have_count(0)
    page.get_by_role("button", name="Jobs").press("Enter")
    expect(page.get_by_role("dialog", name="Jobs").get_by_role("listitem")).to_contain_text("Import of a robot, ")
    expect(robots.locator("option", has_text="My bench")).to_have_count(1)
