"""A window of the page: operations of a person with the mouse, and what the window shows."""

import json
from typing import Any

from playwright.sync_api import Page, WebSocket, expect

from tests.browser.board_hand import Hand, Point
from tests.browser.conftest import Sheet
from tests.patience import wait_until

DRAWN = "new Promise(requestAnimationFrame)"
SPREAD_OUT = f"""() => {{
  for (const name of ["outline", "select"]) document.querySelector(`[data-tool=${{name}}]`).click();
  document.querySelector("[aria-label=Fit]").click();
  return {DRAWN};
}}"""
NUMBERS = "[board, pill].map((part) => Number(part.dataset.version))"
PARTS = 'const board = document.getElementById("drafting-board"), pill = document.getElementById("status");'
HAS_DRAWN = f"(version) => {{ {PARTS} return Number(board?.dataset.version) >= version; }}"
HAS_ANSWER = f"""(version) => {{
  {PARTS}
  if (!board || !pill) return false;
  const isOver = pill.ariaBusy === "false" && pill.dataset.isFinal === "true";
  return isOver && {NUMBERS}.every((shown) => shown === version);
}}"""
SHOWN = f"""() => {{
  {PARTS}
  const [x0, y0] = board.dataset.originPx.split(",").map(Number), scale = Number(board.dataset.pxPerM);
  const place = (x, y) => [(x - x0) / scale, (y0 - y) / scale];
  const all = (selector, told) => Array.from(document.querySelectorAll(selector), told);
  const number = (part, name) => Number(part.getAttribute(name));
  const ends = (line) => line.getAttribute("d").slice(1).split("L").map((end) => place(...end.split(" ").map(Number)));
  return {{
    versions: {NUMBERS},
    pixel_m: 1 / scale,
    outline: all(".corner", (corner) => place(number(corner, "cx"), number(corner, "cy"))),
    lines: all(".fold-focus", ends),
    names: all(".fold-name", (name) => name.textContent),
    kinds: all(".fold-row", (row) => row.dataset.kind),
    title: document.getElementById("garment").selectedOptions[0].text,
    undo: document.getElementById("undo").title,
    redo: document.getElementById("redo").title,
    status: pill.dataset.status,
    text: pill.innerText,
    primitives: all("[aria-label='Plan'] > li", () => 1).length,
  }};
}}"""


class Window:
    """One of several windows on the same document."""

    def __init__(self, page: Page) -> None:
        self.page, self.hand = page, Hand(page)
        self._drops: set[int] = set()
        self._answered: set[int] = set()
        page.on("websocket", self._listen)

    def open(self, sheet: Sheet) -> None:
        self.page.goto(sheet.page_url)
        self.look_at(sheet.state["version"])

    def let_go(self) -> None:
        """Drop whatever is in progress."""
        self.page.keyboard.press("Escape")
        self.page.mouse.up()
        self.page.keyboard.up("Control")

    def look_at(self, version: int) -> None:
        """Wait until this version is drawn, or a later one."""
        self.page.wait_for_function(HAS_DRAWN, arg=version)

    def wait_for_answer(self, version: int) -> None:
        """Wait until this version is drawn, and the page shows the final outcome of its planning."""
        self.page.wait_for_function(HAS_ANSWER, arg=version)

    def shown(self) -> dict[str, Any]:
        """Return all that is shown of the document, lengths in metres of the garment frame."""
        self.clear()
        return self.seen()

    def seen(self) -> dict[str, Any]:
        """Return what is shown while something is in progress."""
        shown: dict[str, Any] = self.page.evaluate(SHOWN)
        return shown

    def clear(self) -> None:
        """Spread the cloth out, all in view, with nothing selected or begun and the mouse elsewhere."""
        self.page.mouse.move(0, 0)
        self.page.evaluate(SPREAD_OUT)

    def pixel_m(self) -> float:
        return 1 / float(str(self.hand.board.get_attribute("data-px-per-m")))

    def begin_drag(self, start: Point, end: Point) -> None:
        """Begin a drag without snapping; the button stays down."""
        self.clear()
        self.page.keyboard.down("Control")
        self.hand.drag(start, end, is_released=False)
        self.page.keyboard.up("Control")
        self.page.evaluate(DRAWN)

    def end_drag(self) -> None:
        """End a drag, and wait until the server has taken the drop."""
        before = set(self._drops)
        self.page.keyboard.down("Control")
        self.page.mouse.up()
        self.page.keyboard.up("Control")
        # What the page hears is heard here only while the page is asked for something.
        wait_until(lambda: self.page.evaluate(DRAWN) and (self._drops - before) & self._answered)

    def _listen(self, socket: WebSocket) -> None:
        """Note what the page commits, and what the server answers."""

        def sent(text: str | bytes) -> None:
            message = json.loads(text)
            if message["do"] == "edit" and message["phase"] == "commit":
                self._drops.add(message["ask"])

        def heard(text: str | bytes) -> None:
            message = json.loads(text)
            if message["kind"] == "answer":
                self._answered.add(message["ask"])

        if socket.url.endswith("/live"):
            socket.on("framesent", sent)
            socket.on("framereceived", heard)

    def add_corner(self, at: Point) -> None:
        self.clear()
        self.page.mouse.dblclick(*self.hand.px(at))

    def remove_corner(self, at: Point) -> None:
        self.clear()
        self.hand.click(at)
        self.page.keyboard.press("Delete")

    def draw_fold(self, start: Point, end: Point, colour: str) -> None:
        """Draw a fold on the cloth as it lies then, which may not be where it was spread out."""
        self.clear()
        for name in ("Draw fold", "Fit", colour):
            self.hand.tool(name)
        self.page.evaluate(DRAWN)
        self.hand.drag(start, end)

    def remove_fold(self, index: int) -> None:
        self.clear()
        self.page.locator(".fold-name").nth(index).focus()
        self.page.keyboard.press("Delete")

    def paint_fold(self, index: int, colour: str) -> None:
        self.clear()
        self.page.locator(".fold-name").nth(index).click()
        self.hand.tool(colour)

    def flip_fold(self, index: int) -> None:
        self.clear()
        self.page.locator(".fold-name").nth(index).click()
        self.hand.tool("Flip")

    def rename(self, title: str) -> None:
        self.clear()
        self.hand.tool("Rename")
        dialog = self.page.get_by_role("dialog", name="Rename garment")
        dialog.get_by_label("Name").fill(title)
        self.page.keyboard.press("Enter")
        expect(dialog).to_have_count(0)

    def place(self, ahead_cm: int) -> None:
        """Set how far the garment's middle is ahead of the table's."""
        self.clear()
        self.hand.tool("Place")
        self.page.get_by_label("Ahead of the table's middle").fill(str(ahead_cm))
        self.page.keyboard.press("Enter")

    def press(self, verb: str) -> None:
        self.page.get_by_role("button", name=verb, exact=True).click()

    def count_refusals(self) -> None:
        """Count refusals from now on, also after a reload."""
        self.page.add_init_script(
            """window.refusals = 0;
            addEventListener("DOMContentLoaded", () => {
              const notices = document.getElementById("notices");
              const count = (changes) => changes.forEach(({ addedNodes }) => (window.refusals += addedNodes.length));
              if (notices) new MutationObserver(count).observe(notices, { childList: true });
            });"""
        )

    def refusals(self) -> int:
        """Return how many refusals the page has shown since it was loaded."""
        return int(self.page.evaluate("window.refusals"))
