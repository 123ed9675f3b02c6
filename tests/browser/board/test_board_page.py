"""The page round the board: splitter, phone, lost server, photo."""

import struct
import zlib
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest
from playwright.sync_api import FilePayload, Page, expect

from tests.browser.board_desk import Desk, expect_step
from tests.browser.board_hand import Hand
from tests.browser.conftest import REST, Garment, Sheet
from tests.browser.status_pill import expect_planned


def chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


# A grey picture of 2 x 1 pixels.
HEADER = chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 1, 8, 0, 0, 0, 0))
PNG = b"\x89PNG\r\n\x1a\n" + HEADER + chunk(b"IDAT", zlib.compress(b"\x00\x40\x80")) + chunk(b"IEND", b"")

UNTIL_KEPT_SCALED = """async () => {
  const photos = () => new Promise((resolve) => {
    const opening = indexedDB.open("pleat", 1);
    opening.onsuccess = () => {
      const all = opening.result.transaction("photos").objectStore("photos").getAll();
      all.onsuccess = () => { opening.result.close(); resolve(all.result); };
    };
  });
  while (!(await photos()).some(({ scale }) => scale < 0.3)) await new Promise((resolve) => setTimeout(resolve, 20));
}"""
"""Waits until the browser has kept a photo at less than 0.3 m per pixel; one 2 pixels wide has 0.4 at first."""


def width(page: Page) -> float:
    box = page.get_by_role("application", name="Drafting board").bounding_box()
    assert box is not None
    return box["width"]


def test_the_splitter_is_moved_by_the_arrow_keys_and_the_mouse_and_remembered(page: Page, towel: Desk) -> None:
    splitter = page.get_by_role("separator", name="Board and 3D view")
    first = width(page)
    splitter.focus()
    page.keyboard.press("ArrowRight")
    assert width(page) > first + 5
    box = splitter.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 3, box["y"] + 100)
    page.mouse.down()
    page.mouse.move(box["x"] - 197, box["y"] + 100, steps=4)
    page.mouse.up()
    pulled = width(page)
    assert pulled == pytest.approx(first - 180, abs=15)
    page.reload()
    expect(page.locator(".corner")).to_have_count(4)
    assert width(page) == pytest.approx(pulled, abs=1)


def test_without_a_network_the_tools_rest_until_it_is_back(page: Page, towel: Desk) -> None:
    Hand(page).click((0.0, 0.0))
    before = page.locator(".corner").first.get_attribute("aria-label")
    page.context.set_offline(True)
    expect(page.locator(".hint-line")).to_contain_text("Offline")
    page.keyboard.press("ArrowRight")
    page.context.set_offline(False)
    expect(page.locator("#rail")).not_to_have_attribute("inert", "")
    expect(page.locator(".corner").first).to_have_attribute("aria-label", str(before))
    page.keyboard.press("ArrowRight")
    expect(page.locator(".corner").first).to_have_attribute("aria-label", "Vertex 1: 0.1, 0.0 cm")


def test_a_photo_lies_under_the_board_and_is_scaled_by_two_points(page: Page, towel: Desk) -> None:
    hand = Hand(page)
    with page.expect_file_chooser() as chooser:
        hand.tool("Photo")
    chooser.value.set_files([FilePayload(name="photo.png", mimeType="image/png", buffer=PNG)])
    photo = page.locator("image.photo")
    expect(photo).to_have_count(1)
    scale = float(str(hand.board.get_attribute("data-px-per-m")))
    assert float(str(photo.get_attribute("width"))) == pytest.approx(0.8 * scale, rel=1e-6)
    hand.click((0.1, 0.1))
    hand.click((0.3, 0.1))
    page.get_by_label("Length", exact=True).fill("10")
    page.keyboard.press("Enter")
    # Two points 20 cm apart are said to be 10 cm apart, so the photo is half as wide.
    page.wait_for_function(f"Math.abs(document.querySelector('image.photo').width.baseVal.value - {0.4 * scale}) < 3")
    page.evaluate(UNTIL_KEPT_SCALED)
    page.reload()
    expect(photo).to_have_count(1)
    hand.tool("Photo")
    page.keyboard.press("Delete")
    expect(photo).to_have_count(0)


def test_on_a_phone_the_views_are_swapped_and_the_sheet_is_pulled_up(
    phone: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    phone.goto(new_sheet("hand-towel").page_url)
    expect(phone.locator(".corner")).to_have_count(4)
    assert width(phone) < 120
    expect(phone.get_by_role("combobox", name="Robot")).to_be_visible()
    hand = Hand(phone)
    hand.enlarge()
    assert width(phone) == 390
    before = hand.px((0.0, 0.0))
    scale = hand.board.get_attribute("data-px-per-m")
    expect(phone.get_by_role("combobox", name="Robot")).to_be_hidden()
    phone.get_by_role("button", name="Show the 3D view large").tap()
    assert width(phone) < 120
    phone.get_by_role("button", name="Show the board large").tap()
    assert width(phone) == 390
    expect(hand.board).to_have_attribute("data-px-per-m", str(scale))
    assert hand.px((0.0, 0.0)) == pytest.approx(before, abs=1)
    sheets = phone.get_by_role("button", name="Play", exact=True)
    expect(sheets).to_have_count(0)
    phone.get_by_role("button", name="Show folds and timeline").tap()
    expect(sheets).to_be_visible()
    expect(phone.get_by_role("list", name="Folds")).to_be_attached()
    phone.get_by_role("button", name="Hide folds and timeline").tap()
    expect(sheets).to_have_count(0)


def test_nothing_is_wider_than_a_phone(phone: Page, new_sheet: Callable[[Garment], Sheet]) -> None:
    phone.goto(new_sheet("t-shirt").page_url)
    expect(phone.locator(".corner")).to_have_count(10)
    assert phone.evaluate("document.documentElement.scrollWidth") == 390
    for name in ("Gallery", "Import", "Export", "Undo", "Help"):
        box = phone.get_by_role("button", name=name, exact=True).bounding_box()
        assert box is not None
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= 390


def test_a_garment_is_renamed_on_a_phone_in_the_gallery(phone: Page, new_sheet: Callable[[Garment], Sheet]) -> None:
    sheet = new_sheet("hand-towel")
    phone.goto(sheet.page_url)
    expect(phone.locator(".corner")).to_have_count(4)
    phone.get_by_role("button", name="Gallery", exact=True).tap()
    tile = phone.locator(".tile-own").filter(has_text="open now")
    tile.get_by_role("button", name="More for").tap()
    phone.get_by_role("menuitem", name="Rename").tap()
    phone.get_by_label("Name", exact=True).fill("Guest towel")
    phone.keyboard.press("Enter")
    expect(phone).to_have_title("Guest towel - Pleat")
    assert sheet.drawing["name"] == "guest-towel"


def test_every_name_that_others_look_for_is_there_once(page: Page, desk: Desk) -> None:
    desk.lay(desk.garment("t-shirt"))
    expect_planned(page)
    names = "Draw outline,Draw fold,Select,Undo,Redo,Play,Blue: all layers,Red: last flap,Flip,New,Import,Export"
    for name in names.split(","):
        expect(page.get_by_role("button", name=name)).to_have_count(1)
    expect(page.get_by_role("combobox", name="Garment")).to_have_count(1)
    expect(page.get_by_role("slider", name="Time")).to_have_count(1)
    for name in ("Folds", "Plan"):
        expect(page.get_by_role("list", name=name)).to_have_count(1)
    expect(page.get_by_role("application", name="Drafting board")).to_have_count(1)


def scale(page: Page) -> str | None:
    return page.get_by_role("application", name="Drafting board").get_attribute("data-px-per-m")


def is_all_seen(page: Page, garment: dict[str, Any]) -> bool:
    """Return whether a garment lies within the board."""
    board, hand = page.get_by_role("application", name="Drafting board").bounding_box(), Hand(page)
    assert board is not None
    return all(
        board["x"] < x < board["x"] + board["width"] and board["y"] < y < board["y"] + board["height"]
        for x, y in map(hand.px, garment["outline"])
    )


def test_what_was_seen_whole_is_so_on_a_smaller_board_unless_the_view_was_chosen(page: Page, towel: Desk) -> None:
    board = page.get_by_role("application", name="Drafting board")
    garment = towel.garment("t-shirt")
    towel.lay(garment)
    fitted = scale(page)
    try:
        page.set_viewport_size({"width": 900, "height": 560})
        expect(board).not_to_have_attribute("data-px-per-m", str(fitted))
        assert is_all_seen(page, garment)
        small = scale(page)
        page.mouse.move(*Hand(page).px((0.2, 0.2)))
        page.mouse.wheel(0, -300)
        expect(board).not_to_have_attribute("data-px-per-m", str(small))
        chosen = scale(page)
    finally:
        page.set_viewport_size({"width": 1280, "height": 800})
    page.evaluate("new Promise(requestAnimationFrame)")
    assert scale(page) == chosen


def test_a_garment_opened_elsewhere_is_seen_whole_and_what_is_pulled_elsewhere_moves_no_view(
    page: Page, towel: Desk
) -> None:
    before = scale(page)
    shirt = towel.garment("t-shirt")
    REST.put(f"{towel.path}/garment", json={"garment": shirt, "label": "Begin"}).raise_for_status()
    expect(page.locator(".corner")).to_have_count(len(shirt["outline"]))
    expect(page.get_by_role("application", name="Drafting board")).not_to_have_attribute("data-px-per-m", str(before))
    assert is_all_seen(page, shirt)
    fitted, wide = scale(page), {**shirt, "outline": [[2 * x, 2 * y] for x, y in shirt["outline"]], "folds": []}
    REST.put(f"{towel.path}/garment", json={"garment": wide, "label": "Widen"}).raise_for_status()
    expect_step(page, "Widen")
    page.evaluate("new Promise(requestAnimationFrame)")
    assert scale(page) == fitted


@pytest.mark.parametrize("size", [(390, 844), (900, 500), (1024, 768), (1280, 800)])
def test_no_button_over_the_board_covers_another(page: Page, cloth: Desk, size: tuple[int, int]) -> None:
    try:
        page.set_viewport_size({"width": size[0], "height": size[1]})
        if size[0] < size[1]:  # a phone
            expect(page.locator("#swap")).to_be_visible()
            if page.locator("#swap").get_attribute("aria-label") == "Show the board large":
                page.locator("#swap").click()
        expect(page.locator(".strip button").first).to_be_visible()
        boxes = [box for button in page.locator(".strip button").all() if (box := button.bounding_box())]
        assert len(boxes) == 9
        for one, following in pairwise(boxes):
            assert one["x"] + one["width"] <= following["x"] + 0.5
    finally:
        page.set_viewport_size({"width": 1280, "height": 800})
