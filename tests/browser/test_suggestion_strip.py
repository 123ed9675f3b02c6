"""Where there is no plan, a strip over the board says why and fills with cards of what would help."""

import json
import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, Route, expect

from tests.app.conftest import REST
from tests.browser.board.conftest import page as page
from tests.browser.board_hand import Hand
from tests.browser.conftest import Garment, Sheet
from tests.browser.searches import SEARCH_MS
from tests.browser.status_pill import expect_planned

APRON = {
    "name": "apron",
    "outline": [
        [0, 0],
        [0.7, 0],
        [0.7, 0.5],
        [0.56, 0.58],
        [0.5, 0.9],
        [0.35, 0.88],
        [0.2, 0.9],
        [0.14, 0.58],
        [0, 0.5],
    ],
    "folds": [{"name": "half", "kind": "blue", "start": [0.35, 0.0], "end": [0.35, 0.88]}],
}


IS_CLEAR = """(high_m) => {
  const board = document.getElementById("drafting-board");
  const top = board.getBoundingClientRect().top + Number(board.dataset.originPx.split(",")[1]);
  const strip = document.querySelector(".suggestion-strip");
  return strip.getBoundingClientRect().bottom <= top - high_m * board.dataset.pxPerM;
}"""
"""Whether cloth that is so high (m) begins below the strip."""


def top_of_cloth_px(page: Page, high_m: float) -> float:
    return Hand(page).px((0.0, high_m))[1]


def foot_of_strip_px(page: Page) -> float:
    box = page.locator(".suggestion-strip").bounding_box()
    assert box is not None
    return box["y"] + box["height"]


def some_cards(route: Route) -> None:
    """Answer with four changes that would help."""
    says = {"code": "assume_friction", "friction": 1.5, "now": 1.0}
    events = [
        {"kind": "friction", "is_assumption": True, "says": says, "change": {}, "size": 0.5, "cost_s": 20.0},
        {"kind": "split", "is_assumption": False, "change": {}, "size": 1.0, "cost_s": 38.5}
        | {"says": {"code": "split_fold", "fold": 0, "depth_m": 0.175}},
        *(
            {
                "kind": "placement",
                "is_assumption": False,
                "change": {"placement": place},
                "size": 0.1,
                "cost_s": cost,
            }
            | {"says": {"code": "place", "quarters": 0, "by": [0.1, 0.0]}}
            for place, cost in (
                ({"x_m": 0.1, "y_m": 0.0, "yaw_rad": 0.0}, 30.0),
                ({"x_m": 0.5, "y_m": 0.0, "yaw_rad": 0.0}, 25.0),
            )
        ),
    ]
    told = [{**event, "message": "RUBBISH", "plan_id": "gone"} for event in events]
    lines = [f"event: suggestion\ndata: {json.dumps(event)}\n\n" for event in told]
    done = 'event: done\ndata: {"count": 4, "elapsed_s": 1.0, "complete": true}\n\n'
    route.fulfill(content_type="text/event-stream", body="".join(lines) + done)


@pytest.mark.long
def test_an_apron_halved_lengthwise_is_split_by_the_keyboard_and_put_back_by_one_undo(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    sheet = new_sheet(APRON)
    page.goto(sheet.page_url)
    expect(page.locator(".suggestion-strip .reason")).to_contain_text("Half: needs more hands than there are")
    expect(page.locator(".search-words")).to_contain_text(re.compile("Trying: |Looking for"))
    expect(page.locator(".grip-span")).to_have_count(2)
    expect(page.get_by_text("no hand left")).to_be_visible()
    expect(page.locator(".robot-name")).to_contain_text("front")
    split = page.get_by_role("button", name=re.compile("in two, the outer"))
    expect(split.first).to_be_visible(timeout=SEARCH_MS)
    expect(split.first.locator(".picture-layer")).not_to_have_count(0)
    page.keyboard.press("h")
    expect(split.first).to_be_focused()
    expect(page.locator(".fold.is-preview")).to_have_count(2)
    page.keyboard.press("Enter")
    expect_planned(page)
    assert sheet.fold_names == ["half, outer part", "half"]
    expect(page.locator(".suggestion-strip")).to_be_hidden()
    page.keyboard.press("Control+z")
    expect(page.locator(".suggestion-strip")).to_be_visible()
    assert sheet.fold_names == ["half"]


def test_a_cloth_just_drawn_is_not_hidden_below_the_strip_and_a_view_that_was_moved_stays(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    page.goto(new_sheet(None).page_url)
    hand = Hand(page)
    pointed = [(0.0, 0.0), (0.5, 0.0), (0.7, 0.4), (0.5, 0.8), (0.0, 0.8)]
    for point in [*pointed, pointed[0]]:
        hand.click(point)
    hand.tool("Draw fold")
    hand.tool("Flip")
    hand.drag((0.2, 0.8), (0.2, 0.0))  # the larger part's three corners are too far from each other for two hands
    strip = page.locator(".suggestion-strip")
    expect(strip).to_be_visible()
    board = hand.board.bounding_box()
    assert board is not None
    page.wait_for_function(IS_CLEAR, arg=0.8)  # the strip grows while cards come, and the cloth follows a frame later
    assert hand.px((0.0, 0.0))[1] <= board["y"] + board["height"]
    page.mouse.move(*hand.px((0.25, 0.4)))
    page.mouse.wheel(0, -300)
    moved = hand.px((0.0, 0.0))
    strip.get_by_role("button", name="Hide").click()
    strip.get_by_role("button", name="Show").click()
    assert hand.px((0.0, 0.0)) == moved


def test_all_cards_that_come_are_at_hand_and_none_moves_while_others_come(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    page.route("**/api/suggestions*", some_cards)
    page.goto(new_sheet(APRON).page_url)
    cards = page.get_by_role("group", name="Suggestions").get_by_role("button")
    expect(cards).to_have_count(3)
    kinds = [card.get_attribute("data-title") for card in cards.all()]
    assert kinds == ["Move or size the cloth", "Change a fold", "Assume"]
    page.get_by_role("button", name=re.compile("[12] more")).click()  # a reason may name an amount that would do, too
    expect(cards.nth(3)).to_be_visible()
    page.wait_for_function("new Promise(requestAnimationFrame)")
    assert top_of_cloth_px(page, 0.9) >= foot_of_strip_px(page)
    assert "RUBBISH" not in page.locator("body").inner_text()


def test_on_a_low_board_the_cards_stand_beside_the_cloth_and_the_view_comes_back_when_they_close(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    page.route("**/api/suggestions*", some_cards)
    page.set_viewport_size({"width": 900, "height": 500})
    page.goto(new_sheet(APRON).page_url)
    show, board = page.get_by_role("button", name="Show suggestions"), page.locator("#drafting-board")
    show.click()
    expect(page.get_by_role("group", name="Suggestions").get_by_role("button")).to_have_count(3)
    page.wait_for_function("new Promise(requestAnimationFrame)")
    strip = page.locator(".suggestion-strip").bounding_box()
    assert strip is not None
    assert Hand(page).px((0.7, 0.0))[0] <= strip["x"]
    assert float(str(board.get_attribute("data-px-per-m"))) > 100
    page.get_by_role("button", name="Hide suggestions").click()
    page.get_by_role("button", name="Fit").click()
    page.wait_for_function("new Promise(requestAnimationFrame)")
    whole = [str(board.get_attribute(name)) for name in ("data-px-per-m", "data-origin-px")]
    show.click()
    expect(board).not_to_have_attribute("data-origin-px", whole[1])
    page.get_by_role("button", name="Hide suggestions").click()
    expect(board).to_have_attribute("data-px-per-m", whole[0])
    expect(board).to_have_attribute("data-origin-px", whole[1])


@pytest.mark.long
def test_another_robot_that_can_is_a_card_one_click_and_one_undo(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    folds = [{"name": "half", "kind": "blue", "start": [0.6, 0.45], "end": [0.0, 0.45]}]
    sheet = new_sheet({"name": "towel", "outline": [[0, 0], [0.6, 0], [0.6, 0.9], [0, 0.9]], "folds": folds})
    REST.put(f"{sheet.path}/robot", json={"robot": "so101-pair"}).raise_for_status()
    before = sheet.drawing
    page.goto(sheet.page_url)
    other = page.locator(".card[data-kind=robot]")
    expect(other).to_have_count(1, timeout=SEARCH_MS)
    expect(other).to_contain_text(re.compile(r"Let .* fold it.*[\d.]+ s", re.DOTALL))
    assert other.get_attribute("data-title") == "Change the robot"
    other.click()
    expect_planned(page)
    assert sheet.drawing["robot"] != "so101-pair"
    assert sheet.drawing["outline"] == before["outline"]
    page.keyboard.press("Control+z")
    expect(page.locator(".suggestion-strip")).to_be_visible()
    after = sheet.at_rest()["drawing"]
    assert {**after, "folds": []} == {**before, "folds": []}
