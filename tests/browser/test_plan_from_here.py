"""`Plan from here` in a step's menu plans what is left after the step."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from tests.browser.channel import Message, listened_to
from tests.browser.conftest import Garment, Sheet, windows
from tests.browser.napkin import napkin
from tests.browser.status_pill import cost_s, expect_planned

LONGER_THAN_A_LONG_PRESS_MS = 700


@pytest.fixture(scope="module")
def opened(chromium: Browser, new_sheet: Callable[[Garment], Sheet]) -> Iterator[tuple[Page, Sheet, float]]:
    """Open a napkin; return the page, its document, and the duration of its whole plan (s)."""
    sheet = new_sheet(napkin())
    with windows(chromium, has_touch=True) as context:
        page = context.new_page()
        page.goto(sheet.page_url)
        expect_planned(page)
        yield page, sheet, cost_s(page)


@pytest.fixture
def page(opened: tuple[Page, Sheet, float]) -> Page:
    """Return the page with the whole plan, and no menu open."""
    page, _, whole_s = opened
    page.keyboard.press("Escape")
    back = page.get_by_role("button", name="Plan from the start")
    if back.is_visible():
        back.click()
    expect(page.locator(".clock")).to_contain_text(f"/ {whole_s:.1f} s")
    expect_planned(page)
    return page


def steps(page: Page) -> Locator:
    return page.get_by_role("list", name="Plan").get_by_role("button")


def menu(page: Page) -> Locator:
    return page.get_by_role("menu")


def first_fold(page: Page) -> int:
    """Return the step that makes the first fold."""
    names = [row.get_attribute("data-colour") for row in steps(page).all()]
    return next(index for index, colour in enumerate(names) if colour)


def texts(page: Page) -> list[str]:
    return steps(page).all_inner_texts()


def seconds(row: str) -> float:
    """Return the duration of a step as its row shows it."""
    return float(row.split()[-2])


def expect_left(page: Page, before: list[str], step: int) -> None:
    """Expect the steps after one to be left, and the timeline to be as long as they are."""
    expect(page.get_by_role("button", name="Plan from the start")).to_be_visible()
    expect_planned(page)
    expect(steps(page)).to_have_count(len(before) - step - 1)
    left_s = sum(seconds(row) for row in before[step + 1 :])
    assert cost_s(page) == pytest.approx(left_s, abs=0.05 * len(before) + 0.05)
    expect(page.locator(".clock")).to_contain_text(f"0.0 / {cost_s(page):.1f} s")
    longest = float(page.get_by_role("slider", name="Time").get_attribute("max") or 0.0)
    assert longest == pytest.approx(cost_s(page), abs=0.051)


def test_a_right_click_on_a_step_plans_what_is_left_after_it(page: Page) -> None:
    before, step = texts(page), first_fold(page)
    steps(page).nth(step).click(button="right")
    entry = menu(page).get_by_role("menuitem", name="Plan from here")
    expect(entry).to_be_focused()
    expect(entry).to_contain_text("what is left after this step")
    entry.click()
    expect_left(page, before, step)
    expect(menu(page)).to_be_hidden()
    expect(page.locator(".start-line")).to_contain_text("Planned from after: folded \u201c")
    done = page.locator(".fold-row[data-state=done] .fold-name")
    expect(done).to_have_count(1)
    name = done.inner_text()
    expect(page.locator(".start-line")).to_contain_text(f"folded \u201c{name}\u201d")
    description = done.get_attribute("aria-description") or ""
    assert "done before the plan starts" in description


def test_a_block_of_the_timeline_has_the_same_menu(page: Page) -> None:
    before, step = texts(page), first_fold(page)
    page.locator(f".block[data-index='{step}']").first.click(button="right")
    menu(page).get_by_role("menuitem", name="Plan from here").click()
    expect_left(page, before, step)


def test_the_button_plans_from_the_start_again(page: Page, opened: tuple[Page, Sheet, float]) -> None:
    before = texts(page)
    steps(page).nth(first_fold(page)).click(button="right")
    menu(page).get_by_role("menuitem", name="Plan from here").click()
    back = page.get_by_role("button", name="Plan from the start")
    back.click()
    expect(back).to_be_hidden()
    expect(steps(page)).to_have_count(len(before))
    expect_planned(page)
    assert cost_s(page) == pytest.approx(opened[2], abs=0.051)
    expect(page.locator(".start-line p")).to_have_text("")
    expect(page.locator(".fold-row[data-state=done]")).to_have_count(0)


def test_an_edit_of_the_drawing_takes_the_start_back(page: Page, opened: tuple[Page, Sheet, float]) -> None:
    before = texts(page)
    steps(page).nth(first_fold(page)).click(button="right")
    menu(page).get_by_role("menuitem", name="Plan from here").click()
    back = page.get_by_role("button", name="Plan from the start")
    expect(back).to_be_visible()
    expect_planned(page)

    def retitle(drawing: dict[str, Any]) -> None:
        drawing["title"] = "Another napkin"

    opened[1].edit(retitle)
    expect(back).to_be_hidden()
    expect(steps(page)).to_have_count(len(before))
    expect_planned(page)


@pytest.mark.parametrize("key", ["Shift+F10", "ContextMenu"])
def test_the_menu_is_asked_for_chosen_from_and_left_by_keys(page: Page, key: str) -> None:
    before, step = texts(page), first_fold(page)
    row = steps(page).nth(step)
    expect(row).to_have_attribute("aria-haspopup", "menu")
    row.focus()
    page.keyboard.press(key)
    entry = menu(page).get_by_role("menuitem", name="Plan from here")
    expect(entry).to_be_focused()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("v")  # elsewhere it means the tool Select
    expect(menu(page).get_by_role("menuitem", name="Run from here")).to_be_focused()
    page.keyboard.press("Escape")
    expect(menu(page)).to_be_hidden()
    expect(row).to_be_focused()
    page.keyboard.press(key)
    page.keyboard.press("Enter")
    expect_left(page, before, step)
    expect(page.get_by_role("button", name="Plan from the start")).to_be_focused()


def test_a_long_press_asks_for_it_and_is_no_tap(page: Page) -> None:
    before, step = texts(page), first_fold(page)
    box = steps(page).nth(step).bounding_box()
    assert box is not None
    session = page.context.new_cdp_session(page)
    place = {"x": box["x"] + 60, "y": box["y"] + box["height"] / 2}
    session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [place]})
    page.wait_for_timeout(LONGER_THAN_A_LONG_PRESS_MS)
    expect(menu(page)).to_be_visible()
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    page.wait_for_timeout(100)
    expect(menu(page)).to_be_visible()
    expect(page.locator(".clock")).to_contain_text("0.0 / ")
    menu(page).get_by_role("menuitem", name="Plan from here").tap()
    expect_left(page, before, step)


def test_a_short_tap_goes_to_the_step_and_a_pull_asks_for_nothing(page: Page) -> None:
    steps(page).nth(1).tap()
    expect(page.get_by_role("slider", name="Time")).not_to_have_attribute("aria-valuetext", "0.0 s")
    box = steps(page).nth(1).bounding_box()
    assert box is not None
    session = page.context.new_cdp_session(page)
    touch = {"x": box["x"] + 60, "y": box["y"] + box["height"] / 2}
    session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [touch]})
    pulled = {**touch, "x": touch["x"] + 40}
    session.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": [pulled]})
    page.wait_for_timeout(LONGER_THAN_A_LONG_PRESS_MS)
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    expect(menu(page)).to_be_hidden()


def test_a_click_elsewhere_closes_the_menu(page: Page) -> None:
    steps(page).nth(0).click(button="right")
    expect(menu(page)).to_be_visible()
    page.locator(".dock-folds h2").click()
    expect(menu(page)).to_be_hidden()
    expect(page.get_by_role("button", name="Plan from the start")).to_be_hidden()


def test_after_the_last_step_there_is_nothing_to_plan(page: Page) -> None:
    steps(page).last.click(button="right")
    entry = menu(page).get_by_role("menuitem", name="Plan from here")
    expect(entry).to_have_attribute("aria-disabled", "true")
    expect(entry).to_contain_text("nothing is left after this step")
    entry.click(force=True)
    expect(menu(page)).to_be_visible()


def test_a_menu_goes_away_with_the_plan_that_it_was_opened_on(page: Page, opened: tuple[Page, Sheet, float]) -> None:
    steps(page).nth(0).click(button="right")
    expect(menu(page)).to_be_visible()

    def move(drawing: dict[str, Any]) -> None:
        drawing["placement"]["y_m"] += 0.01

    opened[1].edit(move)
    expect(menu(page)).to_be_hidden()
    opened[1].edit(lambda drawing: drawing["placement"].update(y_m=-0.3))
    expect_planned(page)


START: dict[str, Any] = {
    "folds_done": [],
    "placement": {"x_m": -0.9, "y_m": -0.3, "yaw_rad": 0.0},
    "base": {"station": "front", "back_off_m": 0.0, "x_m": -0.95, "y_m": 0.0, "yaw_rad": 0.0},
    "held": [],
    "dragged_m": 0.0,
}
HELD = [{"arm": "left", "point": [0.0, 0.0]}, {"arm": "right", "point": [0.4, 0.0]}]
LEFT = {**START["base"], "station": "front_left", "back_off_m": 0.2}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"folds_done": [1, 0]}, "Planned from after: folded \u201cright\u201d, fold 1"),
        (
            {"folds_done": [1], "base": LEFT, "held": HELD},
            "Planned from after: folded \u201cright\u201d; robot at front left, 20 cm back; "
            "the left and right hands hold the cloth",
        ),
        (
            {"held": HELD[:1]},
            "Planned from the middle: nothing folded yet; the cloth dragged 20 cm towards the robot; "
            "the left hand holds the cloth",
        ),
        (
            {"placement": napkin()["placement"], "base": {**LEFT, "station": "front"}},
            "Planned from the middle: nothing folded yet; robot at front, 20 cm back",
        ),
    ],
)
def test_the_line_says_from_what_is_planned(page: Page, changes: dict[str, Any], words: str) -> None:
    drawing = {
        "folds": [{"name": ""}, {"name": "right"}],
        "placement": napkin()["placement"],
        "start_station": "front",
    }
    told = page.evaluate(
        "async ([start, drawing]) => (await import('page/messages/starts.js')).startInWords(start, drawing)",
        [{**START, **changes}, drawing],
    )
    assert told == words


def test_the_cost_map_is_asked_for_anew_where_another_start_is_chosen(page: Page) -> None:
    told = {"version": 1, "step_m": 0.1, "cells": [], "best": None, "complete": True}
    with listened_to(page, page.url) as (window, channel):

        def tell(sent: Message, answer: Callable[[Message], None]) -> bool:
            is_map: bool = sent["do"] == "places"
            if is_map:
                answer({"kind": "answer", "version": 1, "result": told})
            return not is_map

        channel.take = tell
        expect_planned(window)
        window.get_by_role("button", name="Cost map").click()
        steps(window).nth(first_fold(window)).click(button="right")
        menu(window).get_by_role("menuitem", name="Plan from here").click()
        expect(window.get_by_role("button", name="Plan from the start")).to_be_visible()
        expect_planned(window)
        assert len(channel.asked("places")) == 2
