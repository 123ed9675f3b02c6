"""A browser window on a document that measures when a drag's results are visible.

All times are of the page's clock, `performance.now()`: for a pointer event, when the browser received it; for a
drawing, when the page has put it into its tree, in the callback of the frame that shows it.
"""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from playwright.sync_api import Page, sync_playwright

SYSTEM_CHROMIUM = shutil.which("chromium")
"""The system's Chromium; None: Playwright's own."""

FLAGS = ("--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking")
FLAT = (*FLAGS, "--disable-gpu")
BY_SOFTWARE = (*FLAGS, "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
PATIENCE_MS = 60_000
MOVES = 8
"""Number of mouse movements in a drag."""

ROOMY_PX_PER_M = 1500.0
"""Zoom at which each movement of a drag over a centimetre is a pixel or two."""

KEEP_TIME = """() => {
  const board = document.getElementById("drafting-board"), pill = document.getElementById("status");
  const now = () => performance.now();
  const heard = (window.heard = {});
  window.begin = () => Object.assign(heard, { moved: [], released: [], frames: [], drawn: [], told: [] });
  window.begin();
  const frame = () => requestAnimationFrame(() => { heard.frames.push(now()); frame(); });
  frame();
  board.addEventListener("pointermove", (event) => heard.moved.push([event.timeStamp, now()]), true);
  board.addEventListener("pointerup", (event) => heard.released.push(event.timeStamp), true);
  const corners = board.querySelector(".layer-handles");
  new MutationObserver(() => heard.drawn.push(now()))
    .observe(corners, { subtree: true, attributeFilter: ["cx", "cy"] });
  new MutationObserver(() => heard.told.push([now(), Number(pill.dataset.version), pill.dataset.status]))
    .observe(pill, { attributes: true });
}"""
HAS_ANSWER = """(version) => {
  const pill = document.getElementById("status");
  return pill.ariaBusy === "false" && Number(pill.dataset.version) >= version;
}"""
HAS_VIEW = """() =>
  Boolean(document.getElementById("view3d").contentWindow.__viserMutable?.nodeRefFromName["/cloth/front"])"""
HAS_BOARD = """() => Number(document.getElementById("drafting-board")?.dataset.version) > 0"""
FIT = """() => {
  for (const name of ["outline", "select"]) document.querySelector(`[data-tool=${name}]`).click();
  document.querySelector("[aria-label=Fit]").click();
}"""
QUICK_MS, QUICK_FRAMES = 40.0, 20
"""The page is at rest when this many frames in a row come within this time; frames that software draws do not."""

STAYS_QUICK = """async ([quickMs, quickFrames]) => {
  const frame = () => new Promise(requestAnimationFrame);
  for (let quick = 0, before = await frame(), now; quick < quickFrames; before = now) {
    now = await frame();
    quick = now - before < quickMs ? quick + 1 : 0;
  }
}"""
RESTS = "new Promise((done) => requestAnimationFrame(() => requestIdleCallback(done)))"
CORNER = """(index) => {
  const corner = document.querySelectorAll(".corner")[index], box = corner.ownerSVGElement.getBoundingClientRect();
  const { pxPerM } = corner.ownerSVGElement.dataset;
  return [box.left + corner.cx.baseVal.value, box.top + corner.cy.baseVal.value, Number(pxPerM)];
}"""


@dataclass(frozen=True, slots=True)
class Heard:
    """The page's measurements of a drag (ms).

    Attributes:
        to_ghost_ms: for each movement that is seen, from the pointer event to the corner drawn there.
        same_frame: for each of them, whether that was in the very next frame.
        to_plan_ms: from the release to the status of the plan for the dropped drawing.
        status: that plan's status.
    """

    to_ghost_ms: tuple[float, ...]
    same_frame: tuple[bool, ...]
    to_plan_ms: float
    status: str

    @classmethod
    def of(cls, kept: dict[str, Any], version: int) -> "Heard":
        """Return the measurements in the record of `KEEP_TIME`; a drag begins only some pixels from the press."""
        told = next(told for told in kept["told"] if told[1] == version)
        drawn = kept["drawn"]
        moves = [move for move in kept["moved"] if drawn[0] < move[1] < drawn[-1]]
        seen = [(*move, next(at for at in drawn if at > move[1])) for move in moves]
        return cls(
            tuple(at - moved_at for moved_at, _, at in seen),
            tuple(sum(since < frame <= at for frame in kept["frames"]) == 1 for _, since, at in seen),
            told[0] - kept["released"][0],
            told[2],
        )


@contextmanager
def window(url: str, *, has_view: bool) -> Iterator[Page]:
    """Yield a page that keeps time, its 3D view at rest or left out; raise Playwright's error without a browser."""
    with sync_playwright() as playwright:
        flags = BY_SOFTWARE if has_view else FLAT
        browser = playwright.chromium.launch(executable_path=SYSTEM_CHROMIUM, args=flags)
        page = browser.new_page(viewport={"width": 1024, "height": 768})
        page.set_default_timeout(PATIENCE_MS)
        if not has_view:
            page.route("**/viser/**", lambda route: route.abort())
        page.goto(url)
        page.wait_for_function(HAS_VIEW if has_view else HAS_BOARD)
        page.evaluate(KEEP_TIME)
        yield page
        browser.close()


def wait_for_answer(page: Page, version: int) -> None:
    """Wait until the page shows the status of the plan of a version, or a later one, and is idle."""
    page.wait_for_function(HAS_ANSWER, arg=version)
    page.evaluate(RESTS)


def wait_for_rest(page: Page) -> None:
    """Wait until the page and its 3D view have drawn everything."""
    page.evaluate(STAYS_QUICK, [QUICK_MS, QUICK_FRAMES])


def grasp(page: Page, corner: int) -> tuple[float, float, float]:
    """Zoom in on a corner, with nothing selected; return its position (px) and the pixels for a metre."""
    page.evaluate(FIT)
    page.evaluate(RESTS)
    x, y, scale = page.evaluate(CORNER, corner)
    page.mouse.move(x, y)
    while scale < ROOMY_PX_PER_M:
        page.mouse.wheel(0.0, -200.0)
        page.wait_for_function("(s) => Number(document.getElementById('drafting-board').dataset.pxPerM) > s", arg=scale)
        x, y, scale = page.evaluate(CORNER, corner)
        page.mouse.move(x, y)
    return x, y, scale


def drag(page: Page, start: tuple[float, float], by: tuple[float, float]) -> None:
    """Press at the start, move the mouse by an offset (px) without snapping, and release."""
    page.evaluate("window.begin()")
    page.keyboard.down("Control")
    page.mouse.down()
    for part in range(1, MOVES + 1):
        page.mouse.move(start[0] + by[0] * part / MOVES, start[1] + by[1] * part / MOVES)
    page.mouse.up()
    page.keyboard.up("Control")


def heard(page: Page, version: int) -> Heard:
    """Return the measurements of the drag that has led to a version."""
    return Heard.of(page.evaluate("window.heard"), version)
