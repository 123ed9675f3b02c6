"""What the page says in a few words of the document in it."""

import re

from playwright.sync_api import Page, expect


def expect_planned(page: Page) -> None:
    """There is a plan, and none quicker is looked for any more: on a slow machine some plan is shown before that."""
    status = page.get_by_role("status")
    expect(status).to_contain_text("Planned: ")
    expect(status).to_have_attribute("data-is-final", "true")


def cost_s(page: Page) -> float:
    """Of the plan on show (s)."""
    found = re.search(r", ([\d.]+) s$", page.get_by_role("status").inner_text())
    assert found is not None
    return float(found[1])
