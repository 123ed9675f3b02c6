"""Fingers on the drafting board."""

from playwright.sync_api import Page

from tests.browser.board_hand import Hand, Point


class Finger:
    """A hand that touches the screen with one or two fingers, through the browser's debugging protocol."""

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
            x, y = (a + part * (b - a) for a, b in zip(start, end, strict=True))
            self.send("touchMove", self.hand.px((x, y)))
        self.send("touchEnd")
