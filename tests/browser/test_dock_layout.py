"""The dock on windows of all sizes, for fingers, and for readers who want no motion."""

import itertools
import re
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.conftest import VIEW_PATIENCE_MS, Garment, Sheet, windows
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned

SPILT = """() => {
  const dock = document.getElementById("dock");
  const spilt = dock.scrollWidth > dock.clientWidth ? ["#dock"] : [];
  for (const part of dock.querySelectorAll("section, header, .fold-list, .plan-scroll, .numbers, .lanes")) {
    if (part.offsetParent && part.scrollWidth > part.clientWidth + 1) spilt.push(part.className);
  }
  return spilt;
}"""
PHONE = {"width": 390, "height": 844}


@pytest.fixture(scope="module")
def wide(chromium: Browser, new_sheet: Callable[[Garment], Sheet]) -> Iterator[Page]:
    with windows(chromium, reduced_motion="reduce") as context:
        page = context.new_page()
        page.goto(new_sheet(napkin()).page_url)
        expect_planned(page)
        yield page


@pytest.fixture(scope="module")
def phone(chromium: Browser, new_sheet: Callable[[Garment], Sheet]) -> Iterator[Page]:
    """Open the page on a phone with the sheet pulled up."""
    with windows(chromium, viewport=PHONE, has_touch=True, is_mobile=True) as context:
        page = context.new_page()
        page.goto(new_sheet(napkin()).page_url)
        expect_planned(page)  # before that nothing may hear the tap
        page.locator("#sheet").tap()
        yield page


@pytest.mark.parametrize(("width", "height"), [(1440, 900), (1024, 768), (960, 600), (721, 450), (720, 450)])
def test_nothing_spills_at_any_width_nor_at_200_per_cent(wide: Page, width: int, height: int) -> None:
    wide.set_viewport_size({"width": width, "height": height})
    assert wide.evaluate(SPILT) == []


@pytest.mark.parametrize("width", [1440, 960, 900, 800])
def test_nothing_lies_over_the_tools_of_the_3d_view_nor_they_over_its_picture(wide: Page, width: int) -> None:
    wide.set_viewport_size({"width": width, "height": 500})
    wide.evaluate("document.getElementById('viewpoints').hidden = false")  # as if its 3D view were there
    picture = wide.locator("#view3d").bounding_box()
    assert picture is not None
    for name in ("Who can fold this?", "Follow", "Free"):
        tool = wide.get_by_role("button", name=name, exact=True)
        tool.click(trial=True)
        box = tool.bounding_box()
        assert box is not None
        assert box["y"] + box["height"] <= picture["y"]


def test_the_status_covers_nothing_of_the_bar(wide: Page) -> None:
    for width in (721, 900, 1000, 1440):
        wide.set_viewport_size({"width": width, "height": 600})
        edges = wide.evaluate(
            """() => ["h1", "#garment", ".bar-group", "#status", ".bar-end"].map((name) => {
              const box = document.querySelector(name).getBoundingClientRect();
              return [box.left, box.right];
            })"""
        )
        for (_, right), (left, _) in itertools.pairwise(edges):
            assert right <= left + 0.5, width


def test_between_an_open_sheet_and_the_bar_of_a_low_window_there_is_one_view(wide: Page) -> None:
    wide.set_viewport_size({"width": 720, "height": 450})
    inset, sheet = wide.locator("#swap"), wide.locator("#sheet")
    expect(inset).to_be_visible()
    sheet.click()
    expect(inset).to_be_hidden()
    expect(wide.get_by_role("region", name="3D view")).to_be_visible()
    sheet.click()
    expect(inset).to_be_visible()


def test_nothing_spills_on_a_phone(phone: Page) -> None:
    assert phone.evaluate(SPILT) == []


def test_a_fold_is_pulled_by_its_number_with_a_finger(phone: Page) -> None:
    rows = phone.get_by_role("list", name="Folds").get_by_role("listitem")
    rows.nth(0).scroll_into_view_if_needed()
    start = rows.nth(0).locator(".fold-number").bounding_box()
    end = rows.nth(1).bounding_box()
    assert start is not None
    assert end is not None
    x = start["x"] + start["width"] / 2
    finger = phone.context.new_cdp_session(phone)

    def touch(kind: str, y: float | None) -> None:
        points = [] if y is None else [{"x": x, "y": y}]
        finger.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    y = start["y"] + start["height"] / 2
    below = end["y"] + 0.9 * end["height"]
    touch("touchStart", y)
    for share in (0.25, 0.5, 0.75, 1.0):
        touch("touchMove", y + share * (below - y))
    touch("touchEnd", None)
    expect(rows.locator(".fold-name")).to_have_text(["right", "left", "half"])


def test_with_reduced_motion_nothing_eases(wide: Page) -> None:
    moving = wide.evaluate(
        """() => [...document.querySelectorAll("#dock *")].filter((part) => {
          const { transitionDuration, animationName } = getComputedStyle(part);
          return parseFloat(transitionDuration) > 0 || animationName !== "none";
        }).length"""
    )
    assert moving == 0


def test_on_a_phone_the_3d_view_comes_first_with_play_and_help_speaks_of_fingers_first(phone: Page) -> None:
    phone.reload()
    expect_planned(phone)
    play = phone.get_by_role("button", name="Play in the 3D view")
    expect(play).to_be_enabled(timeout=VIEW_PATIENCE_MS)
    play.tap()
    pause = phone.get_by_role("button", name="Pause in the 3D view")
    expect(pause).to_be_visible()
    pause.tap()
    expect(play).to_be_visible()
    phone.get_by_role("button", name="Show the board large").tap()
    expect(play).to_be_visible()
    phone.get_by_role("button", name="Help").tap()
    expect(phone.get_by_role("dialog", name="Help").get_by_role("heading", level=3).first).to_have_text("With a finger")
    phone.keyboard.press("Escape")


def test_until_the_3d_view_is_there_a_quiet_picture_lies_over_it(phone: Page) -> None:
    expect(phone.locator(".view3d-cover")).to_have_text("Loading the 3D view\N{HORIZONTAL ELLIPSIS}")
    phone.evaluate("dispatchEvent(new MessageEvent('message', { data: 'pleat-ready' }))")  # from no 3D view
    expect(phone.locator(".view3d-cover")).not_to_have_attribute("hidden", "")
    told = "{ data: 'pleat-ready', source: document.getElementById('view3d').contentWindow }"
    phone.evaluate(f"dispatchEvent(new MessageEvent('message', {told}))")
    expect(phone.locator(".view3d-cover")).to_have_attribute("hidden", "")


def test_at_the_plans_end_a_card_over_the_3d_view_tells_the_packets_size_and_shares_it(wide: Page) -> None:
    wide.set_viewport_size({"width": 1280, "height": 800})
    card = wide.locator(".view3d-end")
    expect(card).to_be_hidden()
    slider = wide.get_by_role("slider", name="Time")
    for place, is_shown in (("max", True), ("min", False), ("max", True)):
        slider.evaluate(
            "(slider, place) => { slider.value = slider[place];"
            " slider.dispatchEvent(new Event('input', { bubbles: true })); }",
            place,
        )
        expect(card).to_be_visible(visible=is_shown)
    expect(card).to_contain_text(re.compile(r"^[\d.]+ \S [\d.]+ cm, [\d.]+ s"))
    card.get_by_role("button", name="Share").click()
    expect(wide.get_by_role("dialog", name="Share")).to_be_visible()
    wide.keyboard.press("Escape")
