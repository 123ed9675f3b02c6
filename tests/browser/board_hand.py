"""A hand on the drafting board that works in the garment frame."""

from playwright.sync_api import Locator, Page, expect

Point = tuple[float, float]

# A vest-like garment of seven corners, 0.5 x 0.6 m: its neck is the corner in the middle of the top.
SEVEN = [(0.0, 0.0), (0.5, 0.0), (0.5, 0.4), (0.375, 0.6), (0.25, 0.5), (0.125, 0.6), (0.0, 0.4)]


class Hand:
    """A mouse led to points of the garment frame (m), wherever the board shows them."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.board: Locator = page.get_by_role("application", name="Drafting board")

    def px(self, point: Point) -> Point:
        """Return the position in the window of a point of the garment frame (px), once the board shows a document."""
        expect(self.board).to_have_attribute("aria-busy", "false")
        box = self.board.bounding_box()
        assert box is not None
        x0, y0 = (float(part) for part in str(self.board.get_attribute("data-origin-px")).split(","))
        scale = float(str(self.board.get_attribute("data-px-per-m")))
        return box["x"] + x0 + point[0] * scale, box["y"] + y0 - point[1] * scale

    def click(self, point: Point) -> None:
        self.page.mouse.move(*self.px(point), steps=6)
        # While an outline is drawn the board widens at its edge, when it is drawn next.
        self.page.evaluate("new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))")
        self.page.mouse.click(*self.px(point))

    def drag(self, start: Point, end: Point, *, is_released: bool = True) -> None:
        self.page.mouse.move(*self.px(start))
        self.page.mouse.down()
        self.page.mouse.move(*self.px(((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)), steps=3)
        self.page.mouse.move(*self.px(end), steps=3)
        if is_released:
            self.page.mouse.up()

    def enlarge(self) -> None:
        """Tap the inset of a phone that shows the board, and wait until the board has grown."""
        expect(self.board).to_have_attribute("aria-busy", "false")
        small = str(self.board.get_attribute("data-px-per-m"))
        self.page.get_by_role("button", name="Show the board large").tap()
        expect(self.board).not_to_have_attribute("data-px-per-m", small)

    def tool(self, name: str) -> None:
        self.page.get_by_role("button", name=name, exact=True).click()
