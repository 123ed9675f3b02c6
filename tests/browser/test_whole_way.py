"""From a blank board to a plan, to none, to a suggestion and back: with the mouse, the keyboard, a finger."""

import math
import re
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.app.conftest import Served
from tests.browser.board_hand import Point
from tests.browser.conftest import Garment, Sheet, windows
from tests.browser.searches import SEARCH_MS
from tests.browser.status_pill import expect_planned
from tests.browser.ways import ByFinger, ByKeyboard, ByMouse, Way, expect_folds

# 0.4 x 0.3 m: sides that end in peaks, a notch between them. Both sides are folded in, then it is halved.
CORNERS: list[Point] = [
    (0.05, 0.15), (0.45, 0.15), (0.45, 0.35), (0.35, 0.45), (0.25, 0.35), (0.15, 0.45), (0.05, 0.35)
]  # fmt: skip
FOLDS: list[tuple[Point, Point]] = [
    ((0.15, 0.15), (0.15, 0.45)), ((0.35, 0.45), (0.35, 0.15)), ((0.35, 0.25), (0.15, 0.25))
]  # fmt: skip
PULLED = 1
PULLS_M = (0.2, 0.64, 0.72, 0.8, 0.9)
# Where a hand puts a point: within a few pixels, and a pixel is some 3 mm there.
NEAR_M = 0.008

NO_PLAN = "No plan: "
SMALL = {"width": 900, "height": 500}
PHONE: dict[str, Any] = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


def there_and_back(page: Page, way: Way, sheet: Sheet) -> dict[str, Any]:
    """Do everything that a person does with the hands; return the document as it was before the undos."""
    page.goto(sheet.page_url)
    expect(page.locator(".blank")).to_be_visible()
    blank = sheet.state
    way.draw_outline(CORNERS)
    expect(page.locator(".corner")).to_have_count(7)
    way.draw_folds(FOLDS)
    status = page.get_by_role("status")
    drawn = sheet.state
    expect_answer(page, drawn["version"])
    expect(status).to_contain_text(re.compile("^Planned: [1-9]"))
    for corner, wanted in zip(drawn["drawing"]["outline"], CORNERS, strict=True):
        assert math.dist(corner["point"], wanted) < NEAR_M
    assert [fold["status"] for fold in drawn["solved"]] == ["legal"] * 3

    pull_until_there_is_no_plan(page, way, sheet)
    expect(status).to_have_attribute("data-is-final", "true", timeout=SEARCH_MS)
    sentence = status.inner_text().removeprefix(NO_PLAN)
    assert sentence.startswith(
        ("Left side over: ", "Right side over: ", "Bottom up: ")
    )  # its corners are beyond the edge
    expect(page.locator(".reason")).to_have_text(f"{sentence}.")
    pulled = sheet.at_rest()
    assert pulled["history"]["can_undo"] == "Move vertex"
    assert pulled["drawing"]["outline"][PULLED]["point"][1] < -0.05

    expect(page.locator(".cards button", has_text="Move the garment").first).to_be_attached(timeout=SEARCH_MS)
    if (folded := page.get_by_role("button", name="Show suggestions")).is_visible():  # a low board has one line
        way.press("Show suggestions")
        expect(folded).to_be_hidden()
    way.press("Move the garment")
    expect_planned(page)
    helped = sheet.state
    assert helped["history"]["can_undo"].startswith("Move the garment ")
    assert helped["drawing"]["outline"] == pulled["drawing"]["outline"]
    assert helped["drawing"]["placement"] != pulled["drawing"]["placement"]

    undo_everything(page, way, sheet)
    expect(page.locator(".blank")).to_be_visible()
    assert sheet.drawing == blank["drawing"]
    return helped


def pull_until_there_is_no_plan(page: Page, way: Way, sheet: Sheet) -> None:
    """Pull further and further, each time once the page has the previous plan; then release."""
    status = page.get_by_role("status")
    x, y = sheet.drawing["outline"][PULLED]["point"]
    way.take(PULLED, (x, y))
    for pull_m in PULLS_M:
        way.pull_down((x, y - pull_m))
        expect_answer(page, until_it_is_at(sheet, y - pull_m))
        if status.get_attribute("data-status") == "infeasible":
            break
    way.let_go()
    expect(status).to_contain_text(NO_PLAN)


def until_it_is_at(sheet: Sheet, y: float) -> int:
    """Wait until the server has the corner there; return the version."""
    there = sheet.once(lambda state: abs(state["drawing"]["outline"][PULLED]["point"][1] - y) < NEAR_M / 2)
    return int(there["version"])


def expect_answer(page: Page, version: int) -> None:
    """Expect the page to show this version, or a later one, and the outcome of its planning."""
    shown = "['drafting-board', 'status'].map((id) => Number(document.getElementById(id).dataset.version))"
    page.wait_for_function(f"(version) => {shown}.every((other) => other >= version)", arg=version, timeout=SEARCH_MS)


def step(page: Page, way_there: Callable[[], None]) -> None:
    """Undo or redo a step, and wait until the board shows it."""
    board = page.get_by_role("application", name="Drafting board")
    before = str(board.get_attribute("data-version"))
    way_there()
    expect(board).not_to_have_attribute("data-version", before)


def undo_everything(page: Page, way: Way, sheet: Sheet) -> None:
    while sheet.can_undo is not None:
        step(page, way.undo)


def redo_everything(page: Page, sheet: Sheet) -> None:
    while sheet.state["history"]["can_redo"] is not None:
        step(page, page.get_by_role("button", name="Redo").click)


def expect_all_of(page: Page, sheet: Sheet, state: dict[str, Any]) -> None:
    """Expect the page to show a document as it was, with its plan and its whole history."""
    expect_planned(page)
    expect(page.locator(".corner")).to_have_count(7)
    expect_folds(page, 3)
    expect(page.get_by_role("button", name="Undo")).to_have_attribute(
        "title", f"Undo: {state['history']['can_undo']} (Ctrl+Z)"
    )
    found = sheet.state
    assert found["drawing"] == state["drawing"]
    assert found["history"] == state["history"]


@pytest.mark.long
def test_with_the_keyboard_alone(chromium: Browser, new_sheet: Callable[[Garment], Sheet]) -> None:
    with windows(chromium, viewport=SMALL) as context:
        page = context.new_page()
        there_and_back(page, ByKeyboard(page), new_sheet(None))


@pytest.mark.long
def test_with_a_finger_on_a_phone(chromium: Browser, new_sheet: Callable[[Garment], Sheet]) -> None:
    with windows(chromium, **PHONE) as context:
        page = context.new_page()
        there_and_back(page, ByFinger(page), new_sheet(None))


@pytest.mark.long
def test_with_the_mouse_and_all_of_it_is_found_again(
    chromium: Browser, designer: Served, new_sheet: Callable[[Garment], Sheet]
) -> None:
    sheet = new_sheet(None)
    with windows(chromium, viewport=SMALL) as context:
        page = context.new_page()
        whole = there_and_back(page, ByMouse(page), sheet)
        redo_everything(page, sheet)
        page.reload()
        expect_all_of(page, sheet, whole)

        page.evaluate("window.isOfBefore = true")
        designer.stop()
        expect(page.get_by_role("status")).to_contain_text("Connection lost")
        designer.start_again()
        expect_all_of(page, sheet, whole)
        assert page.evaluate("window.isOfBefore"), "the page came back by being loaded anew"
