"""A rehearsal in the page: begun, cancelled, and what became of each step."""

from collections.abc import Callable
from typing import Any

from playwright.sync_api import Locator, Page, Route, expect

from tests.browser.conftest import Garment, Sheet
from tests.browser.napkin import napkin

JOB = {"id": "7", "kind": "rehearsals", "progress": 0.4, "message": "", "created": "2026-01-01T00:00:00Z"}


def run(**verdict: object) -> dict[str, Any]:
    step = {"step": 0, "iou": 0.97, "mean_mm": 4.2, "p95_mm": 9.0, "slid_mm": 1.0, "held": True} | verdict
    return {"held": step["held"], "steps": [step], "final_iou": 0.97, "regrasps": 1, "replans": 0}


def summary(*runs: dict[str, Any]) -> dict[str, Any]:
    held = sum(one["held"] for one in runs)
    return {"runs": list(runs), "held": held, "of": len(runs), "success_low": 0.4928, "success_high": 0.9433}


class Rehearsals:
    """A server whose rehearsals end when and how a test says."""

    def __init__(self, page: Page) -> None:
        self.asked: list[dict[str, Any]] = []
        self.cancelled = 0
        self.job: dict[str, Any] = JOB | {"status": "running", "result": None}
        page.route("**/api/rehearsals", self._begin)
        page.route("**/api/jobs/7", lambda route: route.fulfill(json=self.job))
        page.route("**/api/jobs/7/cancel", self._cancel)

    def begun_by(self, button: Locator) -> None:
        """Press a button and wait for the rehearsal that it begins."""
        with button.page.expect_response("**/api/rehearsals"):
            button.click()

    def end(self, *runs: dict[str, Any]) -> None:
        self.job = JOB | {"status": "done", "result": summary(*runs)}

    def _begin(self, route: Route) -> None:
        self.asked.append(route.request.post_data_json)
        self.job = JOB | {"status": "running", "result": None}
        route.fulfill(status=202, json=self.job)

    def _cancel(self, route: Route) -> None:
        self.cancelled += 1
        route.fulfill(json=self.job | {"status": "cancelled"})


def test_a_rehearsal_tells_of_each_step_what_became_of_it(page: Page, new_sheet: Callable[[Garment], Sheet]) -> None:
    server = Rehearsals(page)
    page.goto(new_sheet(napkin()).page_url)
    begin, said = page.get_by_role("button", name="Rehearse"), page.locator(".rehearsing")
    mark = page.locator(".plan-row .plan-verdict")
    begin.click()
    expect(said.get_by_role("progressbar")).to_be_visible()
    said.get_by_role("button", name="Cancel").click()
    expect(said).to_be_hidden()
    assert server.cancelled == 1

    server.begun_by(begin)
    server.end(run(slid_mm=12.3))
    expect(said).to_contain_text(
        "Every step holds in simulated physics, at most 4 mm off on average, one grasp tried again."
    )
    expect(mark).to_have_text("slid 12 mm")
    expect(page.get_by_role("button", name="slid 12 mm")).to_be_visible()

    server.begun_by(said.get_by_role("button", name="10 times with errors"))
    expect(mark).to_have_count(0)
    server.end(*[run()] * 8, *[run(held=False)] * 2)
    expect(said).to_contain_text("Held in 8 of 10 runs: 49 to 94 % of all, with 95 % confidence.")
    assert [(one["runs"], one["noise"]) for one in server.asked] == [(1, "none"), (1, "none"), (10, "real")]

    server.begun_by(begin)
    server.end(run(held=False, mean_mm=31.0))
    expect(said).to_contain_text("Lost at step 1: the cloth is 31 mm off on average.")
    expect(mark).to_have_text("lost")
    said.get_by_role("button", name="Close").click()
    expect(mark).to_have_count(0)
