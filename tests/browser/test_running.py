"""A run in the page: each step confirmed, stopped, and gone on with; the clock follows the robot."""

import json
from collections.abc import Callable
from typing import Any

from playwright.sync_api import Locator, Page, Route, expect

from tests.app.samples import towel
from tests.browser.conftest import Garment, Sheet
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned
from tests.required import required

RUN_MS = 120_000
"""Patience with a run in real time: jobs give way to all else."""


def ready(page: Page, sheet: Sheet) -> Locator:
    """Open a document's page and make ready for a run; return what is said of it."""
    page.goto(sheet.page_url)
    expect_planned(page)
    page.get_by_role("button", name="Run", exact=True).click()
    return page.locator(".running")


def test_a_run_is_confirmed_stopped_and_gone_on_with_to_its_end(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    said = ready(page, new_sheet(towel()))
    expect(said).to_contain_text("Next: step 1 of 1. Fold")
    go, stop, clock = said.get_by_role("button", name="Do step 1"), said.get_by_role("button", name="Stop"), "#time"
    go.click()
    expect(go).to_be_hidden()
    page.wait_for_function("document.querySelector('#time').value > 0.5", timeout=RUN_MS)
    stop.click()
    expect(said).to_contain_text("Stopped in step 1. Next: step 1 of 1.")
    expect(page.locator(clock)).to_have_value("0")
    said.get_by_role("button", name="All from here").click()
    expect(said).to_contain_text("Done: all 1 steps.", timeout=RUN_MS)
    page.wait_for_function("document.querySelector('#time').valueAsNumber > document.querySelector('#time').max - 0.1")
    said.get_by_role("button", name="Close").click()
    expect(said).to_be_hidden()


def test_why_a_run_ended_early_is_said_and_an_edit_ends_it(page: Page, new_sheet: Callable[[Garment], Sheet]) -> None:
    asked: list[dict[str, Any]] = []
    job = {"id": "7", "kind": "runs", "status": "done", "progress": 1.0, "message": ""}
    end = job | {"result": {"ended": "lost", "done": 0, "why": "no way leads there"}}

    def begin(route: Route) -> None:
        asked.append(required(route.request.post_data_json))
        route.fulfill(status=202, json=job)

    page.route("**/api/runs", begin)
    page.route(
        "**/api/jobs/7/events",
        lambda route: route.fulfill(
            headers={"content-type": "text/event-stream"}, body=f"event: end\ndata: {json.dumps(end)}\n\n"
        ),
    )
    sheet = new_sheet(napkin())
    said = ready(page, sheet)
    said.get_by_role("button", name="All from here").click()
    expect(said).to_contain_text("No way leads there. Next: step 1 of 4.")
    assert [(one["from_step"], one["until_step"]) for one in asked] == [(0, None)]
    sheet.edit(lambda drawing: drawing["placement"].update(y_m=-0.29))
    expect(said).to_be_hidden()
    expect_planned(page, sheet.state["version"])
    row = page.get_by_role("list", name="Plan").get_by_role("button").first
    row.click(button="right")
    page.get_by_role("menuitem", name="Run from here").click()
    expect(said).to_contain_text("Next: step 1 of")
