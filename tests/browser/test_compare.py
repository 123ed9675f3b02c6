"""Two versions of a document side by side, played by one clock."""

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.browser.conftest import STAGE_PATIENCE_MS, Garment, Sheet
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


def test_two_versions_are_planned_shown_step_by_step_and_played_together(page: Page, moved: Sheet) -> None:
    page.get_by_role("button", name="Compare", exact=True).click()
    dialog = page.get_by_role("dialog", name="Two plans side by side")
    left, right = (dialog.locator(".compare-cost").nth(side) for side in (0, 1))
    expect(left).to_contain_text(" s", timeout=STAGE_PATIENCE_MS)  # its plan is searched for in a process of its own
    expect(right).to_contain_text(" s")
    expect(left).not_to_have_text(right.inner_text())
    rows = dialog.locator("tbody tr")
    expect(rows.first.locator(".compare-by")).to_have_text("=")  # the first fold is the same
    expect(dialog.locator(".is-missing").first).to_be_visible()  # the second is not there on the right
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
