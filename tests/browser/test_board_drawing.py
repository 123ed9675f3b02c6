"""Garments and folds drawn from nothing: with the mouse, with the keyboard, with a finger."""

from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect

from tests.browser.board_hand import SEVEN, Hand, Point
from tests.browser.conftest import Garment, Sheet

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


def expect_folds(page: Page, count: int) -> None:
    expect(page.get_by_role("list", name="Folds").get_by_role("listitem")).to_have_count(count)


def assert_near(found: list[list[float]], wanted: list[Point], within: float) -> None:
    assert len(found) == len(wanted)
    for point, expected in zip(found, wanted, strict=True):
        assert point == pytest.approx(expected, abs=within)


def test_seven_corners_and_three_folds_are_drawn_with_the_mouse_and_planned(page: Page, blank: Sheet) -> None:
    hand = Hand(page)
    hand.tool("Draw outline")
    for corner in [*SEVEN, SEVEN[0]]:
        hand.click(corner)
    expect(page.locator(".corner")).to_have_count(7)
    hand.tool("Draw fold")
    hand.drag((0.125, 0.0), (0.125, 0.6))
    expect_folds(page, 1)
    hand.drag((0.375, 0.6), (0.375, 0.0))
    expect_folds(page, 2)
    hand.drag((0.375, 0.25), (0.125, 0.25))
    expect_folds(page, 3)
    expect(page.get_by_role("status")).to_contain_text("Planned: ")
    assert_near(points(blank), SEVEN, PX_M)
    state = blank.state
    assert state["problems"] == []
    assert [fold["status"] for fold in state["solved"]] == ["legal"] * 3
    assert state["drawing"]["folds"][0]["start"]["point"] == pytest.approx([0.125, 0.0], abs=PX_M)
    assert state["drawing"]["folds"][0]["end"]["on"] == {"kind": "vertex", "vertex": "v5"}
    assert state["history"]["can_undo"] == "Draw fold"
    for _ in range(4):
        page.get_by_role("button", name="Undo").click()
    expect(page.locator(".blank")).to_be_visible()
    assert blank.state["history"] == {"can_undo": None, "can_redo": "Draw outline"}


def test_a_reload_finds_all_that_was_drawn(page: Page, blank: Sheet) -> None:
    hand = Hand(page)
    hand.tool("Draw outline")
    for corner in SEVEN:
        hand.click(corner)
    page.keyboard.press("Enter")
    hand.tool("Draw fold")
    hand.drag((0.125, 0.0), (0.125, 0.6))
    expect_folds(page, 1)
    before = blank.state
    page.reload()
    expect(page.locator(".corner")).to_have_count(7)
    expect_folds(page, 1)
    assert blank.state["drawing"] == before["drawing"]
    assert blank.state["history"] == before["history"]


def walk(page: Page, start: Point, end: Point) -> None:
    """Lead the cross from a point to another, both on whole millimetres."""
    for axis, names in enumerate((("ArrowLeft", "ArrowRight"), ("ArrowDown", "ArrowUp"))):
        left = round(1000 * (end[axis] - start[axis]))
        key = names[left > 0]
        for prefix, steps in (("Shift+", abs(left) // 100), ("", abs(left) % 100 // 10), ("Alt+", abs(left) % 10)):
            for _ in range(steps):
                page.keyboard.press(prefix + key)


def cross(hand: Hand) -> Point:
    """Where the keyboard's cross is, as the board says it for those who do not see it."""
    words = str(hand.page.locator(".board-pane .unseen").text_content()).replace(" cm", "").split(",")
    return float(words[0]) / 100, float(words[1]) / 100


def test_a_garment_and_its_folds_are_drawn_with_the_keyboard_alone(page: Page, blank: Sheet) -> None:
    page.keyboard.press("p")
    page.keyboard.press("ArrowUp")
    at = cross(Hand(page))
    for corner in SEVEN:
        walk(page, at, corner)
        page.keyboard.press("Enter")
        at = corner
    page.keyboard.press("Enter")
    expect(page.locator(".corner")).to_have_count(7)
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
    expect(page.get_by_role("status")).to_contain_text("Planned: ")
    solved = blank.state["solved"]
    assert solved[2]["start"] == pytest.approx([0.375, 0.25], abs=1e-6)
    assert solved[2]["end"] == pytest.approx([0.125, 0.25], abs=1e-6)


@pytest.fixture
def phone(chromium: Browser) -> Iterator[BrowserContext]:
    opened = chromium.new_context(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    opened.set_default_timeout(20_000)
    opened.route("**/viser/**", lambda route: route.abort())
    yield opened
    opened.close()


class Finger:
    """One or two fingers on the glass, by the browser's own protocol."""

    def __init__(self, page: Page) -> None:
        self.hand = Hand(page)
        self.session = page.context.new_cdp_session(page)

    def send(self, kind: str, *places: Point) -> None:
        touches = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(places)]
        self.session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})

    def tap(self, point: Point) -> None:
        self.send("touchStart", self.hand.px(point))
        self.send("touchEnd")

    def drag(self, start: Point, end: Point) -> None:
        self.send("touchStart", self.hand.px(start))
        for part in (0.2, 0.5, 0.8, 1.0):
            self.send("touchMove", self.hand.px(tuple(a + part * (b - a) for a, b in zip(start, end, strict=True))))
        self.send("touchEnd")


def test_a_garment_and_its_folds_are_drawn_with_a_finger(
    phone: BrowserContext, new_sheet: Callable[[Garment], Sheet]
) -> None:
    sheet = new_sheet(None)
    page = phone.new_page()
    page.goto(sheet.page_url)
    expect(page.locator(".blank")).to_be_visible()
    finger = Finger(page)
    page.get_by_role("button", name="Draw outline", exact=True).tap()
    for corner in [*SEVEN, SEVEN[0]]:
        finger.tap(corner)
    expect(page.locator(".corner")).to_have_count(7)
    page.get_by_role("button", name="Draw fold", exact=True).tap()
    finger.drag((0.125, 0.0), (0.125, 0.6))
    finger.drag((0.375, 0.6), (0.375, 0.0))
    finger.drag((0.375, 0.25), (0.125, 0.25))
    expect(page.locator(".strip-moment")).to_contain_text("After 3")
    expect(page.get_by_role("status")).to_contain_text("Planned: ")
    assert [fold["status"] for fold in sheet.state["solved"]] == ["legal"] * 3
    assert_near(points(sheet), SEVEN, 0.006)


def test_two_fingers_zoom_and_drop_the_stroke(phone: BrowserContext, new_sheet: Callable[[Garment], Sheet]) -> None:
    sheet = new_sheet("t-shirt")
    page = phone.new_page()
    page.goto(sheet.page_url)
    expect(page.locator(".corner")).to_have_count(10)
    finger, hand = Finger(page), Hand(page)
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
