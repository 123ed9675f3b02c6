"""Takes the pictures of the documents from the real page, in a browser: `make pictures`."""

import io
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any

from PIL import Image
from playwright.sync_api import Page, expect, sync_playwright

from bench.hand_page import BY_SOFTWARE, HAS_VIEW, SYSTEM_CHROMIUM
from bench.served import ask, served

FOLDER = Path(__file__).parent
SIZE_PX = (1200, 750)
MOVING = "folding"
"""The moving picture."""

_PATIENCE_MS = 600_000
"""The time for the slowest of them, a rehearsal, on a busy machine (ms)."""

_SETTLED_MS = 7_000
"""The time in which the 3D view follows a change (ms): two drawings of it."""

_READY = """
localStorage.setItem("pleat-coached", "outline play");
if (location.pathname.includes("/viser/")) {
  window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 3000);
  window.cancelAnimationFrame = clearTimeout;
}
"""
"""Hides the words to newcomers, and has the 3D view drawn every 3 s: drawn by software, it would take all
there is."""

_FRAMES, _FRAME_MS, _LAST_FRAME_MS = 36, 150, 1500
_QUALITY, _MOVING_QUALITY = 82, 60

Edges = list[list[float]]


def towel(name: str, long_m: float, *folds: dict[str, Any]) -> dict[str, Any]:
    """Return a towel that lies before the robot."""
    outline: Edges = [[0.0, 0.0], [0.4, 0.0], [0.4, long_m], [0.0, long_m]]
    placement = {"x_m": -0.7, "y_m": 0.2, "yaw_rad": -1.5708}
    return {"name": name, "title": "Towel", "outline": outline, "folds": list(folds), "placement": placement}


def _across(at_m: float) -> dict[str, Any]:
    return {"name": "half", "kind": "blue", "start": [0.4, at_m], "end": [0.0, at_m]}


def draw(page: Page, url: str) -> None:
    """Show a towel with one fold, planned."""
    _open(page, url, towel("towel", 0.6, _across(0.3)))
    _expect_planned(page)


def blocked(page: Page, url: str) -> None:
    """Show a towel that is too long, why, and what would help."""
    _open(page, url, towel("long-towel", 1.5, _across(0.75)))
    expect(page.get_by_role("status")).to_contain_text("No plan: ")
    expect(page.get_by_role("status")).to_have_attribute("data-is-final", "true")
    expect(page.locator(".suggestion-strip .cards button").first).to_be_visible()
    page.get_by_role("button", name="Fit", exact=True).click()


def repaired(page: Page, url: str) -> None:
    """Show what became of it by the first suggestion."""
    blocked(page, url)
    page.locator(".suggestion-strip .cards button").first.click()
    _expect_planned(page)


def folded_for_me(page: Page, url: str) -> None:
    """Show ways to fold a towel to half its length."""
    _open(page, url, towel("plain-towel", 0.6))
    page.get_by_role("button", name="Fold it for me").click()
    panel = page.get_by_role("region", name="Fold it for me")
    panel.get_by_role("button", name="Halves").click()
    card = panel.get_by_role("group", name="Ways to fold it").get_by_role("button").first
    expect(card).to_have_attribute("data-status", "solved")
    expect(card.locator(".picture-layer")).not_to_have_count(0)
    expect(panel.get_by_role("progressbar")).to_be_hidden()
    card.hover()


def rehearsed(page: Page, url: str) -> None:
    """Show a rehearsal that has ended."""
    draw(page, url)
    page.get_by_role("button", name="Rehearse", exact=True).click()
    expect(page.locator(".mark").first).to_be_visible()


def exported(page: Page, url: str) -> None:
    """Show the files that there are of a plan."""
    draw(page, url)
    page.get_by_role("button", name="Export", exact=True).click()
    expect(page.get_by_role("dialog", name="Export").get_by_role("listitem").first).to_be_visible()


PICTURES: Mapping[str, Callable[[Page, str], None]] = MappingProxyType(
    {
        "draw": draw,
        "blocked": blocked,
        "repaired": repaired,
        "folded-for-me": folded_for_me,
        "rehearsed": rehearsed,
        "exported": exported,
    }
)
"""What brings the page to what a picture shows, given the server's URL, by the name of the picture."""


def still(page: Page) -> bytes:
    """Return what a page shows as a WebP file."""
    written = io.BytesIO()
    _shot(page).save(written, "webp", quality=_QUALITY, method=6)
    return written.getvalue()


def moving(page: Page, url: str) -> bytes:
    """Return the folding of a T-shirt as a moving WebP file."""
    document = _open(page, url, "t-shirt")
    _expect_planned(page)
    page.wait_for_function(HAS_VIEW)
    lasts_s = float(ask("POST", f"{document}/playback", {"do": "pause"})["duration_s"])
    frames = []
    for number in range(_FRAMES):
        ask("POST", f"{document}/playback", {"do": "seek", "t_s": lasts_s * number / (_FRAMES - 1)})
        page.wait_for_timeout(_SETTLED_MS)
        frames.append(_shot(page))
    written = io.BytesIO()
    shown_ms = [_FRAME_MS] * (_FRAMES - 1) + [_LAST_FRAME_MS]
    options: dict[str, Any] = {"duration": shown_ms, "loop": 0, "quality": _MOVING_QUALITY, "method": 6}
    frames[0].save(written, "webp", save_all=True, append_images=frames[1:], minimize_size=True, **options)
    return written.getvalue()


def main(names: list[str]) -> None:
    """Take these pictures, or all, and write them beside this file."""
    with served() as (url, _):
        for name in names or [MOVING, *PICTURES]:
            with _window() as page:
                if name == MOVING:
                    data = moving(page, url)
                else:
                    PICTURES[name](page, url)
                    page.wait_for_function(HAS_VIEW)
                    page.wait_for_timeout(_SETTLED_MS)
                    data = still(page)
            (FOLDER / f"{name}.webp").write_bytes(data)
            print(f"{name}.webp: {len(data) // 1000} kB", flush=True)


@contextmanager
def _window() -> Iterator[Page]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=SYSTEM_CHROMIUM, args=BY_SOFTWARE)
        width, height = SIZE_PX
        page = browser.new_page(viewport={"width": width, "height": height})
        page.add_init_script(_READY)
        page.set_default_timeout(_PATIENCE_MS)
        expect.set_options(timeout=_PATIENCE_MS)
        yield page
        browser.close()


def _open(page: Page, url: str, garment: str | dict[str, Any]) -> str:
    """Open a document of a garment, and return its path in the API."""
    made = ask("POST", f"{url}/api/documents", {"garment": garment})
    page.goto(f"{url}/d/{made['id']}")
    return f"{url}/api/documents/{made['id']}"


def _expect_planned(page: Page) -> None:
    status = page.get_by_role("status")
    expect(status).to_contain_text("Planned: ")
    expect(status).to_have_attribute("data-is-final", "true")


def _shot(page: Page) -> Image.Image:
    return Image.open(io.BytesIO(page.screenshot())).convert("RGB")


if __name__ == "__main__":
    main(sys.argv[1:])
