"""What the board shows while the plan is stopped, within a step or at its end."""

from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.browser.conftest import Garment, Sheet
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned


def test_a_stopped_plan_has_the_board_show_the_cloth_of_then_and_say_which_step(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    sheet = new_sheet(napkin())
    page.goto(sheet.page_url)
    expect_planned(page)
    moment = page.locator(".strip-moment")
    expect(moment).to_have_text("Spread out")
    slider = page.get_by_role("slider", name="Time")
    slider.focus()
    slider.press("End")
    expect(moment).to_have_text("After 3: half")
    expect(page.locator(".cloth-before")).to_have_count(1)
    for _ in range(6):
        slider.press("ArrowLeft")
    expect(moment).to_contain_text("In step ")
    expect(page.locator(".cloth-before")).to_have_count(1)
    slider.press("Home")
    expect(moment).to_have_text("Spread out")
    expect(page.locator(".cloth-before")).to_have_count(0)
