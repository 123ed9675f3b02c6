"""The board's cursor for the keyboard."""

from playwright.sync_api import Page

from tests.browser.board_hand import Point

LABEL_OF_FOCUS = "document.activeElement.getAttribute('aria-label') ?? document.activeElement.textContent"
TABS_MAX = 150


def walk(page: Page, start: Point, end: Point) -> None:
    """Move the cursor from a point to another, both on whole millimetres."""
    for axis, names in enumerate((("ArrowLeft", "ArrowRight"), ("ArrowDown", "ArrowUp"))):
        left = round(1000 * (end[axis] - start[axis]))
        key = names[left > 0]
        for prefix, steps in (("Shift+", abs(left) // 100), ("", abs(left) % 100 // 10), ("Alt+", abs(left) % 10)):
            for _ in range(steps):
                page.keyboard.press(prefix + key)


def cross(page: Page) -> Point:
    """Return the cursor's position, as announced to screen readers."""
    words = str(page.locator(".board-pane > .unseen").text_content()).replace(" cm", "").split(",")
    return float(words[0]) / 100, float(words[1]) / 100


def tab_to(page: Page, name: str) -> None:
    """Press Tab until the focused element's name begins like this."""
    for _ in range(TABS_MAX):
        if str(page.evaluate(LABEL_OF_FOCUS)).startswith(name):
            return
        page.keyboard.press("Tab")
    raise AssertionError(f"Tab does not lead to {name}")
