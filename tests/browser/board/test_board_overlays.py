"""Overlays on the board: corners that must be held, the reach of hands, and shortfalls."""

import re
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Page, expect

from tests.browser.board_desk import Desk
from tests.browser.board_hand import Hand
from tests.browser.channel import Message, listened_to
from tests.browser.searches import SEARCH_MS
from tests.browser.status_pill import expect_planned
from tests.required import required


@pytest.fixture
def moved_desk(desk: Desk) -> Iterator[Desk]:
    """Return the desk in another scene; the default scene is restored afterwards."""
    scene = desk.drawing["scene"]
    yield desk
    desk.edit(lambda drawing: drawing.update(scene=scene))


def test_the_fold_that_is_looked_at_shows_what_must_be_held_and_where(page: Page, towel: Desk) -> None:
    expect_planned(page)
    expect(page.locator(".must-hold")).to_have_count(0)
    first = towel.drawing["folds"][0]
    (ax, ay), (bx, by) = first["start"]["point"], first["end"]["point"]
    Hand(page).click((0.8 * ax + 0.2 * bx, 0.8 * ay + 0.2 * by))
    # Half a rectangle is lifted by its two far corners (figure 1 of the paper): one grip each.
    expect(page.locator(".must-hold")).to_have_count(2)
    expect(page.locator("circle.grip")).to_have_count(2)


def test_what_the_robot_can_reach_is_shown_when_asked_for(page: Page, towel: Desk) -> None:
    with listened_to(page, towel.page_url) as (window, channel):
        expect_planned(window)
        channel.take = lambda sent, _answer: sent["do"] != "overlays" or len(channel.asked("overlays")) > 1
        reach, wait = window.get_by_role("button", name="Reach", exact=True), window.get_by_text("Working it out")
        reach.click()
        expect(wait).to_be_visible()
        expect(reach).to_have_attribute("aria-busy", "true")
        channel.pass_on(channel.first_asked("overlays"))
        expect(window.locator(".layer-under .reach")).to_have_count(2)
        expect(wait).to_have_count(0)
        expect(reach).to_have_attribute("aria-busy", "false")
        reach.click()
        expect(window.locator(".layer-under .reach")).to_have_count(0)


def test_a_server_that_is_busy_or_away_is_asked_again(page: Page, towel: Desk) -> None:
    with listened_to(page, towel.page_url) as (window, channel):
        refusals: list[int | None] = [None, 429, 503]

        def refuse_the_first(sent: Message, answer: Callable[[Message], None]) -> bool:
            if sent["do"] != "overlays" or not refusals:
                return True
            if status := refusals.pop():
                answer({"kind": "problem", "title": "Busy", "status": status, "detail": "busy"})
            else:
                channel.cut()
            return False

        expect_planned(window)
        channel.take = refuse_the_first
        window.get_by_role("button", name="Reach", exact=True).click()
        expect(window.locator(".layer-under .reach")).to_have_count(2)
        assert not refusals and len(channel.asked("overlays")) > 3


@pytest.mark.long
def test_the_cost_map_is_kept_while_the_drawing_stays(page: Page, towel: Desk) -> None:
    with listened_to(page, towel.page_url) as (window, channel):
        expect_planned(window)
        chip = window.get_by_role("button", name="Cost map")
        for _ in range(2):
            chip.click()
            expect(window.locator(".layer-under .cost").first).to_be_visible(timeout=SEARCH_MS)
            chip.click()
            expect(window.locator(".layer-under .cost")).to_have_count(0)
        assert len(channel.asked("places")) == 1


def test_where_a_hand_falls_short_is_marked_with_how_much(page: Page, moved_desk: Desk) -> None:
    strip = {"name": "strip", "outline": [[0.0, 0.0], [0.1, 0.0], [0.1, 0.54], [0.0, 0.54]]}
    far_end = {"name": "far end", "kind": "blue", "start": [0.0, 0.28], "end": [0.1, 0.28]}
    before_left_arm = {"x_m": -0.78, "y_m": 0.238, "yaw_rad": -1.5707963267948966}
    moved_desk.lay({**strip, "folds": [far_end], "placement": before_left_arm})
    # At a table 1 m high an end that must be lifted by 0.26 m is lifted too high.
    front = {"stations": {"front": {"x_m": -0.95, "y_m": 0.0, "yaw_rad": 0.0}}, "table": {"height_m": 1.0}}
    straight = {"approach_cone_rad": 0.0}  # hands that reach back would be stopped by the table
    moved_desk.edit(lambda drawing: drawing["scene"].update(front | straight))
    status = page.get_by_role("status")
    expect(status).to_contain_text("No plan: ")
    expect(page.locator(".reason-text")).to_contain_text("too high")
    short = str(page.locator(".reason-text").text_content()).partition(" too")[0]
    arm = {"L": "left", "R": "right"}[required(page.locator(".reason-arm").text_content())]
    expect(status).to_contain_text(f"the {arm} grip is {short} out of reach")
    expect(page.locator(".table-line")).to_have_count(1)
    # Straight below there is reach, at that height there is none: all that is near is hatched, and no edge is drawn.
    expect(page.locator(".beyond")).to_have_count(1)
    expect(page.locator(".beyond-edge")).to_have_count(0)
    # At the top of its way the hand is over the fold line, in the middle of which it holds the strip.
    assert middle(page, ".problem-cross") == pytest.approx(Hand(page).px((0.05, 0.28)), abs=1)


def test_the_cross_is_on_the_cloth_as_it_lies_though_the_robot_would_have_dragged_it(page: Page, desk: Desk) -> None:
    desk.lay(desk.garment("scarf-halved"))
    expect(page.get_by_role("status")).to_contain_text("No plan: ")
    expect(page.locator(".beyond")).to_have_count(1)
    # One hand takes the middle of the scarf's near end, 0.254 / 2 m from both corners, and lays it 1.524 m further on:
    # it rises as far as it has gone, until it is over the fold line, and comes down as far as it goes on.
    hand, (x, y) = Hand(page), middle(page, ".problem-cross")
    way = re.fullmatch(r"dragged ([\d.]+ cm .+)", str(page.locator(".drag-text").text_content()))
    assert way is not None
    expect(page.locator(".drag-arrow")).to_have_count(1)
    expect(page.locator(".reason")).to_contain_text(f", after the cloth was dragged {way[1]}.")
    (start_x, start_y), (_, end_y) = hand.px((0.254 / 2, 0.0)), hand.px((0.254 / 2, 1.524))
    assert x == pytest.approx(start_x, abs=1)
    along = 1.524 * (start_y - y) / (start_y - end_y)
    up = re.search(r", ([\d.]+) cm up$", str(page.locator(".reason-text").text_content()))
    height = 0.02 if up is None else float(up[1]) / 100
    assert min(along, 1.524 - along) == pytest.approx(height - 0.02, abs=0.01 if up else 0.04)


def test_what_is_short_at_least_is_marked_so_and_the_words_stay_on_the_board(page: Page, moved_desk: Desk) -> None:
    moved_desk.lay(moved_desk.garment("hand-towel"))
    # All of the table is 1.6 m ahead of the base or more, and arms are 1 m long: no shift that is tried helps.
    far = {"stations": {"front": {"x_m": -2.4, "y_m": 0.0, "yaw_rad": 0.0}}, "back_off_max_m": 0.0}
    moved_desk.edit(lambda drawing: drawing["scene"].update(far))
    expect(page.get_by_role("status")).to_contain_text("is at least ")
    words = page.locator(".reason-text")
    expect(words).to_contain_text(re.compile(r"^at least [\d.]+ cm short$"))
    board, box = page.locator("#drafting-board").bounding_box(), words.bounding_box()
    assert board is not None
    assert box is not None
    assert board["x"] <= box["x"] and box["x"] + box["width"] <= board["x"] + board["width"]
    assert board["y"] <= box["y"] and box["y"] + box["height"] <= board["y"] + board["height"]


def middle(page: Page, selector: str) -> tuple[float, float]:
    """Return the middle of the drawing on the board (px)."""
    box = page.locator(selector).bounding_box()
    assert box is not None
    return (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)


def test_where_a_hand_falls_short_along_the_table_its_reach_ends_at_the_arrow(page: Page, moved_desk: Desk) -> None:
    moved_desk.lay(moved_desk.garment("t-shirt"))
    only_front = {"stations": {"front": {"x_m": -0.95, "y_m": 0.0, "yaw_rad": 0.0}}, "back_off_max_m": 0.0}
    moved_desk.edit(lambda drawing: drawing["scene"].update(only_front))
    expect(page.get_by_role("status")).to_contain_text("out of reach (too far)")
    expect(page.locator(".beyond-edge")).to_have_count(1)
    edge = page.locator(".beyond-edge")
    away = edge.evaluate(
        """(edge, [x, y]) => {
          const box = edge.ownerSVGElement.getBoundingClientRect();
          const step = edge.getTotalLength() / 400;
          const places = Array.from({ length: 401 }, (_, n) => edge.getPointAtLength(step * n));
          return Math.min(...places.map((place) => Math.hypot(place.x + box.x - x, place.y + box.y - y)));
        }""",
        middle(page, ".problem-cross"),
    )
    short_m = float(str(page.locator(".reason-text").text_content()).partition(" cm")[0]) / 100
    assert away / float(str(Hand(page).board.get_attribute("data-px-per-m"))) == pytest.approx(short_m, abs=0.006)
