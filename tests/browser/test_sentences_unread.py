"""With rubbish in place of every sentence of the server that has numbers, the page still shows all messages."""

import json
import re
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, Route, WebSocketRoute, expect

from tests.browser.conftest import Garment, Sheet

NewSheet = Callable[[Garment], Sheet]

RUBBISH = "RUBBISH 0 at (0.25, 0.75) m"
APRON: dict[str, Any] = {
    "name": "apron",
    "outline": [[0.0, 0.0], [0.6, 0.0], [0.6, 0.4], [0.42, 0.75], [0.18, 0.75], [0.0, 0.4]],
    "folds": [{"name": "half", "kind": "blue", "start": [0.3, 0.0], "end": [0.3, 0.75]}],
}


def spoilt(told: Any) -> Any:
    """Return a message with rubbish for every sentence that has data."""
    if isinstance(told, list):
        return [spoilt(one) for one in told]
    if not isinstance(told, dict):
        return told
    made = {name: spoilt(value) for name, value in told.items()}
    if told.get("says"):
        made |= {name: RUBBISH for name in ("message", "label", "reason") if name in told}
    return made


def spoil(page: Page) -> None:
    """Replace the sentences that the page receives by rubbish, over REST and the websocket."""

    def socket(there: WebSocketRoute) -> None:
        server = there.connect_to_server()
        server.on_message(lambda text: there.send(json.dumps(spoilt(json.loads(text)))))

    def answer(route: Route) -> None:
        fetched = route.fetch()
        route.fulfill(response=fetched, json=spoilt(fetched.json()))

    page.route_web_socket("**/live", socket)
    page.route("**/files", answer)


@pytest.fixture
def apron(page: Page, new_sheet: NewSheet) -> Sheet:
    sheet = new_sheet(APRON)
    spoil(page)
    page.goto(sheet.page_url)
    expect(page.get_by_role("status")).to_have_attribute("data-status", "infeasible")
    return sheet


def test_a_reason_is_told_from_its_numbers(page: Page, apron: Sheet) -> None:
    expect(page.get_by_role("status")).to_have_text(
        re.compile(r"^No plan: Half: needs more hands than there are, unless one holds all within [\d.]+ cm$")
    )
    reasons = page.get_by_role("list", name="Reasons")
    expect(reasons).to_contain_text("12.7 cm")  # what one grip holds round itself
    page.get_by_role("button", name="Unit: cm").click()
    expect(reasons).to_contain_text("5 in")
    page.get_by_role("button", name="Export", exact=True).click()
    row = page.get_by_role("listitem").filter(has_text="Plan (CSV)")
    expect(row).to_contain_text("There is no plan: \u201chalf\u201d: ")
    assert "RUBBISH" not in page.locator("body").inner_text()


def test_what_is_wrong_with_a_drawing_and_what_fixes_it_is_told_in_one_way_everywhere(page: Page, apron: Sheet) -> None:
    def crossing(drawing: dict[str, Any]) -> None:
        points = [[0.0, 0.0], [0.5, 0.5], [0.5, 0.0], [0.0, 0.5]]
        drawing["outline"] = [{"id": f"v{number}", "point": point} for number, point in enumerate(points)]
        drawing["folds"] = []

    apron.edit(crossing)
    told = "dges 1 and 3 cross at (25, 25) cm of the garment"
    for place in (page.get_by_role("status"), page.locator(".reason"), page.locator(".callout")):
        expect(place).to_contain_text(told)
    fixes = page.get_by_role("group", name="Suggestions").get_by_role("button")
    expect(fixes.first).to_have_text("Exchange the two corners")
    assert "RUBBISH" not in page.locator("body").inner_text()
