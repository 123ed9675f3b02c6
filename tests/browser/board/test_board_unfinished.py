"""An outline that is not closed yet survives mistakes of the hand."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.board_desk import Desk, expect_step
from tests.browser.board_finger import Finger
from tests.browser.board_hand import Hand
from tests.browser.conftest import Garment, Sheet, windows

CORNERS = [(0.1, 0.1), (0.4, 0.1), (0.4, 0.3), (0.1, 0.3)]


def begun(page: Page) -> Hand:
    """Draw four corners of an outline, not closed."""
    hand = Hand(page)
    hand.tool("Draw outline")
    for corner in CORNERS:
        hand.click(corner)
    expect(page.locator(".layer-tool .corner")).to_have_count(4)
    return hand


def test_a_stray_key_leaves_an_unfinished_outline_to_go_on_with(page: Page, towel: Desk) -> None:
    hand = begun(page)
    for key in ("f", "v", "m", "t"):
        page.keyboard.press(key)
        expect(page.locator(".layer-tool .corner")).to_have_count(4)
        expect(page.locator(".hint-line")).to_contain_text("not closed yet")
        page.keyboard.press("p")
        expect(page.locator(".hint-line")).not_to_contain_text("not closed yet")
    page.keyboard.press("p")
    expect(page.locator(".layer-tool .corner")).to_have_count(4)
    hand.click(CORNERS[0])
    expect_step(page, "Draw outline")
    assert len(towel.drawing["outline"]) == 4


def test_undo_is_at_hand_while_an_outline_is_drawn_and_takes_back_its_last_corner(page: Page, towel: Desk) -> None:
    begun(page)
    undo = page.get_by_role("button", name="Undo")
    expect(undo).to_be_enabled()
    expect(undo).to_have_attribute("title", "Undo: corner 4 (Ctrl+Z)")
    undo.click()
    expect(page.locator(".layer-tool .corner")).to_have_count(3)
    page.keyboard.press("Escape")
    expect_step(page, "Begin")


def test_a_length_typed_with_the_pointer_off_the_board_goes_where_it_pointed_last(page: Page, towel: Desk) -> None:
    hand = Hand(page)
    hand.tool("Draw outline")
    hand.click((0.1, 0.1))
    hand.click((0.4, 0.1))
    page.mouse.move(*hand.px((0.4, 0.25)))
    page.mouse.move(5, 5)
    page.keyboard.type("1.4m")
    page.keyboard.press("Enter")
    corners = page.locator(".layer-tool .corner")
    expect(corners).to_have_count(3)
    scale = float(str(hand.board.get_attribute("data-px-per-m")))
    low, high = (float(str(corners.nth(number).get_attribute("cy"))) for number in (1, 2))
    assert (low - high) / scale == pytest.approx(1.4, abs=0.005)
    page.keyboard.press("Escape")


def test_a_fold_whose_first_end_is_set_goes_on_after_another_tool(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    hand.tool("Draw fold")
    hand.click((0.0, 0.2))
    page.keyboard.press("v")
    page.keyboard.press("f")
    hand.click((0.457, 0.2))
    expect_step(page, "Draw fold")


def test_two_fingers_pan_and_leave_the_corners_set_so_far(
    chromium: Browser, new_sheet: Callable[[Garment], Sheet]
) -> None:
    sheet = new_sheet(None)
    with windows(chromium, viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True) as phone:
        page = phone.new_page()
        page.goto(sheet.page_url)
        finger = Finger(page)
        finger.hand.tool("Draw outline")
        for corner in CORNERS[:2]:
            finger.tap(corner)
        expect(page.locator(".layer-tool .corner")).to_have_count(2)
        x, y = finger.hand.px((0.1, 0.2))
        finger.send("touchStart", (x, y))
        finger.send("touchStart", (x, y), (x + 60, y))
        finger.send("touchMove", (x, y + 30), (x + 60, y + 30))
        finger.send("touchEnd")
        expect(page.locator(".layer-tool .corner")).to_have_count(2)
