"""From a blank board to a plan, to none, to a suggestion and back: with the mouse, the keyboard, a finger."""

import csv
import io
import json
import math
import re
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

from app.files.exports import EXPORTS
from tests.app.conftest import Served
from tests.browser.board_hand import Point
from tests.browser.conftest import PATIENCE_MS, Garment, Sheet, windows
from tests.browser.searches import SEARCH_MS
from tests.browser.status_pill import expect_planned
from tests.browser.ways import ByFinger, ByKeyboard, ByMouse, Way, expect_folds

# 0.4 x 0.3 m: sides that end in peaks, a notch between them. Both sides are folded in, then it is halved.
CORNERS: list[Point] = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.2), (0.3, 0.3), (0.2, 0.2), (0.1, 0.3), (0.0, 0.2)]
FOLDS: list[tuple[Point, Point]] = [((0.1, 0.0), (0.1, 0.3)), ((0.3, 0.3), (0.3, 0.0)), ((0.3, 0.1), (0.1, 0.1))]
PULLED = 1
PULLS_M = (0.08, 0.2, 0.28, 0.3, 0.32, 0.34, 0.36, 0.4)
# Where a hand puts a point: within a few pixels, and a pixel is some 3 mm there.
NEAR_M = 0.008

NO_PLAN = "No plan: "
SMALL = {"width": 900, "height": 500}
PHONE: dict[str, Any] = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


def there_and_back(page: Page, way: Way, sheet: Sheet) -> dict[str, Any]:
    """Do everything that a person does with the hands; return the document as it was before the undos."""
    page.goto(sheet.page_url)
    expect(page.locator(".blank")).to_be_visible()
    blank = sheet.state
    way.draw_outline(CORNERS)
    expect(page.locator(".corner")).to_have_count(7)
    way.draw_folds(FOLDS)
    status = page.get_by_role("status")
    drawn = sheet.state
    expect_answer(page, drawn["version"])
    expect(status).to_contain_text(re.compile("^Planned: [1-9]"))
    for corner, wanted in zip(drawn["drawing"]["outline"], CORNERS, strict=True):
        assert math.dist(corner["point"], wanted) < NEAR_M
    assert [fold["status"] for fold in drawn["solved"]] == ["legal"] * 3

    pull_until_there_is_no_plan(page, way, sheet)
    expect(status).to_have_attribute("data-is-final", "true", timeout=SEARCH_MS)
    sentence = status.inner_text().removeprefix(NO_PLAN)
    assert sentence.startswith(("Left over: ", "Right over: ", "Bottom up: "))  # its corners are beyond the edge
    expect(page.locator(".reason")).to_have_text(f"{sentence}.")
    pulled = sheet.at_rest()
    assert pulled["history"]["can_undo"] == "Move vertex"
    assert pulled["drawing"]["outline"][PULLED]["point"][1] < -0.05

    expect(page.locator(".cards button", has_text="Move the garment").first).to_be_attached(timeout=SEARCH_MS)
    if (folded := page.get_by_role("button", name="Show suggestions")).is_visible():  # a low board has one line
        way.press("Show suggestions")
        expect(folded).to_be_hidden()
    way.press("Move the garment")
    expect_planned(page)
    helped = sheet.state
    assert helped["history"]["can_undo"].startswith("Move the garment ")
    assert helped["drawing"]["outline"] == pulled["drawing"]["outline"]
    assert helped["drawing"]["placement"] != pulled["drawing"]["placement"]

    undo_everything(page, way, sheet)
    expect(page.locator(".blank")).to_be_visible()
    assert sheet.drawing == blank["drawing"]
    return helped


def pull_until_there_is_no_plan(page: Page, way: Way, sheet: Sheet) -> None:
    """Pull further and further, each time once the page has the previous plan; then release."""
    status = page.get_by_role("status")
    x, y = sheet.drawing["outline"][PULLED]["point"]
    way.take(PULLED, (x, y))
    for pull_m in PULLS_M:
        way.pull_down((x, y - pull_m))
        expect_answer(page, until_it_is_at(sheet, y - pull_m))
        if status.get_attribute("data-status") == "infeasible":
            break
    way.let_go()
    expect(status).to_contain_text(NO_PLAN)


def until_it_is_at(sheet: Sheet, y: float) -> int:
    """Wait until the server has the corner there; return the version."""
    for _ in range(PATIENCE_MS // 20):
        state = sheet.state
        if abs(state["drawing"]["outline"][PULLED]["point"][1] - y) < NEAR_M / 2:
            return int(state["version"])
        time.sleep(0.02)
    raise AssertionError(f"the corner does not come to {y}")


def expect_answer(page: Page, version: int) -> None:
    """Expect the page to show this version, or a later one, and the outcome of its planning."""
    shown = "['drafting-board', 'status'].map((id) => Number(document.getElementById(id).dataset.version))"
    page.wait_for_function(f"(version) => {shown}.every((other) => other >= version)", arg=version, timeout=SEARCH_MS)


def step(page: Page, way_there: Callable[[], None]) -> None:
    """Undo or redo a step, and wait until the board shows it."""
    board = page.get_by_role("application", name="Drafting board")
    before = str(board.get_attribute("data-version"))
    way_there()
    expect(board).not_to_have_attribute("data-version", before)


def undo_everything(page: Page, way: Way, sheet: Sheet) -> None:
    while sheet.can_undo is not None:
        step(page, way.undo)


def redo_everything(page: Page, sheet: Sheet) -> None:
    while sheet.state["history"]["can_redo"] is not None:
        step(page, page.get_by_role("button", name="Redo").click)


def expect_all_of(page: Page, sheet: Sheet, state: dict[str, Any]) -> None:
    """Expect the page to show a document as it was, with its plan and its whole history."""
    expect_planned(page)
    expect(page.locator(".corner")).to_have_count(7)
    expect_folds(page, 3)
    expect(page.get_by_role("button", name="Undo")).to_have_attribute(
        "title", f"Undo: {state['history']['can_undo']} (Ctrl+Z)"
    )
    found = sheet.state
    assert found["drawing"] == state["drawing"]
    assert found["history"] == state["history"]


def exported(page: Page, folder: Path) -> dict[str, str]:
    """Save all files that the dialog `Export` offers; return their contents by name."""
    page.get_by_role("button", name="Export", exact=True).click()
    dialog = page.get_by_role("dialog", name="Export")
    expect(dialog.get_by_role("listitem")).to_have_count(len(EXPORTS))
    saved = {}
    for verb in dialog.locator("[aria-label^='Save ']").all():
        with page.expect_download() as download:
            verb.click()
        path = folder / download.value.suggested_filename
        download.value.save_as(path)
        saved[path.name] = path.read_text(encoding="utf-8", errors="replace")
    page.keyboard.press("Escape")
    return saved


@pytest.mark.long
def test_with_the_keyboard_alone(chromium: Browser, new_sheet: Callable[[Garment], Sheet]) -> None:
    with windows(chromium, viewport=SMALL) as context:
        page = context.new_page()
        there_and_back(page, ByKeyboard(page), new_sheet(None))


@pytest.mark.long
def test_with_a_finger_on_a_phone(chromium: Browser, new_sheet: Callable[[Garment], Sheet]) -> None:
    with windows(chromium, **PHONE) as context:
        page = context.new_page()
        there_and_back(page, ByFinger(page), new_sheet(None))


def test_with_the_mouse_and_all_of_it_is_found_again_and_leaves_as_files(
    chromium: Browser, designer: Served, new_sheet: Callable[[Garment], Sheet], tmp_path: Path
) -> None:
    sheet = new_sheet(None)
    with windows(chromium, viewport=SMALL) as context:
        page = context.new_page()
        whole = there_and_back(page, ByMouse(page), sheet)
        redo_everything(page, sheet)
        page.reload()
        expect_all_of(page, sheet, whole)

        page.evaluate("window.isOfBefore = true")
        designer.stop()
        expect(page.get_by_role("status")).to_contain_text("Connection lost")
        designer.start_again()
        expect_all_of(page, sheet, whole)
        assert page.evaluate("window.isOfBefore"), "the page came back by being loaded anew"

        saved = exported(page, tmp_path)
        outline = [corner["point"] for corner in whole["drawing"]["outline"]]
        assert json.loads(saved.pop("untitled.json"))["outline"] == outline
        plan = json.loads(saved.pop("untitled.plan.json"))
        assert plan["status"] == "solved"
        order = [done["fold"] for done in plan["primitives"] if done["kind"] == "fold"]
        assert order in ([0, 1, 2], [1, 0, 2])  # the sides wait for nothing
        assert len(json.loads(saved.pop("untitled.fold"))["file_frames"]) == 3  # the first is the file itself
        rows = list(csv.DictReader(io.StringIO(saved.pop("untitled-plan.csv"))))
        assert [row["fold"] for row in rows if row["kind"] == "fold"] == [str(fold) for fold in order]
        assert saved.pop("untitled-steps.pdf").startswith("%PDF-")
        assert "Vest" in saved.pop("untitled-steps.svg")
        drawing = saved.pop("untitled.svg")
        for ending in (".mcap", ".glb", "-mjcf.zip", "-rosbag2.zip", "-lerobot.zip", "-poses.yaml"):
            assert saved.pop(f"untitled{ending}")
        assert json.loads(saved.pop("untitled-poses.json"))["version"] == 1
        ((name, recording),) = saved.items()
        assert name.endswith(".html")
        assert "<title>Vest - Pleat</title>" in recording

        page.get_by_role("button", name="Import", exact=True).click()
        file: Any = {"name": "again.svg", "mimeType": "image/svg+xml", "buffer": drawing.encode()}
        page.get_by_label("File", exact=True).set_input_files([file])
        page.get_by_role("button", name="Open here").click()
        expect(page.get_by_role("button", name="Undo")).to_have_attribute("title", "Undo: Import again.svg (Ctrl+Z)")
        expect_planned(page)
        again = sheet.drawing
        for corner, wanted in zip(again["outline"], outline, strict=True):
            assert math.dist(corner["point"], wanted) < 1e-4
        assert [fold["kind"] for fold in again["folds"]] == ["blue"] * 3
