"""A link to look at a document: made and copied in the page, and what the page has by it."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.app.conftest import REST
from tests.browser.conftest import Garment, Sheet, new_view_page, windows
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned

NewSheet = Callable[[Garment], Sheet]

PICTURE = Path(__file__).resolve().parents[2] / "static" / "icon.svg"
"""A picture that is there at once."""


def test_the_page_of_a_link_plays_and_has_nothing_that_changes_the_document(page: Page, new_sheet: NewSheet) -> None:
    sheet = new_sheet("scarf")
    page.goto(sheet.page_url)
    expect(page.locator(".hint-line")).to_contain_text("Drag corners")
    page.get_by_role("button", name="Share").click()
    link = page.get_by_role("textbox", name="Link")
    expect(link).to_have_value(re.compile(r"^http://.*/s/[\w-]+/d/\w+$"))
    address = link.input_value()
    page.goto(address)
    expect(page.locator(".fold-row")).to_have_count(2)
    expect(page.get_by_text("View only")).to_be_visible()
    for name in ("Undo", "Redo", "Rename", "Share", "New", "Import"):
        expect(page.get_by_role("button", name=name, exact=True)).to_have_count(0)
    expect(page.get_by_role("button", name="Fold it for me")).to_have_count(0)
    for name in ("Blue", "Red", "Turn", "Flip", "Grab", "Rehearse", "Run", "Best place", "Compare", "Cost map"):
        expect(page.get_by_role("button", name=re.compile(f"^{name}"))).to_have_count(0)
    expect(page.locator("#rail")).to_be_hidden()
    expect(page.locator(".handle").filter(visible=True)).to_have_count(0)
    expect(page.locator(".hint-line")).to_be_empty()
    expect(page.get_by_role("button", name="Export", exact=True)).to_be_visible()
    page.keyboard.press("?")
    keys = page.get_by_role("dialog").locator("dt")
    expect(keys).not_to_have_count(0)
    for key in ("P", "F", "X", "Ctrl + Z", "Delete"):
        expect(keys.filter(has_text=re.compile(f"^{re.escape(key)}$"))).to_have_count(0)
    page.keyboard.press("Escape")
    before = sheet.state
    page.mouse.click(300, 300)
    page.keyboard.press("Delete")
    page.locator(".fold-name").first.click()
    page.keyboard.press("Delete")
    expect(page.locator(".fold-fields").filter(visible=True)).to_have_count(0)
    page.keyboard.press("Control+z")
    assert sheet.state == before


def test_the_dialog_shows_the_whole_link_and_the_picture_of_its_preview(page: Page, new_sheet: NewSheet) -> None:
    page.route("**/files/picture.png", lambda route: route.fulfill(path=PICTURE, content_type="image/svg+xml"))
    page.set_viewport_size({"width": 900, "height": 500})
    page.goto(new_sheet(napkin()).page_url)
    expect_planned(page)
    page.get_by_role("button", name="Share").click()
    dialog = page.get_by_role("dialog", name="Share")
    picture = dialog.get_by_role("img", name="What a preview of the link shows")
    expect(picture).to_have_js_property("complete", True)
    link, about = (part.bounding_box() for part in (dialog.get_by_label("Link"), dialog.locator("p").first))
    assert link is not None and about is not None
    assert link["width"] == about["width"]
    expect(picture).to_be_in_viewport(ratio=1)
    expect(dialog.get_by_role("button", name="Copy")).to_be_in_viewport(ratio=1)
    page.unroute_all()


def test_by_a_link_the_board_is_moved_and_measured_and_steps_are_played(page: Page, new_sheet: NewSheet) -> None:
    sheet = new_sheet("scarf")
    link = REST.post(f"{sheet.path}/share").raise_for_status().json()["path"]
    page.goto(f"{sheet.page_url.partition('/d/')[0]}{link}")
    board, steps = page.locator("#drafting-board"), page.locator(".plan-row")
    expect(steps).not_to_have_count(0)
    page.get_by_role("button", name="Unit").click()
    expect(page.get_by_role("button", name="Unit")).not_to_have_text("cm")
    page.get_by_role("button", name="Unit").click()
    before = str(board.get_attribute("data-origin-px"))
    box = board.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 200, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] + 240, box["y"] + 230, steps=3)
    page.mouse.up()
    expect(board).not_to_have_attribute("data-origin-px", before)
    page.get_by_role("button", name="Fit").click()
    expect(board).to_have_attribute("data-origin-px", before)
    steps.last.click()
    expect(page.locator(".clock")).not_to_have_text(re.compile(r"^0\.0 "))
    steps.last.click(button="right")
    expect(page.get_by_role("menu")).to_have_count(0)


@pytest.mark.long
def test_the_3d_view_of_a_link_shows_the_robot_without_the_viewers_own_panel(
    browser: Browser, new_sheet: NewSheet
) -> None:
    """Nothing that the page asks for is refused, and it can be played."""
    sheet = new_sheet("scarf")
    link = REST.post(f"{sheet.path}/share").raise_for_status().json()["path"]
    page = new_view_page(browser)
    refused: list[str] = []
    page.on("response", lambda answer: refused.append(answer.url) if answer.status >= 400 else None)
    page.goto(f"{sheet.page_url.partition('/d/')[0]}{link}")
    view = page.frame_locator("#view3d")
    expect(view.locator("#root canvas").first).to_be_visible()
    expect(page.locator(".view3d-cover")).to_be_hidden()
    expect(view.locator("[data-dock-root]").first).to_be_hidden()
    page.get_by_role("button", name="Play", exact=True).click()
    expect(page.get_by_role("button", name="Pause", exact=True)).to_be_visible()

    page.close()
    assert refused == []


def test_on_a_phone_a_link_shows_the_3d_view_first_with_play(chromium: Browser, new_sheet: NewSheet) -> None:
    sheet = new_sheet("scarf")
    link = REST.post(f"{sheet.path}/share").raise_for_status().json()["path"]
    with windows(chromium, viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True) as context:
        page = context.new_page()
        page.goto(f"{sheet.page_url.partition('/d/')[0]}{link}")
        expect(page.get_by_role("button", name="Play in the 3D view")).to_be_visible()
        expect(page.get_by_role("button", name="Show the board large")).to_be_visible()
        assert page.evaluate("document.getElementById('sheet').getBoundingClientRect().bottom") == 844
