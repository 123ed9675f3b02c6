"""The list of jobs: there when there are jobs, led by keyboard, with what is running, a result and a way to cancel."""

import httpx
from playwright.sync_api import Page, expect

from tests.app.conftest import REST, Served
from tests.patience import PATIENCE_S

QUICK = {"garment": "hand-towel", "step_m": 0.5, "time_limit_s": 20.0}
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
    expect(rows.nth(1).get_by_role("link")).to_have_attribute("href", f"..{done}")
    rows.nth(0).get_by_role("button", name="Cancel").press("Enter")
    expect(rows.nth(0).get_by_role("status")).to_have_text("Cancelled")
    assert REST.get(f"{served.url}{running}").json()["status"] == "cancelled"
