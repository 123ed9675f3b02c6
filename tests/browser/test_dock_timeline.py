"""The timeline: lanes, slider and transport show and set one time."""

import re
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Locator, Page, expect

from tests.app.conftest import Served
from tests.browser.conftest import REST, Garment, Sheet, windows
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned


@pytest.fixture(scope="module")
def planned(
    chromium: Browser, designer: Served, new_sheet: Callable[[Garment], Sheet]
) -> Iterator[tuple[Page, list[float]]]:
    """Open the page with a plan; return the starts of its primitives and its end (s)."""
    sheet = new_sheet(napkin())
    with windows(chromium) as context:
        page = context.new_page()
        page.goto(sheet.page_url)
        expect_planned(page)
        answer = REST.post(f"{designer.url}/api/plans", json={"garment": napkin(), "time_limit_s": 60}, timeout=90.0)
        primitives = answer.json()["primitives"]
        last = primitives[-1]
        yield page, [one["start_s"] for one in primitives] + [last["start_s"] + last["duration_s"]]


@pytest.fixture
def page(planned: tuple[Page, list[float]]) -> Page:
    """Return the page at the beginning of the plan, paused."""
    page, _ = planned
    page.mouse.move(5, 5)
    page.keyboard.press("Escape")
    slider(page).press("Home")
    expect_time(page, 0.0)
    return page


@pytest.fixture
def starts_s(planned: tuple[Page, list[float]]) -> list[float]:
    return planned[1]


def slider(page: Page) -> Locator:
    return page.get_by_role("slider", name="Time")


def expect_time(page: Page, t_s: float) -> None:
    """Expect the slider and the clock to show a time."""
    expect(slider(page)).to_have_attribute("aria-valuetext", f"{t_s:.1f} s")
    expect(page.locator(".clock")).to_contain_text(f"{t_s:.1f} / ")


def expect_current(page: Page, index: int) -> None:
    current = page.get_by_role("list", name="Plan").locator("[aria-current=step]")
    expect(current).to_have_count(1)
    rows = page.get_by_role("list", name="Plan").get_by_role("listitem")
    expect(rows.nth(index).locator("[aria-current=step]")).to_have_count(1)


def at_share(lane: Locator, share: float) -> tuple[float, float]:
    box = lane.bounding_box()
    assert box is not None
    return box["x"] + share * box["width"], box["y"] + box["height"] / 2


def test_a_click_on_a_lane_goes_to_that_time(page: Page, starts_s: list[float]) -> None:
    lane = page.locator(".lane[data-lane=left]")
    page.mouse.click(*at_share(lane, 0.5))
    seen = float(slider(page).input_value())
    assert seen == pytest.approx(starts_s[-1] / 2, abs=0.1)  # a pixel is a twentieth of a second or so
    expect_time(page, seen)
    expect(page.locator(".fold-row[data-state=done] .fold-name")).to_have_text(["left"])


def test_a_pull_along_a_lane_takes_the_time_along(page: Page, starts_s: list[float]) -> None:
    lane = page.locator(".lane[data-lane=base]")
    page.mouse.move(*at_share(lane, 0.2))
    page.mouse.down()
    page.mouse.move(*at_share(lane, 1.0), steps=4)
    page.mouse.up()
    expect(page.locator(".fold-row[data-state=done]")).to_have_count(3)


def test_the_transport_steps_from_primitive_to_primitive(page: Page, starts_s: list[float]) -> None:
    forth = page.get_by_role("button", name="Next step")
    back = page.get_by_role("button", name="Previous step")
    for index, start_s in enumerate(starts_s[1:], 1):
        forth.click()
        expect_time(page, start_s)
        expect_current(page, min(index, len(starts_s) - 2))
    for start_s in reversed(starts_s[:-1]):
        back.click()
        expect_time(page, start_s)


def test_comma_and_full_stop_step_too(page: Page, starts_s: list[float]) -> None:
    page.keyboard.press(".")
    expect_time(page, starts_s[1])
    page.keyboard.press(".")
    expect_time(page, starts_s[2])
    page.keyboard.press(",")
    expect_time(page, starts_s[1])


def test_arrows_walk_through_the_blocks_and_enter_goes_there(page: Page, starts_s: list[float]) -> None:
    lane = page.locator(".lane[data-lane=left] .block")
    lane.first.focus()
    page.keyboard.press("ArrowRight")
    expect(lane.nth(1)).to_be_focused()
    page.keyboard.press("Enter")
    expect_time(page, starts_s[1])
    page.keyboard.press("ArrowDown")
    expect(page.locator(".lane[data-lane=right] .block:focus")).to_have_count(1)


def test_a_row_of_the_plan_goes_to_its_start(page: Page, starts_s: list[float]) -> None:
    page.get_by_role("list", name="Plan").get_by_role("button").nth(2).click()
    expect_time(page, starts_s[2])
    expect_current(page, 2)


def test_pointing_at_a_lane_says_what_is_done_there_and_when(page: Page, starts_s: list[float]) -> None:
    lane = page.locator(".lane[data-lane=left]")
    page.mouse.move(*at_share(lane, 0.99))
    expect(page.locator(".lane-about")).to_be_visible()
    expect(page.locator(".lane-about")).to_contain_text("Fold: half")
    expect_time(page, 0.0)
    page.mouse.move(5, 5)
    expect(page.locator(".lane-about")).to_be_hidden()


def test_playing_at_a_speed_moves_the_time_until_paused(page: Page, starts_s: list[float]) -> None:
    page.get_by_role("combobox", name="Speed").select_option("8")
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("Number(document.querySelector('input[type=range]').value) > 4")
    page.get_by_role("button", name="Pause").click()
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    expect(page.get_by_role("combobox", name="Speed")).to_have_value("8")


def test_the_base_lane_shows_that_the_base_drives_within_a_fold(page: Page) -> None:
    blocks = page.evaluate(
        """async () => {
          const { laneBlocks } = await import("page/dock/lane_blocks.js");
          const fold = (start_s, back_off_m) =>
            ({ kind: "fold", fold: 0, start_s, duration_s: 5, grips: [], base: { station: "front", back_off_m } });
          const primitives = [fold(0, 0), fold(5, 0.3), fold(10, 0.1)];
          return laneBlocks({ primitives }, [{ name: "half", kind: "blue" }]).base;
        }"""
    )
    assert [f"{block['name']} {block['rest']}" for block in blocks] == ["30 cm back", "20 cm ahead"]
    assert [block["start_s"] for block in blocks] == [5, 10]
    assert blocks[0]["about"] == "Fold: half, at front, 30 cm back, the base drives 30 cm back, 5.0 s to 10.0 s"


def test_each_arm_of_a_robot_has_a_lane_whatever_it_is_called(page: Page) -> None:
    lanes, letters, titles = page.evaluate(
        """async () => {
          const { laneBlocks } = await import("page/dock/lane_blocks.js");
          const { armLetter, armTitle, tellArms } = await import("page/messages/arms.js");
          const names = ["upper", "under", "back_arm"];
          const grips = [{ arm: "under" }, { arm: "back_arm" }];
          const base = { station: null, back_off_m: 0 };
          const primitives = [{ kind: "fold", fold: 0, start_s: 0, duration_s: 5, grips, base }];
          const { arms } = laneBlocks({ primitives }, [{ name: "half", kind: "blue" }], null, names);
          tellArms(names);
          const told = [names.map(armLetter), names.map(armTitle)];
          tellArms(["left", "right"]);
          return [Object.entries(arms).map(([name, blocks]) => [name, blocks.length]), ...told];
        }"""
    )
    assert lanes == [["upper", 0], ["under", 1], ["back_arm", 1]]
    assert letters == ["1", "2", "B"]
    assert titles == ["Upper arm", "Under arm", "Back arm"]


def test_an_axis_has_round_times_and_not_too_many(page: Page) -> None:
    ticks = page.evaluate(
        """async () => {
          const { axisTicks } = await import("page/dock/lanes.js");
          return [0, 6, 53.6, 700].map(axisTicks);
        }"""
    )
    assert ticks[0] == []
    assert ticks[1] == [0, 1, 2, 3, 4, 5, 6]
    assert ticks[2] == [0, 10, 20, 30, 40, 50]
    assert ticks[3] == [0, 120, 240, 360, 480, 600]


def test_lengths_are_told_in_the_unit_of_the_page(page: Page) -> None:
    drag = page.get_by_role("list", name="Plan").locator(".plan-name").first
    told = drag.inner_text()
    assert re.fullmatch(r"Drag [\d.]+ cm", told)
    inches = round(float(told.split()[1]) / 2.54, 2)
    page.evaluate("async () => { (await import('page/board/units.js')).unit.name = 'in' }")
    expect(drag).to_have_text(f"Drag {inches:g} in")
    expect(page.locator(".transport .now")).to_contain_text(f"{inches:g} in towards the robot")
    page.evaluate("async () => { (await import('page/board/units.js')).unit.name = 'cm' }")
    expect(drag).to_have_text(told)


def test_of_a_new_plan_the_block_that_is_going_on_is_marked_too(
    context: BrowserContext, new_sheet: Callable[[Garment], Sheet]
) -> None:
    sheet = new_sheet(napkin())
    page = context.new_page()
    page.goto(sheet.page_url)
    expect_planned(page)
    expect(page.locator(".block.is-current")).not_to_have_count(0)

    def rename(drawing: dict[str, Any]) -> None:
        drawing["folds"][0]["name"] = "renamed"

    sheet.edit(rename)
    expect(page.locator(".block", has_text="renamed")).not_to_have_count(0)
    expect_planned(page)
    expect(page.locator(".block.is-current")).not_to_have_count(0)
