"""The board's cross, led by the keyboard."""

from playwright.sync_api import Page

from tests.browser.board_hand import Point

LABEL_OF_FOCUS = "document.activeElement.getAttribute('aria-label') ?? document.activeElement.textContent"
TABS_MAX = 150


def walk(page: Page, start: Point, end: Point) -> None:
    """Lead the cross from a point to another, both on whole millimetres."""
    for axis, names in enumerate((("ArrowLeft", "ArrowRight"), ("ArrowDown", "ArrowUp"))):
        left = round(1000 * (end[axis] - start[axis]))
        key = names[left > 0]
        for prefix, steps in (("Shift+", abs(left) // 100), ("", abs(left) % 100 // 10), ("Alt+", abs(left) % 10)):
            for _ in range(steps):
                page.keyboard.press(prefix + key)


def cross(page: Page) -> Point:
    """Where the cross is, as the board says it for those who do not see it."""
    words = str(page.locator(".board-pane .unseen").text_content()).replace(" cm", "").split(",")
    return float(words[0]) / 100, float(words[1]) / 100


def tab_to(page: Page, name: str) -> None:
    """Go on with Tab until what has the focus has a name that begins like this."""
    for _ in range(TABS_MAX):
        if str(page.evaluate(LABEL_OF_FOCUS)).startswith(name):
            return
        page.keyboard.press("Tab")
    raise AssertionError(f"Tab does not lead to {name}")
