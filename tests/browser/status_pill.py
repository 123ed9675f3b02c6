"""The status that the page shows for its document."""

import re

from playwright.sync_api import Page, expect

from tests.browser.searches import SEARCH_MS


def expect_planned(page: Page, version: int | None = None) -> None:
    """Expect the final plan, of a version of the drawing if one is given: after an edit, the former plan stays a while.

    On a slow machine another plan is shown before the final one.
    """
    status = page.get_by_role("status")
    if version is not None:
        expect(page.locator("#status")).to_have_attribute("data-version", str(version), timeout=SEARCH_MS)
    expect(status).to_contain_text("Planned: ")
    expect(status).to_have_attribute("data-is-final", "true", timeout=SEARCH_MS)


def cost_s(page: Page) -> float:
    """Return the cost of the plan that is shown (s)."""
    found = re.search(r", ([\d.]+) s$", page.get_by_role("status").inner_text())
    assert found is not None
    return float(found[1])
