"""Drawn points are exactly where they should be, tied to what they end at; two fingers zoom and draw nothing."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.board.conftest import page as page
from tests.browser.board_desk import expect_step
from tests.browser.board_finger import Finger
from tests.browser.board_hand import SEVEN, Hand, Point
from tests.browser.board_keys import cross, walk
from tests.browser.conftest import Garment, Sheet
from tests.browser.ways import expect_folds

# A pixel of the screen is about 2 mm there, and a mouse stands on whole pixels.
PX_M = 0.003


@pytest.fixture
def blank(page: Page, new_sheet: Callable[[Garment], Sheet]) -> Sheet:
    sheet = new_sheet(None)
    page.goto(sheet.page_url)
    expect(page.locator(".blank")).to_be_visible()
    return sheet


def points(sheet: Sheet) -> list[list[float]]:
    return [corner["point"] for corner in sheet.drawing["outline"]]


def assert_near(found: list[list[float]], wanted: list[Point], within: float) -> None:
    assert len(found) == len(wanted)
    for point, expected in zip(found, wanted, strict=True):
        assert point == pytest.approx(expected, abs=within)


def test_a_fold_drawn_with_the_mouse_is_tied_to_the_corner_at_which_it_ends(page: Page, blank: Sheet) -> None:
    hand = Hand(page)
    hand.tool("Draw outline")
    for corner in [*SEVEN, SEVEN[0]]:
        hand.click(corner)
    expect(page.locator(".corner")).to_have_count(7)
    hand.tool("Draw fold")
    hand.drag((0.125, 0.0), (0.125, 0.6))
    expect_step(page, "Draw fold")
    assert_near(points(blank), SEVEN, PX_M)
    (fold,) = blank.drawing["folds"]
    assert fold["start"]["point"] == pytest.approx([0.125, 0.0], abs=PX_M)
    assert fold["end"]["on"] == {"kind": "vertex", "vertex": "v5"}


@pytest.mark.parametrize("size", [(1280, 800), (900, 500)])
def test_a_blank_board_is_80_cm_wide_and_what_is_drawn_on_it_is_fitted_when_it_closes(
    page: Page, new_sheet: Callable[[Garment], Sheet], size: tuple[int, int]
) -> None:
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.goto(new_sheet(None).page_url)
    hand = Hand(page)
    hand.px((0.0, 0.0))  # once it is drawn
    box = hand.board.bounding_box()
    assert box is not None
    assert box["width"] / float(str(hand.board.get_attribute("data-px-per-m"))) == pytest.approx(0.8, abs=2e-3)
    triangle = [(0.1, 0.32), (0.2, 0.32), (0.2, 0.42)]
    for corner in [*triangle, triangle[0]]:
        hand.click(corner)
    expect(page.locator(".corner")).to_have_count(3)
    closed = str(hand.board.get_attribute("data-origin-px"))
    page.get_by_role("button", name="Fit").click()
    page.wait_for_function("new Promise(requestAnimationFrame)")
    assert str(hand.board.get_attribute("data-origin-px")) == closed
    page.set_viewport_size({"width": 1280, "height": 800})


def test_what_is_drawn_with_the_keyboard_is_where_the_cross_was(page: Page, blank: Sheet) -> None:
    page.keyboard.press("p")
    page.keyboard.press("ArrowUp")
    at = cross(page)
    for corner in SEVEN:
        walk(page, at, corner)
        page.keyboard.press("Enter")
        at = corner
    page.keyboard.press("Enter")
    expect_step(page, "Draw outline")
    assert_near(points(blank), SEVEN, 1e-9)
    page.keyboard.press("f")
    lines = [((0.125, 0.0), (0.125, 0.6)), ((0.375, 0.6), (0.375, 0.0)), ((0.375, 0.25), (0.125, 0.25))]
    for count, (start, end) in enumerate(lines):
        walk(page, at, start)
        page.keyboard.press("Enter")
        walk(page, start, end)
        page.keyboard.press("Enter")
        at = end
        expect_folds(page, count + 1)
    has_heard = f"fetch('{blank.path}').then((a) => a.json()).then((s) => s.drawing.folds.length === 3)"
    page.wait_for_function(has_heard)
    solved = blank.state["solved"]
    assert solved[2]["start"] == pytest.approx([0.375, 0.25], abs=1e-6)
    assert solved[2]["end"] == pytest.approx([0.125, 0.25], abs=1e-6)


def test_undo_takes_back_what_is_being_drawn_before_any_step(page: Page, blank: Sheet) -> None:
    hand = Hand(page)
    hand.tool("Draw outline")
    for corner in [*SEVEN, SEVEN[0]]:
        hand.click(corner)
    expect_step(page, "Draw outline")
    hand.tool("Draw outline")
    for corner in SEVEN[:3]:
        hand.click(corner)
    sketched = page.locator(".is-sketching .handle.corner")
    expect(sketched).to_have_count(7 + 3)
    page.keyboard.press("Control+z")
    expect(sketched).to_have_count(7 + 2)
    page.get_by_role("button", name="Undo").click()
    expect(sketched).to_have_count(7 + 1)
    expect_step(page, "corner 1")
    assert blank.can_undo == "Draw outline"
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    expect(page.get_by_role("button", name="Redo")).to_be_enabled()
    assert points(blank) == []


def test_the_first_key_may_put_a_corner(page: Page, blank: Sheet) -> None:
    page.keyboard.press("p")
    page.keyboard.press("Enter")
    expect(page.locator(".cross")).to_have_count(1)
    expect(page.locator(".is-sketching .handle.corner")).to_have_count(1)
    page.keyboard.press("v")
    expect(page.locator(".cross")).to_have_count(0)


def test_a_finger_grabs_a_corner_once_grabbing_is_on(phone: Page, new_sheet: Callable[[Garment], Sheet]) -> None:
    square = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.4], [0.0, 0.4]]
    sheet = new_sheet({"name": "square", "outline": square, "folds": []})
    page = phone
    page.goto(sheet.page_url)
    expect(page.locator(".corner")).to_have_count(4)
    Hand(page).tool("Grab")
    Finger(page).drag((0.0, 0.0), (0.4, 0.4))
    expect_step(page, "Draw fold")
    (drawn,) = sheet.drawing["folds"]
    assert drawn["start"]["point"] == pytest.approx([0.4, 0.0], abs=1e-6)
    assert drawn["end"]["point"] == pytest.approx([0.0, 0.4], abs=1e-6)


def test_two_fingers_zoom_and_drop_the_stroke(phone: Page, new_sheet: Callable[[Garment], Sheet]) -> None:
    sheet = new_sheet("t-shirt")
    page = phone
    page.goto(sheet.page_url)
    expect(page.locator(".corner")).to_have_count(10)
    finger, hand = Finger(page), Hand(page)
    hand.enlarge()
    before = float(str(hand.board.get_attribute("data-px-per-m")))
    a, b = hand.px((0.1, 0.2)), hand.px((0.3, 0.2))
    wide = (b[0] + (b[0] - a[0]), b[1])
    finger.send("touchStart", hand.px((0.0, 0.0)))
    finger.send("touchMove", hand.px((0.05, 0.05)))
    finger.send("touchMove", a)
    finger.send("touchStart", a, b)
    finger.send("touchMove", a, wide)
    finger.send("touchEnd")
    after = float(str(hand.board.get_attribute("data-px-per-m")))
    assert after == pytest.approx(2 * before, rel=0.02)
    expect(page.get_by_role("button", name="Undo")).to_be_disabled()
    state = sheet.at_rest()
    assert state["history"]["can_undo"] is None
    assert state["drawing"]["outline"][0]["point"] == [0.0, 0.0]
