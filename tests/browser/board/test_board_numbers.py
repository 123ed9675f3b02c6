"""Number fields at the selection and at the pointer: a typed number is applied once, to the last digit."""

import pytest
from playwright.sync_api import Page, expect

from tests.browser.board_desk import Desk, corner, expect_no_step, expect_step
from tests.browser.board_hand import Hand
from tests.browser.channel import listened_to

# A corner of the T-shirt, as its file has it (m).
SLEEVE_TIP = (0.61, 0.572)


def test_numbers_at_the_selection_move_a_corner_exactly(page: Page, cloth: Desk) -> None:
    Hand(page).click(SLEEVE_TIP)
    page.keyboard.press("Tab")
    expect(page.get_by_label("x of the vertex")).to_be_focused()
    page.keyboard.type("25in")
    page.keyboard.press("Enter")
    expect_step(page, "Move vertex")
    assert corner(cloth, 6) == pytest.approx([25 * 0.0254, 0.572], abs=1e-9)


def test_what_is_no_number_is_refused_in_words(page: Page, cloth: Desk) -> None:
    Hand(page).click(SLEEVE_TIP)
    page.get_by_label("x of the vertex").fill("wide")
    page.keyboard.press("Enter")
    expect(page.get_by_role("log", name="Notices")).to_contain_text("is no number")
    expect(page.get_by_label("x of the vertex")).to_have_value("61.0")
    expect_no_step(page)


def test_a_number_that_is_too_large_is_refused_in_the_unit_of_the_page(page: Page, cloth: Desk) -> None:
    Hand(page).click(SLEEVE_TIP)
    page.get_by_label("x of the vertex").fill("99999")
    page.keyboard.press("Enter")
    expect(page.get_by_role("log", name="Notices")).to_contain_text("\u201c99999\u201d is too much: at most 1000.0 cm")
    expect(page.get_by_label("x of the vertex")).to_have_value("61.0")
    Hand(page).click((0.2, 0.0))
    page.get_by_label("Length of the edge").fill("-5")
    page.keyboard.press("Enter")
    expect(page.get_by_role("log", name="Notices")).to_contain_text("\u201c-5\u201d is too little: at least 0.1 cm")
    expect_no_step(page)


def test_an_edge_gets_the_length_that_is_typed(page: Page, cloth: Desk) -> None:
    Hand(page).click((0.2, 0.0))
    page.get_by_label("Length of the edge").fill("91.4/2+2")
    page.keyboard.press("Enter")
    expect_step(page, "Set edge length")
    # The edge runs from the last corner (0.457, 0) to the first (0, 0), which moves: 47.7 cm.
    assert corner(cloth, 0) == pytest.approx([0.457 - 0.477, 0.0], abs=1e-9)


def test_a_number_typed_while_drawing_is_the_length(page: Page, cloth: Desk) -> None:
    hand = Hand(page)
    page.keyboard.press("p")
    hand.click((0.0, -0.05))
    page.mouse.move(*hand.px((0.31, -0.05)))
    page.keyboard.type("18in")
    page.keyboard.press("Enter")
    page.mouse.move(*hand.px((0.457, 0.4)))
    page.keyboard.type("30")
    page.keyboard.press("Enter")
    page.keyboard.press("Enter")
    expect(page.locator(".corner")).to_have_count(3)
    expect_step(page, "Draw outline")
    first, second, third = (corner(cloth, index) for index in range(3))
    assert second[0] - first[0] == pytest.approx(18 * 0.0254, abs=1e-6)
    assert ((third[0] - second[0]) ** 2 + (third[1] - second[1]) ** 2) ** 0.5 == pytest.approx(0.3, abs=1e-9)


def test_a_number_is_put_once_when_enter_takes_it(page: Page, cloth: Desk) -> None:
    """Put again as the field is left it would come after what somebody else had done in between."""
    with listened_to(page, cloth.page_url) as (window, channel):
        expect_step(window, "Begin")
        hand = Hand(window)
        hand.click(SLEEVE_TIP)
        window.get_by_label("x of the vertex").fill("63")
        window.keyboard.press("Enter")
        expect_step(window, "Move vertex")
        hand.tool("Undo")  # it waits for its turn
        expect_step(window, "Begin")
        assert [sent["do"] for sent in channel.sent if sent["do"] in ("edit", "undo")] == ["edit", "undo"]


def test_numbers_do_not_come_to_lie_under_the_pointer(page: Page, desk: Desk) -> None:
    """A second click is meant for the edge, not for what the first one has opened beside its middle."""
    desk.lay({"name": "half", "outline": [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]], "folds": []})
    hand = Hand(page)
    x, y = hand.px((0.25, 0.25))
    place = (x + 38, y + 38)
    page.mouse.click(*place)
    expect(page.get_by_label("Length of the edge")).to_be_visible()
    page.mouse.dblclick(*place)
    expect_step(page, "Add vertex")
    assert len(desk.drawing["outline"]) == 4


def test_on_a_phone_the_numbers_cover_neither_what_would_help_nor_the_inset(page: Page, cloth: Desk) -> None:
    def expect_clear(name: str) -> None:
        """Wait until the numbers cover nothing of what is so named; more of it may come once they are there."""
        boxes = f"['.numbers-at', '{name}'].map((one) => document.querySelector(one).getBoundingClientRect())"
        apart = "a.right <= b.x || b.right <= a.x || a.bottom <= b.y || b.bottom <= a.y"
        page.wait_for_function(f"(() => {{ const [a, b] = {boxes}; return {apart}; }})()")

    def pull(start: tuple[float, float], x: float, y: float) -> None:
        page.mouse.move(*Hand(page).px(start))
        page.mouse.down()
        page.mouse.move(x, y, steps=4)
        page.mouse.up()
        expect_step(page, "Move vertex")
        expect(page.locator(".numbers-at")).to_be_visible()

    try:
        page.set_viewport_size({"width": 390, "height": 844})
        pull((0.457, 0.0), 300, 570)
        expect_clear("#swap")
        Hand(page).drag((0.457, 0.61), (0.2, -0.2))  # the outline crosses itself
        expect(page.locator(".suggestion-strip .card").first).to_be_visible()
        pull((0.0, 0.61), 60, 200)
        expect_clear(".suggestion-strip")
    finally:
        page.set_viewport_size({"width": 1280, "height": 800})
