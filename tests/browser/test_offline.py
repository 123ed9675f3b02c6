"""The server disappears while somebody draws: nothing is lost, and the tools are disabled until it is back."""

from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Page, expect

from tests.app.conftest import Served
from tests.browser.board_hand import Hand
from tests.browser.channel import Message, listened_to
from tests.browser.conftest import Garment, Sheet
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned

CORNER = (0.0, 0.0)
PULLED = (-0.05, -0.03)


@pytest.fixture
def napkin_sheet(page: Page, designer: Served, new_sheet: Callable[[Garment], Sheet]) -> Iterator[Sheet]:
    """Open a napkin in the browser; the server runs again afterwards in any case."""
    sheet = new_sheet(napkin())
    page.goto(sheet.page_url)
    expect_planned(page)
    yield sheet
    if designer.process.poll() is not None:
        designer.start_again()


def label(page: Page) -> str:
    return str(page.locator(".corner").first.get_attribute("aria-label"))


def at(point: tuple[float, float]) -> str:
    return f"Vertex 1: {100 * point[0]:.1f}, {100 * point[1]:.1f} cm"


def test_a_corner_that_is_dragged_when_the_server_dies_stays_and_is_sent_when_it_is_back(
    page: Page, designer: Served, napkin_sheet: Sheet
) -> None:
    hand = Hand(page)
    hand.drag(CORNER, (-0.02, -0.01), is_released=False)
    designer.stop()
    expect(page.get_by_role("status")).to_contain_text("Connection lost")
    page.mouse.move(*hand.px(PULLED), steps=3)
    page.mouse.up()
    expect(page.get_by_role("log", name="Notices")).to_contain_text("Your change is kept")
    expect(page.locator(".corner").first).to_have_attribute("aria-label", at(PULLED))
    expect(page.locator(".hint-line")).to_contain_text("what you did is kept")
    designer.start_again()
    expect_planned(page)
    expect(page.get_by_role("button", name="Undo")).to_have_attribute("title", "Undo: Move vertex (Ctrl+Z)")
    assert label(page) == at(PULLED)
    there = pytest.approx(PULLED, abs=1e-9)
    napkin_sheet.once(lambda state: state["drawing"]["outline"][0]["point"] == there)
    assert napkin_sheet.can_undo == "Move vertex"


@pytest.mark.long
def test_without_a_server_the_tools_rest_and_the_board_says_why(
    page: Page, designer: Served, napkin_sheet: Sheet
) -> None:
    before = label(page)
    rail = page.locator("#rail")
    expect(rail).not_to_have_attribute("inert", "")
    designer.stop()
    expect(page.locator(".hint-line")).to_have_text("Offline: the tools wait until the server is back.")
    for part in (rail, page.locator(".fold-list"), page.locator("#import")):
        expect(part).to_have_attribute("inert", "")
    hand = Hand(page)
    hand.drag(CORNER, PULLED)  # moves the view, as with the middle button
    assert label(page) == before
    designer.start_again()
    expect_planned(page)
    expect(rail).not_to_have_attribute("inert", "")
    expect(page.locator(".hint-line")).not_to_contain_text("Offline")
    assert napkin_sheet.can_undo is None


def test_a_change_whose_answer_alone_was_lost_is_not_made_twice(page: Page, napkin_sheet: Sheet) -> None:
    with listened_to(page, napkin_sheet.page_url) as (window, channel):
        expect_planned(window)
        lost: list[Message] = []

        def lose_the_first(heard: Message) -> bool:
            is_told = heard["kind"] in ("document", "answer") and bool(channel.asked("edit")) and not lost
            if is_told and heard["kind"] == "answer":
                lost.append(heard)
                channel.cut()
            return not is_told

        channel.hear = lose_the_first
        Hand(window).click(CORNER)
        window.keyboard.press("ArrowRight")
        expect(window.locator(".corner").first).to_have_attribute("aria-label", at((0.001, 0.0)))
        expect(window.get_by_role("status")).not_to_contain_text("Not sent yet")
        expect_planned(window)
        assert [heard["version"] for heard in lost] == [2]
        assert len(channel.asked("edit")) == 1
    assert napkin_sheet.drawing["outline"][0]["point"] == pytest.approx((0.001, 0.0), abs=1e-9)
