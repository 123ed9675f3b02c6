"""A document in one window that many tests share, since a page takes long to load."""

from typing import Any

from playwright.sync_api import Page, expect

from tests.app.conftest import Served
from tests.browser.conftest import REST, Sheet

SPREAD_OUT = "() => document.querySelector('[data-tool=outline]').click()"
READY = """() => {
  for (const name of [".paint.is-blue", "[data-tool=select]", "[aria-label=Fit]"]) document.querySelector(name).click();
  return new Promise(requestAnimationFrame);
}"""
"""Blue folds, nothing selected, all in view. By clicks of a hand it would take as long as the test that follows."""


class Desk(Sheet):
    """A document into which one garment after the other is put."""

    def __init__(self, page: Page, server: Served) -> None:
        """Create a document on a blank board."""
        made = REST.post(f"{server.url}/api/documents", json={}).raise_for_status()
        super().__init__(server.url, made.json()["id"])
        self.page = page

    def garment(self, name: str) -> dict[str, Any]:
        """Return a garment's file."""
        found: dict[str, Any] = REST.get(self.page_url.partition("/d/")[0] + f"/api/garments/{name}").json()
        return found

    def lay(self, garment: dict[str, Any]) -> None:
        """Put a garment in place of the last one, as one step, with nothing selected and all of it in view."""
        page = self.page
        if page.url != self.page_url:
            page.goto(self.page_url)
            page.wait_for_selector("[data-tool=outline]")
        for _ in range(3):
            page.keyboard.press("Escape")
        page.evaluate(SPREAD_OUT)
        self._put({"name": "nothing", "outline": [[0, 0], [0.3, 0], [0, 0.3]]})
        expect(page.locator(".suggestion-strip")).to_be_hidden()  # else the board moves when it goes
        self._put(garment)
        expect_step(page, "Begin")
        expect(page.locator(".corner")).to_have_count(len(garment["outline"]))
        expect(page.locator(".fold-focus")).to_have_count(len(garment["folds"]))
        page.mouse.move(0, 0)
        page.evaluate(READY)

    def _put(self, garment: dict[str, Any]) -> None:
        REST.put(f"{self.path}/garment", json={"garment": garment, "label": "Begin"}).raise_for_status()


def expect_step(page: Page, name: str) -> None:
    """Expect the last step to have this name."""
    expect(page.get_by_role("button", name="Undo")).to_have_attribute("title", f"Undo: {name} (Ctrl+Z)")


def expect_no_step(page: Page) -> None:
    """Expect no step since the garment was put on the board."""
    expect_step(page, "Begin")


def corner(sheet: Sheet, index: int) -> list[float]:
    """Return a corner of the outline on the server (m)."""
    point: list[float] = sheet.drawing["outline"][index]["point"]
    return point
