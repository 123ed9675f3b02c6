"""The legend explains every shade and line of the overlays that are drawn, and no other."""

import itertools
import re
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.browser.board_desk import Desk
from tests.browser.board_hand import Hand
from tests.browser.board_window import DRAWN
from tests.browser.channel import Message, listened_to
from tests.browser.status_pill import expect_planned
from tests.required import required

SWITCHES = ["Reach", "Grips", "Hand paths", "Base path", "Overhang", "Cost map"]


@pytest.fixture
def legend(page: Page, towel: Desk) -> Iterator[Locator]:
    """Return the legend of a planned towel; overlays switched on are switched off afterwards."""
    expect_planned(page)
    yield page.get_by_role("list", name="Legend")
    for name in SWITCHES:
        switch = chip(page, name)
        if switch.get_attribute("aria-pressed") == "true":
            switch.click()


def chip(page: Page, name: str) -> Locator:
    return page.get_by_role("button", name=name, exact=True)


def test_there_is_no_legend_before_anything_is_switched_on_and_drawn(page: Page, towel: Desk) -> None:
    with listened_to(page, towel.page_url) as (window, channel):
        expect_planned(window)
        legend = window.get_by_role("list", name="Legend")
        expect(legend).to_have_count(0)
        channel.take = lambda sent, _answer: sent["do"] != "overlays" or len(channel.asked("overlays")) > 1
        chip(window, "Overhang").click()
        expect(chip(window, "Overhang")).to_have_attribute("aria-busy", "true")
        expect(legend).to_have_count(0)
        channel.pass_on(channel.first_asked("overlays"))
        expect(legend.get_by_role("listitem")).to_have_text(["Slip limit: maximum overhang over that edge"])
        chip(window, "Overhang").click()
        expect(legend).to_have_count(0)


def test_what_is_switched_off_and_on_again_is_drawn_again(page: Page, legend: Locator) -> None:
    slip = chip(page, "Overhang")
    for _ in range(2):
        slip.click()
        expect(legend.get_by_role("listitem")).to_have_count(1)
        expect(slip).to_have_attribute("aria-busy", "false")
        slip.click()
        expect(legend).to_have_count(0)


def test_the_shades_of_reach_are_named_with_their_comfort_and_hands(page: Page, legend: Locator) -> None:
    chip(page, "Reach").click()
    # The default reach margin is 3 cm.
    rows = ["L, R: can grip with a margin of 3.0 cm; stronger: both", "Limit of reach, without margin"]
    expect(legend.get_by_role("listitem")).to_have_text(rows)
    for drawn in ("fill", "stroke-dasharray", "stroke-opacity"):
        row, board = legend.locator(".is-bare"), page.locator(".layer-over .is-bare").first
        assert style(row, drawn) == style(board, drawn)


def style(drawn: Locator, name: str) -> str:
    return str(drawn.evaluate("(node, name) => getComputedStyle(node).getPropertyValue(name)", name))


def test_the_ways_of_base_and_hands_are_named_when_there_are_any(page: Page, legend: Locator) -> None:
    for name in ("Hand paths", "Base path"):
        chip(page, name).click()
    expect(page.locator(".layer-over .hand-path.is-now").first).to_be_attached()
    for words in ("The base at this moment", "Base pose", "Current path of gripper L or R"):
        expect(legend.get_by_text(words)).to_be_visible()
    chip(page, "Hand paths").click()
    expect(legend.get_by_text("Way of the hand")).to_have_count(0)
    expect(legend.get_by_text("The base at this moment")).to_be_visible()


def test_the_cost_map_is_explained_with_what_the_server_told(page: Page, towel: Desk) -> None:
    cells = [
        {"move": [0.1 * n, 0.0], "placement": {"x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0}, "cost_s": cost_s}
        for n, cost_s in enumerate((41.26, None, 57.8))
    ]
    told = {"version": 1, "step_m": 0.1, "cells": cells, "best": cells[0], "complete": False}
    rows = [
        "Plan time 41.3\N{NO-BREAK SPACE}s (strongest) to 57.8\N{NO-BREAK SPACE}s with the cloth centred here",
        "Empty: no plan from there",
        "No square: not tried yet",
    ]
    with listened_to(page, towel.page_url) as (window, channel):

        def tell(sent: Message, answer: Callable[[Message], None]) -> bool:
            is_map: bool = sent["do"] == "places"
            if is_map:
                answer({"kind": "answer", "version": 1, "result": told})
            return not is_map

        channel.take = tell
        expect_planned(window)
        chip(window, "Cost map").click()
        expect(window.get_by_role("list", name="Legend").get_by_role("listitem")).to_have_text(rows)


def test_the_legend_is_clear_of_the_cloth_and_the_pointer_goes_through(page: Page, legend: Locator) -> None:
    chip(page, "Overhang").click()
    expect(legend).to_be_visible()
    box, cloth = legend.bounding_box(), page.locator(".layer-cloth").bounding_box()
    assert box is not None and cloth is not None
    beside = box["x"] + box["width"] <= cloth["x"] or cloth["x"] + cloth["width"] <= box["x"]
    assert beside or box["y"] + box["height"] <= cloth["y"] or cloth["y"] + cloth["height"] <= box["y"]
    middle = [box["x"] + box["width"] / 2, box["y"] + box["height"] / 2]
    below = page.evaluate("([x, y]) => Boolean(document.elementFromPoint(x, y).closest('#drafting-board'))", middle)
    assert below


def test_all_of_the_legend_is_on_the_board_also_in_large_letters(page: Page, legend: Locator) -> None:
    for name in ("Reach", "Overhang"):
        chip(page, name).click()
    try:
        for (width, height), text in itertools.product([(390, 844), (1280, 800)], ["100%", "200%"]):
            page.set_viewport_size({"width": width, "height": height})
            page.evaluate("(size) => document.documentElement.style.setProperty('font-size', size)", text)
            expect(legend.get_by_role("listitem")).to_have_count(3)
            page.evaluate(f"{DRAWN}.then(() => {DRAWN})")  # the board is measured anew a frame later
            box, board = required(legend.bounding_box()), required(Hand(page).board.bounding_box())
            assert board["x"] <= box["x"] and box["x"] + box["width"] <= board["x"] + board["width"]
            assert board["y"] <= box["y"] and box["y"] + box["height"] <= board["y"] + board["height"]
            assert 0.0 < box["height"] < 0.63 * board["height"]
    finally:
        page.evaluate("document.documentElement.style.removeProperty('font-size')")
        page.set_viewport_size({"width": 1280, "height": 800})


def test_the_legend_keeps_clear_of_the_placements_numbers(page: Page, legend: Locator) -> None:
    chip(page, "Reach").click()
    expect(legend).to_be_visible()
    Hand(page).tool("Place")
    fields = page.get_by_role("group", name="Numbers")
    expect(fields).to_be_visible()
    page.evaluate("new Promise(requestAnimationFrame)")
    a, b = legend.bounding_box(), fields.bounding_box()
    assert a is not None and b is not None
    is_beside = a["x"] >= b["x"] + b["width"] or b["x"] >= a["x"] + a["width"]
    assert is_beside or a["y"] >= b["y"] + b["height"] or b["y"] >= a["y"] + a["height"]
    Hand(page).tool("Select")


def test_the_legend_keeps_clear_of_why_there_is_no_plan(page: Page, legend: Locator) -> None:
    page.evaluate(
        "Object.assign(document.querySelector('.suggestion-strip'), { hidden: false }).style.minHeight = '60px'"
    )
    chip(page, "Reach").click()
    expect(legend).to_have_class(re.compile("is-bottom|unseen"))
    page.evaluate("document.querySelector('.suggestion-strip').hidden = true")


def test_the_bases_way_comes_into_view_and_the_view_goes_back_with_it(page: Page, legend: Locator) -> None:
    board = page.get_by_role("application", name="Drafting board")
    before = board.get_attribute("data-px-per-m")
    chip(page, "Base path").click()
    base = page.locator("path.robot-base")
    expect(base).to_be_in_viewport(ratio=0.99)
    whole, robot = board.bounding_box(), base.bounding_box()
    assert whole is not None and robot is not None
    assert whole["x"] <= robot["x"] and robot["x"] + robot["width"] <= whole["x"] + whole["width"]
    chip(page, "Base path").click()
    expect(board).to_have_attribute("data-px-per-m", str(before))
