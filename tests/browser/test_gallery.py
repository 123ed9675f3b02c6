"""The gallery: all garments as pictures, found by name; documents copied, renamed, deleted and had back."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.app.samples import towel
from tests.browser.board.conftest import page as page
from tests.browser.conftest import REST, Garment, Sheet
from tests.browser.status_pill import expect_planned


@pytest.fixture
def gallery(page: Page, new_sheet: Callable[[Garment], Sheet]) -> Locator:
    other = new_sheet(towel(title="Tea towel for the gallery"))
    other.edit(lambda drawing: drawing["folds"].clear())
    page.goto(new_sheet(towel(title="My open towel")).page_url)
    expect_planned(page)
    page.keyboard.press("/")
    found = page.get_by_role("dialog", name="Garments")
    expect(found.get_by_role("searchbox")).to_be_focused()
    return found


def menu(page: Page, title: str, verb: str) -> None:
    page.get_by_role("button", name=f"More for {title}").first.click()
    page.get_by_role("menuitem", name=verb).click()


def test_documents_templates_and_examples_are_found_by_name(page: Page, gallery: Locator) -> None:
    rows = {name: gallery.get_by_role("group", name=name) for name in ("Yours", "Templates, by measures", "Examples")}
    for row in rows.values():
        expect(row.locator(".tile .picture-cloth").first).to_be_visible()
    gallery.get_by_role("searchbox").fill("tea GALL")
    expect(gallery.locator(".tile:visible")).to_have_count(1)
    expect(rows["Examples"]).to_be_hidden()
    gallery.get_by_role("searchbox").fill("no such garment")
    expect(gallery.get_by_text("Nothing has that name.")).to_be_visible()
    gallery.get_by_role("searchbox").fill("gallery")
    page.keyboard.press("Enter")
    expect(page).to_have_title("Tea towel for the gallery - Pleat")


def test_a_document_is_copied_renamed_deleted_had_back_and_put_back_to_a_version(page: Page, gallery: Locator) -> None:
    gallery.get_by_role("searchbox").fill("tea towel for the gallery")
    tiles = gallery.locator(".tile-own:visible")
    expect(tiles.first).to_be_visible()
    count = tiles.count()
    menu(page, "Tea towel for the gallery", "Duplicate")
    expect(tiles).to_have_count(count + 1)
    menu(page, "Tea towel for the gallery", "Rename")
    page.get_by_label("Name", exact=True).fill("Tea towel for the gallery, mine")
    page.keyboard.press("Enter")
    expect(tiles.filter(has_text="mine")).to_have_count(1)
    menu(page, "Tea towel for the gallery, mine", "Delete")
    expect(tiles).to_have_count(count)
    gallery.get_by_role("button", name="Undo").click()
    expect(tiles).to_have_count(count + 1)
    menu(page, "Tea towel for the gallery, mine", "Delete")
    with page.expect_response(lambda answer: answer.request.method == "DELETE" and answer.ok):
        page.keyboard.press("Escape")
    page.keyboard.press("/")
    menu(page, "Tea towel for the gallery", "Versions")
    first = page.get_by_role("dialog", name="Versions of").locator(".tile")
    expect(first).to_contain_text("First drawing")
    first.click()
    expect(page).to_have_title("Tea towel for the gallery - Pleat")
    state = REST.get(f"{page.url.split('/d/')[0]}/api/documents/{page.url.rpartition('/')[2]}").json()
    assert len(state["drawing"]["folds"]) == 1
    assert (
        state["history"]["can_undo"]
        == "Back to \N{LEFT DOUBLE QUOTATION MARK}the first drawing\N{RIGHT DOUBLE QUOTATION MARK}"
    )


def test_the_document_that_is_open_is_not_deleted(page: Page, gallery: Locator) -> None:
    page.get_by_role("button", name="More for My open towel").first.click()
    expect(page.get_by_role("menuitem", name="Delete")).to_have_attribute("aria-disabled", "true")
