"""A rehearsal in the page: begun, cancelled, each step's fate, its pictures, many runs, and a plan from there."""

import base64
import json
import re
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from typing import Any

import cv2
import numpy as np
import pytest
from playwright.sync_api import Browser, Locator, Page, Route, expect

from tests.app.rehearsal.test_rehearsal_routes import NAPKIN
from tests.browser.board.conftest import desk as desk
from tests.browser.board.conftest import page as page
from tests.browser.board_desk import Desk
from tests.browser.conftest import Garment, Sheet, windows
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned
from tests.required import required

JOB = {"id": "7", "kind": "rehearsals", "progress": 0.4, "message": "", "created": "2026-01-01T00:00:00Z"}
SIMULATED_MS = 600_000
"""Patience with a rehearsal: jobs give way to all else."""

PHONE = {"width": 390, "height": 844}


def run(trace: str | None = None, **verdict: object) -> dict[str, Any]:
    step = {"step": 0, "of_plan": 0, "iou": 0.97, "mean_mm": 4.2, "p95_mm": 9.0, "slid_mm": 1.0, "held": True} | verdict
    counts = {"regrasps": 1, "repairs": 0, "replans": 0, "reason": "", "decisions": []}
    return {"held": step["held"], "steps": [step], "final_iou": 0.97, "trace": trace, **counts}


def summary(*runs: dict[str, Any]) -> dict[str, Any]:
    held = sum(one["held"] for one in runs)
    return {"runs": list(runs), "held": held, "of": len(runs), "success_low": 0.4928, "success_high": 0.9433}


def square(side_m: float, x_m: float) -> list[list[float]]:
    return [[x_m, 0.0], [x_m + side_m, 0.0], [x_m + side_m, side_m], [x_m, side_m]]


def look(**changes: object) -> dict[str, Any]:
    _, jpeg = cv2.imencode(".jpg", np.full((48, 64, 3), 120, np.uint8))
    fit = {"placement": {"x_m": -0.68, "y_m": -0.3, "yaw_rad": 0.0}, "error_m": 0.004}
    return {
        "step": 0,
        "of_plan": 0,
        "is_clear": False,
        "size_px": [64, 48],
        "jpeg": base64.b64encode(bytes(jpeg)).decode(),
        "fit": fit,
        "fitted_px": square(20.0, 15.0),
        "expected_px": square(20.0, 12.0),
        "known": True,
        "reason": None,
        "says": None,
        "start": {"folds_done": [], "placement": fit["placement"]},
        **changes,
    }


class Rehearsals:
    """A server whose rehearsals end when and how a test says."""

    def __init__(self, page: Page, **pictured: object) -> None:
        self.asked: list[dict[str, Any]] = []
        self.cancelled = 0
        self.job: dict[str, Any] = JOB | {"status": "running", "result": None}
        steps = [{"of_plan": 0, "found": [square(0.3, 0.02)], "planned": [square(0.3, 0.0)]}]
        self.trace = {"steps": steps, "pictures": [look(**pictured)]}
        page.route("**/api/rehearsals", self._begin)
        page.route("**/api/rehearsals/traces/*", lambda route: route.fulfill(json=self.trace))
        page.route("**/api/jobs/7", lambda route: route.fulfill(json=self.job))
        page.route("**/api/jobs/7/events", self.tell)
        page.route("**/api/jobs/7/cancel", self._cancel)

    def begun_by(self, button: Locator) -> None:
        """Press a button and wait for the rehearsal that it begins."""
        with button.page.expect_response("**/api/rehearsals"):
            button.click()

    def end(self, *runs: dict[str, Any]) -> None:
        self.job = JOB | {"status": "done", "result": summary(*runs)}

    def tell(self, route: Route) -> None:
        """Answer with one event: a page whose stream ends before the rehearsal does asks again."""
        event = "end" if self.job["status"] == "done" else "progress"
        route.fulfill(content_type="text/event-stream", body=f"event: {event}\ndata: {json.dumps(self.job)}\n\n")

    def _begin(self, route: Route) -> None:
        self.asked.append(required(route.request.post_data_json))
        self.job = JOB | {"status": "running", "result": None}
        route.fulfill(status=202, json=self.job)

    def _cancel(self, route: Route) -> None:
        self.cancelled += 1
        route.fulfill(json=self.job | {"status": "cancelled"})


@pytest.fixture(autouse=True)
def unrouted(page: Page) -> Iterator[None]:
    """Leave the page, which all tests share, without answers of this test."""
    yield
    page.unroute_all()


def opened(desk: Desk, garment: dict[str, Any] | None = None) -> Locator:
    """Lay out a garment, or else the napkin, and return the button to rehearse its plan."""
    desk.lay(garment or napkin())
    expect_planned(desk.page, desk.state["version"])
    return to_rehearse(desk.page)


def to_rehearse(page: Page) -> Locator:
    return page.get_by_role("button", name="Rehearse", exact=True)


def rehearsed(desk: Desk, *runs: dict[str, Any], **pictured: object) -> Rehearsals:
    """Rehearse the napkin's plan, and wait for the marks of a run."""
    server = Rehearsals(desk.page, **pictured)
    server.begun_by(opened(desk))
    server.end(*runs)
    expect(desk.page.locator(".mark")).to_have_count(1)
    return server


def test_a_rehearsal_tells_of_each_step_what_became_of_it(page: Page, desk: Desk) -> None:
    server = Rehearsals(page)
    begin, said = opened(desk), page.locator(".rehearsing")
    in_row, mark, pill = page.locator(".plan-row .plan-verdict"), page.locator(".mark"), page.locator("#status")
    begin.click()
    expect(said.get_by_role("progressbar")).to_have_js_property("value", 0.4)
    said.get_by_role("button", name="Stop").click()
    expect(said).to_be_hidden()
    assert server.cancelled == 1

    server.begun_by(begin)
    server.end(run(slid_mm=12.3))
    expect(said).to_contain_text(
        "Every step holds in simulated physics, at most 4 mm off on average, one grasp tried again."
    )
    for one in (in_row, mark):
        expect(one).to_have_text("slid 12 mm")
    expect(page.get_by_role("group", name="Rehearsed").get_by_role("button", name="After step 1")).to_be_visible()
    expect(pill).not_to_contain_text("Rehearsed")

    server.begun_by(begin)
    expect(mark).to_have_count(0)
    server.end(run(held=False, mean_mm=31.0))
    expect(said).to_contain_text("Lost at step 1: the cloth is 31 mm off on average.")
    for one in (in_row, mark):
        expect(one).to_have_text("lost")
    expect(pill).to_contain_text("Rehearsed: step 1 lost. Planned:")
    said.get_by_role("button", name="Close").click()
    for one in (in_row, mark):
        expect(one).to_have_count(0)
    expect(pill).not_to_contain_text("Rehearsed")


@pytest.mark.parametrize(
    ("decisions", "why"),
    [
        (["seen", "kept_blindly"], "before step 2: the camera could not locate the cloth."),
        (["replanned"], "before step 2: from where the cloth lies there is no plan."),
        (["replanned"] * 4, "before step 2, which failed though the rest was planned again 3 times."),
        ([], "before the last step."),
    ],
)
def test_why_a_run_ended_early_is_said(page: Page, desk: Desk, decisions: list[str], why: str) -> None:
    decided = [{"step": 1, "code": code} for code in decisions]
    ended = run() | {"held": False, "reason": "for one", "replans": decisions.count("replanned"), "decisions": decided}
    rehearsed(desk, ended)
    expect(page.locator(".rehearsing")).to_contain_text(f"The rehearsal ended {why}")
    expect(page.locator("#status")).to_contain_text("Rehearsed: does not hold. Planned:")


def test_a_mark_leads_to_the_end_of_its_step(page: Page, desk: Desk) -> None:
    rehearsed(desk, run())
    page.locator(".mark").click()
    first = page.get_by_role("list", name="Plan").get_by_role("button").first.inner_text()
    ends_s = re.search(r"([\d.]+) s", first)
    assert ends_s is not None
    expect(page.locator(".clock")).to_contain_text(f"{ends_s[1]} / ")


def test_of_many_runs_each_is_a_square_that_can_be_looked_at(page: Page, desk: Desk) -> None:
    server = Rehearsals(page)
    begin, said = opened(desk), page.locator(".rehearsing")
    server.begun_by(begin)
    server.end(run())
    often = said.get_by_role("button", name="10 times with errors")
    server.begun_by(often)
    early = run() | {"held": False, "reason": "planned again too often"}
    server.end(*[run(mean_mm=float(n)) for n in range(7)], run(held=False, mean_mm=95.0), early, run())
    expect(said).to_contain_text("Held in 8 of 10 runs: 49 to 94 % of all, with 95 % confidence.")
    assert [(one["runs"], one["noise"]) for one in server.asked] == [(1, "none"), (10, "real")]
    squares = said.get_by_role("group", name="Runs by how far").get_by_role("button")
    expect(squares).to_have_count(10)
    columns = said.locator(".runs-column")
    counts = [column.locator("button").count() for column in columns.all()]
    assert counts == [6, 2, 0, 0, 0, 0, 0, 0, 1, 1]
    expect(columns.last).to_contain_text("ended early")
    lost = said.get_by_role("button", name="Run 8: lost, at most 95 mm off on average")
    expect(lost).to_have_attribute("aria-pressed", "true")
    expect(page.locator(".mark")).to_have_text("lost")
    held = said.get_by_role("button", name="Run 3: held, at most 2 mm off on average")
    held.click()
    expect(held).to_have_attribute("aria-pressed", "true")
    expect(lost).to_have_attribute("aria-pressed", "false")
    expect(page.locator(".mark")).to_have_text("held")


def test_the_corner_shows_what_was_seen_and_what_became_of_the_cloth(page: Page, desk: Desk) -> None:
    rehearsed(desk, run("trace"))
    card = page.get_by_role("region", name="Pictures of the rehearsal")
    expect(card.get_by_text("Seen before step 1")).to_be_visible()
    expect(card).to_contain_text("±0.4 cm")
    expect(card.locator(".looked image")).to_have_attribute("href", re.compile("^data:image/jpeg;base64,/9j/"))
    expect(card.locator(".looked-fitted.is-over")).to_have_count(1)
    expect(card.get_by_text("After step 1")).to_have_count(0)
    page.locator(".mark").click()
    expect(card.get_by_text("After step 1: held")).to_be_visible()
    difference = card.locator(".rehearsed-difference").get_attribute("d") or ""
    assert difference.count("M") == 2, "of the two outlines, which the rule of odd and even makes the difference"
    for picture in ("After step 1: held", "Seen before step 1"):
        card.get_by_role("button", name=picture).click()
        larger = page.get_by_role("dialog", name=picture)
        expect(larger.locator("svg").last).to_be_visible()
        page.keyboard.press("Escape")
        expect(larger).to_have_count(0)
    card.get_by_role("button", name="Hide the pictures").click()
    expect(card.locator("figure").first).to_be_hidden()
    card.get_by_role("button", name="Show the pictures").click()
    expect(card.locator("figure").first).to_be_visible()
    page.locator(".rehearsing").get_by_role("button", name="Close").click()
    expect(card).to_be_hidden()


def test_the_rest_is_planned_from_what_is_seen(page: Page, desk: Desk) -> None:
    rehearsed(desk, run("trace", held=False))
    page.get_by_role("button", name="Plan from what is seen").click()
    expect(page.locator(".start-line")).to_contain_text("Planned from the middle: nothing folded yet")
    expect_planned(page)
    expect(page.locator(".mark")).to_have_count(0)
    expect(page.get_by_role("region", name="Pictures of the rehearsal")).to_be_hidden()
    expect(page.get_by_role("button", name="Rehearse", exact=True)).to_be_visible()


def test_where_it_is_not_known_where_the_cloth_lies_nothing_is_planned_from_there(page: Page, desk: Desk) -> None:
    unknown = {"known": False, "reason": "almost all of the outline is hidden", "says": {"code": "outline_hidden"}}
    rehearsed(desk, run("trace"), **unknown, fit=None, fitted_px=[], start=None)
    card = page.get_by_role("region", name="Pictures of the rehearsal")
    expect(card).to_contain_text("The camera could not locate the cloth: almost all of the outline is hidden.")
    expect(card.get_by_role("button", name="Plan from what is seen")).to_be_disabled()


def test_a_page_loaded_anew_finds_its_rehearsal_again(page: Page, desk: Desk) -> None:
    server = Rehearsals(page)
    said = page.locator(".rehearsing")
    server.begun_by(opened(desk))
    expect(said.get_by_role("progressbar")).to_have_js_property("value", 0.4)  # by then the page has its id
    page.reload()
    expect(said.get_by_role("progressbar")).to_be_visible()
    server.end(run())
    expect(page.locator(".mark")).to_have_text("held")
    page.reload()
    expect(page.locator(".mark")).to_have_text("held")
    assert (len(server.asked), server.cancelled) == (1, 0)
    said.get_by_role("button", name="Close").click()
    page.reload()
    expect_planned(page)
    expect(page.get_by_role("button", name="Rehearse", exact=True)).to_be_enabled()
    expect(said).to_be_hidden()


def test_a_rehearsal_is_found_again_though_the_page_went_while_it_asked_how_far_it_is(page: Page, desk: Desk) -> None:
    server = Rehearsals(page)
    server.begun_by(opened(desk))
    expect(page.locator(".rehearsing").get_by_role("progressbar")).to_have_js_property("value", 0.4)
    page.unroute("**/api/jobs/7/events")
    with page.expect_request("**/api/jobs/7/events"):
        page.route("**/api/jobs/7/events", lambda _: None)  # no answer any more
    page.reload()
    page.unroute("**/api/jobs/7/events")
    server.end(run())
    page.route("**/api/jobs/7/events", server.tell)
    page.reload()
    expect(page.locator(".mark")).to_have_text("held")


def test_a_rehearsal_is_found_again_though_the_page_went_before_it_knew_its_number(page: Page, desk: Desk) -> None:
    server = Rehearsals(page)
    begin = opened(desk)
    page.unroute("**/api/rehearsals")
    page.route("**/api/rehearsals", lambda _: None)
    with page.expect_request("**/api/rehearsals"):
        begin.click()
    server.end(run())
    begun = server.job | {"about": "Napkin", "created": datetime.now(UTC).isoformat()}
    listed = {"jobs": [begun | {"kind": "runs", "id": "8"}, begun], "before": None}
    page.route("**/api/jobs?*", lambda route: route.fulfill(json=listed))
    page.reload()
    expect(page.locator(".mark")).to_have_text("held")


def test_the_result_of_a_rehearsal_is_told_in_words_and_shown_in_the_3d_view(page: Page, desk: Desk) -> None:
    server = Rehearsals(page)
    server.begun_by(opened(desk))
    server.end(run("trace", held=False, mean_mm=31.0))
    expect(page.locator(".mark")).to_have_text("lost")
    page.locator(".rehearsing").get_by_role("button", name="Close").click()
    listed = {"jobs": [server.job | {"about": "Napkin", "started": None, "ended": None}], "before": None}
    page.route("**/api/jobs?*", lambda route: route.fulfill(json=listed))
    page.evaluate("dispatchEvent(new Event('focus'))")
    page.get_by_role("button", name="Jobs").click()
    page.get_by_role("button", name="Result of Rehearsal").click()
    result = page.get_by_role("dialog", name=re.compile("^Rehearsal, Napkin"))
    expect(result).to_contain_text("Held in 0 of 1 run: 49 to 94 % of all, with 95 % confidence.")
    expect(result).to_contain_text("Run 1: Lost at step 1: the cloth is 31 mm off on average.")
    for raw in ("success", "trace", "iou"):
        expect(result).not_to_contain_text(raw)
    expect(result.get_by_role("link", name="As JSON")).to_be_visible()
    result.get_by_role("button", name="Show in the 3D view").click()
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(page.locator(".mark")).to_have_text("lost")
    expect(page.get_by_role("region", name="Pictures of the rehearsal")).to_be_visible()
    assert (len(server.asked), server.cancelled) == (1, 0)


def test_the_result_of_another_documents_rehearsal_leads_to_that_document(
    page: Page, desk: Desk, new_sheet: Callable[[Garment], Sheet]
) -> None:
    server = Rehearsals(page)
    server.begun_by(opened(desk))
    server.end(run("trace"))
    expect(page.locator(".mark")).to_have_text("held")
    address = page.url
    listed = {"jobs": [server.job | {"about": "Napkin", "started": None, "ended": None}], "before": None}
    page.route("**/api/jobs?*", lambda route: route.fulfill(json=listed))
    page.goto(new_sheet(napkin()).page_url)
    page.get_by_role("button", name="Jobs").click()
    page.get_by_role("button", name="Result of Rehearsal").click()
    page.get_by_role("button", name="Open its document").click()
    expect(page.locator(".mark")).to_have_text("held")
    assert page.url == address


def test_an_edit_takes_the_rehearsal_back(page: Page, desk: Desk) -> None:
    server = Rehearsals(page)
    server.begun_by(opened(desk))
    expect(page.locator(".rehearsing").get_by_role("progressbar")).to_be_visible()
    with page.expect_response("**/api/jobs/7/cancel"):
        desk.edit(lambda drawing: drawing["placement"].update(y_m=-0.29))
    expect(page.locator(".rehearsing")).to_be_hidden()


def test_why_there_is_no_rehearsal_is_said(page: Page, desk: Desk) -> None:
    begin = opened(desk)
    says = {"code": "library_missing", "library": "MuJoCo", "install": "pip install this"}
    error = {"field": "", "message": "MuJoCo is missing", "says": says}
    refusal = {"title": "Unprocessable", "status": 422, "detail": "", "errors": [error]}
    page.route("**/api/rehearsals", lambda route: route.fulfill(status=422, json=refusal))
    begin.click()
    expect(page.locator(".rehearsing")).to_contain_text("pip install this")
    expect(begin).to_be_enabled()


def test_on_a_phone_the_pictures_are_in_the_sheet(chromium: Browser, new_sheet: Callable[[Garment], Sheet]) -> None:
    with windows(chromium, viewport=PHONE, has_touch=True, is_mobile=True) as context:
        page = context.new_page()
        server = Rehearsals(page)
        page.goto(new_sheet(napkin()).page_url)
        expect_planned(page)
        page.locator("#sheet").tap()
        with page.expect_response("**/api/rehearsals"):
            to_rehearse(page).tap()
        server.end(run("trace"))
        card = page.locator(".rehearsing").get_by_role("region", name="Pictures of the rehearsal")
        expect(card.get_by_text("Seen before step 1")).to_be_visible()
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


@pytest.mark.long
def test_a_small_napkin_is_rehearsed_and_planned_from_what_is_seen(page: Page, desk: Desk) -> None:
    opened(desk, {**NAPKIN, "title": "Small napkin"}).click()
    told = "Every step holds in simulated physics"
    expect(page.locator(".rehearsing")).to_contain_text(told, timeout=SIMULATED_MS)
    expect(page.locator(".mark")).to_have_count(1)
    page.locator(".mark").click()
    card = page.get_by_role("region", name="Pictures of the rehearsal")
    expect(card.get_by_text("After step 1")).to_be_visible()
    expect(card.get_by_text("Seen before step 1")).to_be_visible()
    card.get_by_role("button", name="Plan from what is seen").click()
    expect(page.locator(".start-line")).to_contain_text("Planned from the middle: nothing folded yet")
    expect_planned(page)
    expect(card).to_be_hidden()
