"""Two plans side by side, played by one clock: of a document's versions, of other documents, stored ones."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl, urlencode, urlsplit, urlunsplit

import pytest
from playwright.sync_api import Locator, Page, Route, expect

from planner import load_garment
from tests.app.conftest import REST, Served
from tests.browser.board.conftest import page as page
from tests.browser.conftest import VIEW_PATIENCE_MS, Garment, Sheet
from tests.browser.status_pill import expect_planned


@pytest.fixture
def moved(page: Page, new_sheet: Callable[[Garment], Sheet]) -> Sheet:
    """Return a hand towel of two versions: as it is, and folded once less."""
    sheet = new_sheet("hand-towel")

    def shorten(drawing: dict[str, Any]) -> None:
        drawing["folds"] = drawing["folds"][:1]

    sheet.edit(shorten)
    page.goto(sheet.page_url)
    expect_planned(page)
    return sheet


def pictures(dialog: Locator) -> list[str]:
    return [picture.inner_html() for picture in dialog.locator(".compare-picture").all()]


def sides_m(cloth: Locator) -> list[float]:
    """Return the depth and width of a piece of cloth in a picture (m)."""
    points = re.findall(r"(-?[\d.]+) (-?[\d.]+)", cloth.get_attribute("d") or "")
    return [max(along) - min(along) for along in zip(*(map(float, point) for point in points), strict=True)]


def test_two_versions_are_planned_shown_step_by_step_and_played_together(page: Page, moved: Sheet) -> None:
    page.get_by_role("button", name="Compare", exact=True).click()
    dialog = page.get_by_role("dialog", name="Two plans side by side")
    left, right = (dialog.locator(".compare-cost").nth(side) for side in (0, 1))
    expect(left).to_contain_text(" s", timeout=VIEW_PATIENCE_MS)  # its plan is searched for in a process of its own
    expect(right).to_contain_text(" s")
    expect(left).not_to_have_text(right.inner_text())
    rows = dialog.locator("tbody tr")
    expect(rows.first.locator(".compare-by")).to_have_text("=")  # the first fold is the same
    expect(dialog.locator(".is-missing").first).to_be_visible()  # the second is not there on the right
    for picture in dialog.locator(".compare-picture").all():
        assert sides_m(picture.locator(".cloth").first) == pytest.approx([0.419, 0.686], abs=1e-3)
    before = pictures(dialog)
    dialog.get_by_role("button", name="Play").click()
    expect(dialog.get_by_role("button", name="Pause")).to_be_visible()
    expect(dialog.locator("td.is-now")).to_have_count(2)
    page.wait_for_function("Number(document.querySelector('.compare-slider').value) > 0.5")
    dialog.get_by_role("button", name="Pause").click()
    after = pictures(dialog)
    assert all(one != other for one, other in zip(before, after, strict=True))
    dialog.get_by_label("Left").select_option("0")
    expect(left).to_have_text(right.inner_text())
    expect(dialog.locator(".is-missing")).to_have_count(0)
    expect(dialog.locator(".compare-sum td").last).to_have_text("=")


def test_another_document_and_a_plan_by_its_id_or_its_file_are_compared_in_the_same_dialog(
    page: Page, moved: Sheet, new_sheet: Callable[[Garment], Sheet], designer: Served, tmp_path: Path
) -> None:
    new_sheet({**load_garment("letter-towel").to_dict(), "title": "Elsewhere folded"})
    wanted = {"garment": "hand-towel", "time_limit_s": 60.0}
    stored = REST.post(f"{designer.url}/api/plans", json=wanted).raise_for_status().json()
    file = tmp_path / "kept.plan.json"
    file.write_bytes(REST.get(f"{designer.url}/api/plans/{stored['id']}/file").raise_for_status().content)
    page.get_by_role("button", name="Compare", exact=True).click()
    dialog = page.get_by_role("dialog", name="Two plans side by side")
    left, right = dialog.get_by_label("Left"), dialog.get_by_label("Right")
    costs = [dialog.locator(".compare-cost").nth(side) for side in (0, 1)]

    other = left.locator("optgroup[label='Other documents'] option", has_text="Elsewhere folded").first
    left.select_option(value=other.get_attribute("value"))
    expect(costs[0]).to_contain_text("steps")

    right.select_option(label="A plan by its file or id…")
    dialog.get_by_label("Id of a plan").last.fill("nowhere")
    dialog.get_by_role("button", name="Show").last.click()
    expect(costs[1]).to_contain_text("nowhere")
    dialog.get_by_label("Id of a plan").last.fill(stored["id"])
    dialog.get_by_role("button", name="Show").last.click()
    expect(costs[1]).to_have_text(f"{len(stored['primitives'])} steps, {stored['cost_s']:.1f} s")

    left.select_option(label="A plan by its file or id…")
    dialog.get_by_label("Choose a file").first.set_input_files(file)
    expect(costs[0]).to_have_text(costs[1].inner_text())
    expect(dialog.locator(".compare-sum td").last).to_have_text("=")
    assert len(right.locator("optgroup[label='Plans'] option").all()) == 3  # both plans, and the way to another one


def test_every_other_document_can_be_chosen_however_many_pages_list_them(
    page: Page, moved: Sheet, new_sheet: Callable[[Garment], Sheet], designer: Served
) -> None:
    for title in ("First of the pages", "Second of the pages", "Third of the pages"):
        new_sheet({**load_garment("letter-towel").to_dict(), "title": title})
    listing = f"{designer.url}/api/documents"

    def in_short_pages(route: Route) -> None:
        here = urlsplit(route.request.url)
        asked = {**dict(parse_qsl(here.query)), "limit": "2"}
        route.continue_(url=urlunsplit(here._replace(query=urlencode(asked))))

    page.route(re.compile(re.escape(listing) + r"(\?.*)?$"), in_short_pages)
    page.get_by_role("button", name="Compare", exact=True).click()
    others = page.get_by_role("dialog").get_by_label("Left").locator("optgroup[label='Other documents'] option")
    for title in ("First", "Second", "Third"):
        expect(others.filter(has_text=f"{title} of the pages")).not_to_have_count(0)


def test_a_plan_file_dropped_on_a_side_is_shown_there_and_one_that_is_none_is_refused(
    page: Page, moved: Sheet, designer: Served
) -> None:
    wanted = {"garment": "hand-towel", "time_limit_s": 60.0}
    stored = REST.post(f"{designer.url}/api/plans", json=wanted).raise_for_status().json()
    text = REST.get(f"{designer.url}/api/plans/{stored['id']}/file").raise_for_status().text
    page.get_by_role("button", name="Compare", exact=True).click()
    dialog = page.get_by_role("dialog", name="Two plans side by side")
    cost = dialog.locator(".compare-cost").first
    expect(cost).to_contain_text(" s", timeout=VIEW_PATIENCE_MS)
    drop = """(side, text) => {
      const data = new DataTransfer();
      data.items.add(new File([text], "kept.plan.json"));
      side.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
    }"""
    side = dialog.locator(".compare-side").first
    side.evaluate(drop, "{}")
    expect(cost).to_contain_text("kept.plan.json is no plan")
    expect(dialog).to_be_visible()
    side.evaluate(drop, text)
    expect(cost).to_have_text(f"{len(stored['primitives'])} steps, {stored['cost_s']:.1f} s")


def test_where_there_is_nothing_to_compare_with_a_plan_is_asked_for(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    page.goto(new_sheet("hand-towel").page_url)
    expect_planned(page)
    page.route("**/api/documents?limit=500", lambda route: route.fulfill(json=[]))
    page.get_by_role("button", name="Compare", exact=True).click()
    dialog = page.get_by_role("dialog", name="Two plans side by side")
    expect(dialog.get_by_label("Id of a plan").first).to_be_visible()
    expect(dialog.get_by_label("Id of a plan").nth(1)).to_be_hidden()
    left, right = (dialog.locator(".compare-cost").nth(side) for side in (0, 1))
    expect(right).to_contain_text(" s")
    expect(left).to_have_text("")
