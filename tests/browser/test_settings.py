"""The settings of a document: changed together, undone together."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import Garment, Sheet


def test_a_documents_settings_are_one_step_and_stations_stay_beside_the_table(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    sheet = new_sheet("t-shirt")
    page.goto(sheet.page_url)
    before = sheet.state["drawing"]
    page.locator("#settings").click()
    settings = page.get_by_role("dialog", name="Settings")
    settings.get_by_label("Reach margin").fill("2")
    settings.get_by_label("Depth").fill("0.1")
    settings.get_by_role("button", name="Apply").click()
    expect(settings.get_by_role("alert")).to_have_text("Depth: \u201c0.1\u201d is too little: at least 20.0 cm.")
    settings.get_by_label("Depth").fill("1.5m")
    settings.get_by_label("Thickness").fill("5")
    settings.get_by_role("button", name="Apply").click()
    expect(settings).to_have_count(0)
    after = sheet.state["drawing"]
    assert (before["thickness_m"], after["thickness_m"]) == (0.0006, pytest.approx(0.005))
    assert after["comfort_radius_m"] == pytest.approx(0.02)
    assert after["scene"]["table"]["depth_m"] == pytest.approx(1.5)
    assert after["scene"]["stations"]["front"]["x_m"] == pytest.approx(
        before["scene"]["stations"]["front"]["x_m"] + 0.05
    )
    assert (
        after["scene"]["base_turn_rad_s"] == before["scene"]["base_turn_rad_s"]
    )  # what is not written stays to the digit
    expect(page.locator("#undo")).to_have_attribute("title", "Undo: Change settings (Ctrl+Z)")
    page.locator("#undo").click()
    expect(page.locator("#undo")).to_be_disabled()
    assert sheet.state["drawing"]["scene"] == before["scene"]
