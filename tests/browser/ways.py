"""Three ways to operate the page: with a mouse, with the keyboard alone, with a finger."""

from typing import Protocol

from playwright.sync_api import Page, expect

from tests.browser.board_finger import Finger
from tests.browser.board_hand import Hand, Point
from tests.browser.board_keys import cross, tab_to, walk


class Way(Protocol):
    """Operations of a person; each call returns when the page has received the input."""

    def draw_outline(self, corners: list[Point]) -> None: ...

    def draw_folds(self, lines: list[tuple[Point, Point]]) -> None:
        """Draw folds one after the other, each once the list has the one before."""

    def take(self, corner: int, at: Point) -> None:
        """Take hold of a corner of the outline, without snapping."""

    def pull_down(self, to: Point) -> None:
        """Pull it down, by whole centimetres."""

    def let_go(self) -> None: ...

    def press(self, button: str) -> None:
        """Press the button whose name begins like this."""

    def undo(self) -> None: ...


class ByMouse:
    """Clicks, and drags with the button down."""

    def __init__(self, page: Page) -> None:
        self.page, self.hand = page, Hand(page)

    def draw_outline(self, corners: list[Point]) -> None:
        self.hand.tool("Draw outline")
        expect(self.page.locator(".blank")).to_be_hidden()
        for corner in [*corners, corners[0]]:
            self.hand.click(corner)

    def draw_folds(self, lines: list[tuple[Point, Point]]) -> None:
        self.hand.tool("Draw fold")
        for count, line in enumerate(lines):
            self.hand.drag(*line)
            expect_folds(self.page, count + 1)
        self.hand.tool("Select")

    def take(self, corner: int, at: Point) -> None:
        for tool in ("Draw outline", "Select"):  # the first shows the cloth spread out
            self.hand.tool(tool)
        self.page.mouse.move(*self.hand.px(at))
        self.page.keyboard.down("Control")
        self.page.mouse.down()

    def pull_down(self, to: Point) -> None:
        self.page.mouse.move(*self.hand.px(to), steps=2)

    def let_go(self) -> None:
        self.page.mouse.up()
        self.page.keyboard.up("Control")

    def press(self, button: str) -> None:
        self.page.get_by_role("button", name=button).first.click()

    def undo(self) -> None:
        self.press("Undo")


class ByKeyboard:
    """Letters choose tools, arrows move the cursor, Enter sets a point, Tab moves the focus."""

    def __init__(self, page: Page) -> None:
        self.page = page

    def draw_outline(self, corners: list[Point]) -> None:
        self.page.keyboard.press("p")
        self.page.keyboard.press("ArrowUp")
        self.at = cross(self.page)
        for corner in corners:
            self.put(corner)
        self.page.keyboard.press("Enter")

    def draw_folds(self, lines: list[tuple[Point, Point]]) -> None:
        self.page.keyboard.press("f")
        for count, line in enumerate(lines):
            for end in line:
                self.put(end)
            expect_folds(self.page, count + 1)

    def put(self, point: Point) -> None:
        walk(self.page, self.at, point)
        self.page.keyboard.press("Enter")
        self.at = point

    def take(self, corner: int, at: Point) -> None:
        self.page.keyboard.press("p")  # it shows the cloth spread out
        self.page.keyboard.press("v")
        self.page.keyboard.press("Escape")
        tab_to(self.page, f"Vertex {corner + 1}: ")
        self.at = at

    def pull_down(self, to: Point) -> None:
        for _ in range(round(100 * (self.at[1] - to[1]))):
            self.page.keyboard.press("Shift+ArrowDown")
        self.at = to

    def let_go(self) -> None:
        self.page.keyboard.press("Escape")

    def press(self, button: str) -> None:
        tab_to(self.page, button)
        self.page.keyboard.press("Enter")

    def undo(self) -> None:
        self.page.keyboard.press("Control+z")


class ByFinger:
    """Taps and strokes on a phone, which shows folds and reasons on a sheet that is pulled up."""

    def __init__(self, page: Page) -> None:
        self.page, self.finger = page, Finger(page)

    def draw_outline(self, corners: list[Point]) -> None:
        before = scale(self.page)
        expect(self.page.locator("#swap")).to_be_hidden()  # a blank board is all that there is to see
        self.tap("Draw outline")
        self.zoom_in(middle(corners))
        expect_twice_as_large(self.page, before)
        for corner in [*corners, corners[0]]:
            self.finger.tap(corner)

    def zoom_in(self, about: Point) -> None:
        x, y = self.finger.hand.px(about)
        self.finger.send("touchStart", (x - 40, y), (x + 40, y))
        self.finger.send("touchMove", (x - 60, y), (x + 60, y))
        self.finger.send("touchMove", (x - 80, y), (x + 80, y))
        self.finger.send("touchEnd")

    def draw_folds(self, lines: list[tuple[Point, Point]]) -> None:
        self.tap("Draw fold")
        for count, line in enumerate(lines):
            self.finger.drag(*line)
            expect_folds(self.page, count + 1)
        self.tap("Select")

    def take(self, corner: int, at: Point) -> None:
        for button in ("Draw outline", "Select", "Snap"):
            self.tap(button)
        self.finger.send("touchStart", self.finger.hand.px(at))

    def pull_down(self, to: Point) -> None:
        self.finger.send("touchMove", self.finger.hand.px(to))

    def let_go(self) -> None:
        self.finger.send("touchEnd")

    def press(self, button: str) -> None:
        self.tap("Show folds and timeline")
        self.page.get_by_role("button", name=button).first.tap()
        self.tap("Hide folds and timeline")

    def undo(self) -> None:
        self.tap("Undo")

    def tap(self, button: str) -> None:
        self.page.get_by_role("button", name=button, exact=True).tap()


def middle(points: list[Point]) -> Point:
    """Return the middle of the bounding box of some points."""
    xs, ys = zip(*points, strict=True)
    return (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2


def scale(page: Page) -> float:
    return float(str(Hand(page).board.get_attribute("data-px-per-m")))


def expect_twice_as_large(page: Page, before: float) -> None:
    page.wait_for_function(f"document.getElementById('drafting-board').dataset.pxPerM > {1.8 * before}")


def expect_folds(page: Page, count: int) -> None:
    """Expect this number of folds, also on a sheet that is not pulled up."""
    expect(page.locator(".fold-list > li")).to_have_count(count)
