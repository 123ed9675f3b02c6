"""The list `Folds`: order, names, colours, dependencies."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Locator, Page, expect

from tests.browser.conftest import REST, Garment, Sheet, windows
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned

NAPKIN = ["left", "right", "half"]
OPENED = "Open afresh"


@pytest.fixture(scope="module")
def opened(chromium: Browser, new_sheet: Callable[[Garment], Sheet]) -> Iterator[tuple[Page, Sheet]]:
    """Open one page for all tests, since loading takes long."""
    sheet = new_sheet(napkin())
    with windows(chromium) as context:
        page = context.new_page()
        page.goto(sheet.page_url)
        expect(rows(page)).to_have_count(3)
        yield page, sheet


@pytest.fixture
def page(opened: tuple[Page, Sheet]) -> Page:
    return opened[0]


@pytest.fixture
def sheet(opened: tuple[Page, Sheet]) -> Sheet:
    """Reset the napkin, with nothing selected."""
    page, sheet = opened
    title = f"Napkin {sheet.state['version']}"  # another one, or it would be no step
    REST.put(f"{sheet.path}/garment", json={"garment": napkin(title=title), "label": OPENED}).raise_for_status()
    expect_order(page, NAPKIN)
    for selected in page.locator(".fold-row.is-selected .fold-name").all():
        selected.click()
    return sheet


def rows(page: Page) -> Locator:
    return page.get_by_role("list", name="Folds").get_by_role("listitem")


def name_of(row: Locator) -> Locator:
    return row.locator(".fold-name")


def expect_order(page: Page, names: list[str]) -> None:
    expect(rows(page).locator(".fold-name")).to_have_text(names)


def pull(page: Page, row: Locator, onto: Locator, share: float) -> None:
    """Pull a row to a fraction of the height of another."""
    page.mouse.move(*middle(row, 0.5))
    page.mouse.down()
    page.mouse.move(*middle(onto, 0.5), steps=3)
    page.mouse.move(*middle(onto, share), steps=2)


def middle(row: Locator, share: float) -> tuple[float, float]:
    box = row.bounding_box()
    assert box is not None
    return box["x"] + 100.0, box["y"] + share * box["height"]


def test_a_fold_pulled_down_comes_later(page: Page, sheet: Sheet) -> None:
    pull(page, rows(page).nth(0), rows(page).nth(1), 0.9)
    page.mouse.up()
    expect_order(page, ["right", "left", "half"])
    expect(page.get_by_role("button", name="Undo")).to_be_enabled()
    assert sheet.fold_names[:2] == ["right", "left"]
    assert sheet.can_undo == "Reorder folds"
    expect(page.locator(".fold-row.is-selected")).to_have_count(0)


def test_escape_puts_a_pulled_fold_back(page: Page, sheet: Sheet) -> None:
    pull(page, rows(page).nth(0), rows(page).nth(2), 0.9)
    page.keyboard.press("Escape")
    page.mouse.up()
    expect_order(page, NAPKIN)
    expect(page.locator(".is-pulled, .is-drop-before, .is-drop-after")).to_have_count(0)
    assert sheet.can_undo == OPENED


def test_alt_and_an_arrow_move_the_fold_that_has_the_focus(page: Page, sheet: Sheet) -> None:
    name_of(rows(page).nth(0)).focus()
    page.keyboard.press("Alt+ArrowDown")
    expect_order(page, ["right", "left", "half"])
    expect(name_of(rows(page).nth(1))).to_be_focused()
    page.keyboard.press("Alt+ArrowUp")
    expect_order(page, NAPKIN)
    expect(name_of(rows(page).nth(0))).to_be_focused()


def test_arrows_go_from_fold_to_fold_and_tab_stops_in_one(page: Page, sheet: Sheet) -> None:
    name_of(rows(page).nth(0)).focus()
    page.keyboard.press("ArrowDown")
    expect(name_of(rows(page).nth(1))).to_be_focused()
    expect(rows(page).locator(".fold-name[tabindex='0']")).to_have_text(["right"])


def test_a_fold_is_renamed_in_place(page: Page, sheet: Sheet) -> None:
    name_of(rows(page).nth(1)).dblclick()
    page.keyboard.type("the other side")
    page.keyboard.press("Enter")
    expect(name_of(rows(page).nth(1))).to_have_text("the other side")
    expect(page.get_by_role("list", name="Plan")).to_contain_text("the other side")
    assert sheet.fold_names[1] == "the other side"


def test_escape_leaves_a_name_as_it_was(page: Page, sheet: Sheet) -> None:
    name_of(rows(page).nth(1)).focus()
    page.keyboard.press("F2")
    page.keyboard.type("nonsense")
    page.keyboard.press("Escape")
    expect(name_of(rows(page).nth(1))).to_have_text("right")
    expect(name_of(rows(page).nth(1))).to_be_focused()
    assert sheet.can_undo == OPENED


def test_a_fold_is_deleted_and_comes_back(page: Page, sheet: Sheet) -> None:
    name_of(rows(page).nth(2)).focus()
    page.keyboard.press("Delete")
    expect_order(page, ["left", "right"])
    expect(name_of(rows(page).nth(1))).to_be_focused()
    page.get_by_role("button", name="Undo").click()
    expect_order(page, NAPKIN)
    name_of(rows(page).nth(0)).click()
    page.get_by_role("button", name="Delete left").click()
    expect_order(page, ["right", "half"])


def test_colour_and_grip_radius_are_set_at_the_selected_fold(page: Page, sheet: Sheet) -> None:
    name_of(rows(page).nth(2)).click()
    page.get_by_role("radio", name="Red").click()
    expect(page.get_by_role("radio", name="Red")).to_be_checked()
    assert sheet.drawing["folds"][2]["kind"] == "red"
    field = page.get_by_role("textbox", name="Grip radius of half")
    field.fill("4in")
    field.press("Enter")
    expect(field).to_have_value("10.2 cm")
    assert sheet.drawing["folds"][2]["grip_radius_m"] == pytest.approx(4 * 0.0254)
    field.fill("wide")
    field.press("Enter")
    expect(field).to_have_value("10.2 cm")
    field.fill("")
    field.press("Enter")
    page.get_by_role("radio", name="Blue").click()
    expect(page.get_by_role("radio", name="Blue")).to_be_checked()
    expect(field).to_have_attribute("placeholder", "12.7 cm")
    assert sheet.drawing["folds"][2]["grip_radius_m"] is None


def test_a_fold_names_those_that_it_waits_for(page: Page, sheet: Sheet) -> None:
    expect(rows(page).nth(0).locator(".badge")).to_have_count(0)
    expect(rows(page).nth(2).locator(".badge")).to_have_text(["1", "2"])
    told = "3, Blue: all layers, waits, after left and right"
    expect(name_of(rows(page).nth(2))).to_have_attribute("aria-description", told)


def test_folds_are_done_available_or_waiting_as_the_time_goes(page: Page, sheet: Sheet) -> None:
    expect(page.locator(".fold-row[data-state=available]")).to_have_count(2)
    expect(page.locator(".fold-row[data-state=waiting]")).to_have_count(1)
    expect_planned(page, sheet.state["version"])  # before, time has no end
    page.get_by_role("slider", name="Time").press("End")
    expect(page.locator(".fold-row[data-state=done]")).to_have_count(3)


def test_the_eye_shows_the_cloth_before_a_fold(page: Page, sheet: Sheet) -> None:
    first = page.get_by_role("button", name="Show the cloth before left")
    last = page.get_by_role("button", name="Show the cloth before half")
    expect(first).to_have_attribute("aria-pressed", "true")
    last.click()
    expect(last).to_have_attribute("aria-pressed", "true")
    expect(first).to_have_attribute("aria-pressed", "false")
    last.click()
    expect(first).to_have_attribute("aria-pressed", "true")


def test_what_is_wrong_with_a_fold_stands_at_it(page: Page, sheet: Sheet) -> None:
    def off(drawing: dict[str, Any]) -> None:
        drawing["folds"][2]["start"] = {"point": [3.0, 0.0]}
        drawing["folds"][2]["end"] = {"point": [3.0, 1.0]}

    sheet.edit(off)
    expect(page.get_by_role("status")).to_contain_text("No plan: Half: ")
    expect(page.locator(".fold-row.is-illegal .fold-name")).to_have_text(["half"])
    expect(page.locator(".reason")).to_contain_text("Half: ")


def test_a_blank_board_says_what_to_do(context: BrowserContext, new_sheet: Callable[[Garment], Sheet]) -> None:
    page = context.new_page()
    page.goto(new_sheet(None).page_url)
    expect(page.get_by_role("status")).to_contain_text("No plan: Nothing is drawn yet")
    expect(page.get_by_text("No folds yet")).to_be_visible()
    expect(page.locator(".suggestion-strip")).to_be_hidden()
