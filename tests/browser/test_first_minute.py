"""Someone new draws at once, and is told two things where they are needed; what is played is on the board too."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.app.samples import towel
from tests.browser.board_hand import Hand
from tests.browser.conftest import Garment, Sheet, windows
from tests.browser.status_pill import expect_planned

SOON_MS = 3_000
"""Less than a word stays by itself."""


def test_a_blank_board_draws_at_once_and_each_word_goes_when_it_is_followed(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    page.goto(new_sheet(None).page_url)
    hand, coach = Hand(page), page.locator(".coach")
    expect(coach).to_contain_text("Click where the corners")
    corners = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.3), (0.0, 0.3)]
    for corner in [*corners, corners[0]]:
        hand.click(corner)
    expect(page.locator(".corner")).to_have_count(4)
    expect(coach).to_be_hidden()
    hand.tool("Draw fold")
    hand.drag((0.4, 0.15), (0.0, 0.15))
    expect_planned(page)
    expect(coach).to_contain_text("The robot can do it")
    page.get_by_role("button", name="Play", exact=True).click()
    expect(coach).to_be_hidden()
    page.reload()
    expect_planned(page)
    expect(coach).to_be_hidden()


@pytest.mark.parametrize("done", ["Fold it for me", "Share", "Fit"])
def test_a_word_goes_when_something_else_is_pressed_or_opened(
    chromium: Browser, new_sheet: Callable[[Garment], Sheet], done: str
) -> None:
    with windows(chromium) as context:
        page = context.new_page()
        page.goto(new_sheet(towel()).page_url)
        coach = page.locator(".coach")
        expect(coach).to_contain_text("Press Space to play")
        page.get_by_role("button", name=done).first.click()
        expect(coach).to_be_hidden(timeout=SOON_MS)


def test_a_word_goes_after_five_seconds(chromium: Browser, new_sheet: Callable[[Garment], Sheet]) -> None:
    with windows(chromium) as context:
        page = context.new_page()
        page.clock.install()
        page.goto(new_sheet(towel()).page_url)
        coach = page.locator(".coach")
        expect(coach).to_contain_text("Press Space to play")
        page.clock.fast_forward(5_000)
        expect(coach).to_be_hidden(timeout=SOON_MS)


def test_on_a_phone_no_word_speaks_of_a_key(phone: Page, new_sheet: Callable[[Garment], Sheet]) -> None:
    phone.goto(new_sheet(towel()).page_url)
    expect_planned(phone)
    phone.locator("#sheet").tap()
    phone.evaluate("dispatchEvent(new Event('resize'))")
    expect(phone.locator(".coach")).to_have_text("The robot can do it. Tap Play to watch.")


def test_the_plan_has_pictures_and_the_board_shows_robot_and_cloth_while_it_is_played(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    page.goto(new_sheet(towel()).page_url)
    expect_planned(page)
    rows = page.get_by_role("list", name="Plan").get_by_role("listitem")
    expect(rows.last.locator(".picture-layer")).to_have_count(2)
    expect(page.locator(".robot-name")).to_have_count(0)
    page.keyboard.press("Space")
    expect(page.locator(".robot-name")).to_contain_text("front")
    expect(page.locator(".corner")).to_have_count(0)
    page.keyboard.press("Space")
    expect(page.locator(".corner")).to_have_count(4)
