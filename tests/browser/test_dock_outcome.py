"""The outcome of planning: the plan and its numbers, or the reasons why there is none, and suggestions."""

import json
import re
from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, Route, expect

from planner import load_garment
from tests.app.samples import towel
from tests.browser.board.conftest import desk as desk
from tests.browser.board.conftest import page as page
from tests.browser.board_desk import Desk
from tests.browser.conftest import REST
from tests.browser.napkin import napkin
from tests.browser.searches import SEARCH_MS
from tests.browser.status_pill import cost_s, expect_planned
from tests.required import required

FAR = {"x_m": 0.4, "y_m": 0.2, "yaw_rad": -1.5707963267948966}


@pytest.fixture
def front(desk: Desk) -> Iterator[Desk]:
    """Return the desk; all stations are there again afterwards."""
    scene = desk.drawing["scene"]
    yield desk
    desk.edit(lambda drawing: drawing.update(scene=scene, folds=[]))


@pytest.fixture
def stuck(page: Page, front: Desk) -> Desk:
    """Lay out a towel at the far end of the table, with a robot that may stand at the near end only."""
    front.lay(towel(placement=FAR))
    front.edit(keep_front_alone)
    expect(page.get_by_role("status")).to_contain_text("No plan: Half: ")
    return front


def keep_front_alone(drawing: dict[str, Any]) -> None:
    drawing["scene"]["stations"] = {"front": drawing["scene"]["stations"]["front"]}


def planned(desk: Desk) -> float:
    """Wait for the plan of what is laid out, and return its cost (s)."""
    expect_planned(desk.page, desk.state["version"])
    return cost_s(desk.page)


def suggestions(page: Page) -> Locator:
    return page.get_by_role("group", name="Suggestions").get_by_role("button")


def test_no_plan_is_a_sentence_a_suggestion_and_a_way_back(page: Page, stuck: Desk) -> None:
    expect(page.locator(".reason")).to_contain_text(
        re.compile(r"^Half: the (left|right) grip is [\d.]+ cm out of reach")
    )
    expect(page.get_by_role("list", name="Plan").get_by_role("listitem")).to_have_count(0)
    expect(page.get_by_role("button", name="Play", exact=True)).to_be_disabled()
    move = suggestions(page).filter(has_text="Move the garment")
    move.first.click()
    expect_planned(page)
    assert (stuck.can_undo or "").startswith("Move the garment ")
    assert stuck.drawing["placement"]["x_m"] < FAR["x_m"]
    expect(page.get_by_text("no plan before")).to_be_visible()
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_role("status")).to_contain_text("No plan: Half: ")
    assert stuck.drawing["placement"] == FAR


def test_what_is_suggested_follows_the_unit(page: Page, stuck: Desk) -> None:
    move = suggestions(page).filter(has_text=re.compile(r"Move the garment [\d.]+ cm"))
    expect(move.first).to_be_visible()
    page.get_by_role("button", name="Unit: cm").click()
    expect(suggestions(page).filter(has_text=re.compile(r"Move the garment [\d.]+ in")).first).to_be_visible()
    expect(suggestions(page).filter(has_text=" cm")).to_have_count(0)
    expect(page.get_by_role("list", name="Reasons")).to_contain_text(re.compile(r"grip at \([-\d., ]+\) in"))
    page.get_by_role("button", name="Unit: in").click()
    expect(suggestions(page).filter(has_text=re.compile(r"Move the garment \d+ mm")).first).to_be_visible()
    page.get_by_role("button", name="Unit: mm").click()


def test_where_nothing_helps_at_once_there_is_a_button_to_look_longer(page: Page, desk: Desk) -> None:
    scarf = load_garment("scarf-halved").to_dict()  # whose reasons name no amount that would do
    work: list[float] = []

    def nothing(route: Route) -> None:
        asked = required(route.request.post_data_json)
        assert asked["time_limit_s"] == 60  # so that the work ends it, not the clock
        if asked["garment"]["name"] == scarf["name"]:  # a search for what lay there before may begin meanwhile
            work.append(asked["work_limit_s"])
        done = {"count": 0, "elapsed_s": 1.0, "complete": asked["work_limit_s"] == 60}
        route.fulfill(content_type="text/event-stream", body=f"event: done\ndata: {json.dumps(done)}\n\n")

    page.route("**/api/suggestions*", nothing)
    desk.lay(scarf)
    expect(page.locator(".search-words")).to_contain_text("not all was tried")
    expect(page.get_by_text("No single small change")).to_have_count(0)
    page.get_by_role("button", name="Look longer").click()
    expect(page.get_by_role("button", name="Look longer")).to_be_hidden()
    expect(page.locator(".search-words")).to_have_text("No single small change gives a plan.")
    assert work == [10, 60]
    page.get_by_role("button", name="Other robots").click()
    expect(page.get_by_role("dialog", name="Who can fold this?")).to_be_visible()
    page.keyboard.press("Escape")
    page.unroute_all()


def test_an_edit_ends_the_search_for_what_would_help(page: Page, front: Desk) -> None:
    with page.expect_request(lambda request: "/api/suggestions?" in request.url):
        front.lay(towel(placement=FAR))
        front.edit(keep_front_alone)
    with page.expect_event("requestfailed", lambda request: "/api/suggestions?" in request.url):
        front.edit(lambda drawing: drawing["folds"].clear())
    expect(page.get_by_role("status")).to_have_text("No folds yet: draw the first one")
    expect(page.get_by_text("Nothing to do")).to_be_visible()


def test_all_the_reasons_stand_where_the_plan_would_be(page: Page, stuck: Desk) -> None:
    reasons = page.get_by_role("list", name="Reasons").get_by_role("listitem")
    expect(reasons.first).to_be_in_viewport(ratio=0.9)
    expect(reasons.first).to_contain_text("\N{LEFT DOUBLE QUOTATION MARK}half\N{RIGHT DOUBLE QUOTATION MARK}: ")


def test_the_numbers_say_what_the_cost_is_made_of_and_how_it_changed(page: Page, desk: Desk) -> None:
    desk.lay(napkin())
    before_s = planned(desk)
    numbers = page.get_by_role("region", name="Numbers")
    expect(numbers).to_contain_text(f"{before_s:.1f} s")
    spent = [float(text.split()[0]) for text in numbers.locator(".is-parts dd").all_inner_texts()]
    assert sum(spent) == pytest.approx(before_s, abs=0.05 * len(spent) + 0.05)
    desk.edit(lambda drawing: drawing["folds"].pop())
    changed = numbers.locator(".total-change")
    expect(changed).to_contain_text("less than before")
    expect_planned(page)
    saved = float(changed.inner_text().split()[0])
    assert saved == pytest.approx(before_s - cost_s(page), abs=0.11)
    expect(numbers.get_by_text("Expanded", exact=True)).to_be_hidden()
    numbers.get_by_text("How it was found").click()
    for name in ("Expanded", "Explored", "IK queries", "Search", "Joint paths"):
        expect(numbers.get_by_text(name, exact=True)).to_be_visible()


def test_a_difference_is_told_with_its_sign_in_words(modules: Page) -> None:
    told = modules.evaluate(
        """async () => {
          const { difference } = await import("/static/js/dock/numbers.js");
          const before = (cost_s) => ({ version: 1, status: cost_s === null ? "infeasible" : "solved", cost_s });
          const all = [null, before(0), before(null), before(40), before(41.5), before(40.02)];
          return all.map((one) => difference(40, one));
        }"""
    )
    assert told == ["", "", "no plan before", "same as before", "1.5 s less than before", "same as before"]


def test_what_a_person_can_do_comes_before_what_must_be_assumed(modules: Page) -> None:
    order = modules.evaluate(
        """async () => {
          const { ranked } = await import("/static/js/dock/suggestion_search.js");
          const at = (x_m) => ({ placement: { x_m, y_m: 0, yaw_rad: 0 } });
          const one = (kind, size, cost_s, is_assumption = false) =>
            ({ kind, size, cost_s, is_assumption, change: at(size) });
          const found = [one("friction", 1, 20, true), one("station", 1, 42), one("placement", 0.6, 10),
            one("placement", 0.5, 12), one("placement", 0.7, 11)];
          return ranked(found).map(({ kind, size }) => [kind, size]);
        }"""
    )
    # The nearest place first; then the other kind; then the further place, which is quicker (the third is not).
    assert order == [["placement", 0.5], ["station", 1], ["placement", 0.6], ["friction", 1]]


def test_of_two_places_that_are_nearly_one_the_better_is_offered(modules: Page) -> None:
    kept = modules.evaluate(
        """async () => {
          const { ranked } = await import("/static/js/dock/suggestion_search.js");
          const at = (x_m, y_m, cost_s, yaw_rad = 0) =>
            ({ kind: "placement", size: Math.hypot(x_m, y_m), cost_s, change: { placement: { x_m, y_m, yaw_rad } } });
          const left = at(-0.08, 0, 46.2);
          const told = (...found) => ranked([left, ...found]).map(({ cost_s }) => cost_s);
          const turn = 2 * Math.PI;
          return [told(at(-0.085, 0.005, 46.1)), told(at(-0.085, 0.005, 40)), told(at(-0.2, 0, 46.1)),
            told(at(-0.085, 0, 46.1, turn)), told(at(-0.085, 0, 46.1, turn / 2))];
        }"""
    )
    # Half a centimetre apart: the smaller change, unless the other's plan is cheaper by more than a second. A whole
    # turn is none, and half a turn is another place.
    assert kept == [[46.2], [40], [46.2, 46.1], [46.2], [46.2, 46.1]]


def test_of_fold_lines_only_those_of_one_fold_are_nearly_one(modules: Page) -> None:
    kept = modules.evaluate(
        """async () => {
          const { ranked } = await import("/static/js/dock/suggestion_search.js");
          const shifted = (first, second, cost_s) => {
            const fold = (y) => ({ start: [0, y], end: [1, y] });
            const garment = { folds: [fold(first), fold(1 + second)] };
            return { kind: "fold_line", size: Math.abs(first + second), cost_s, change: { garment } };
          };
          return ranked([shifted(0.0125, 0, 40), shifted(0.0175, 0, 39.9), shifted(0, 0.02, 39.8)])
            .map(({ cost_s }) => cost_s);
        }"""
    )
    assert kept == [40, 39.8]


def test_how_far_the_cloth_was_dragged_by_then_is_said_where_there_is_room(modules: Page) -> None:
    told = modules.evaluate(
        """async () => {
          const { explanation, headline } = await import("/static/js/dock/reasons.js");
          const reason = { fold: 0, code: "out_of_reach", arm: "left", short_by_m: 0.02, message: "short" };
          const state = { drawing: { folds: [{ name: "half" }] }, problems: [] };
          const about = (offset_m) => ({ status: "infeasible", plan: { reasons: [{ ...reason, offset_m }] } });
          return [explanation(about([-0.3, 0.4]), state), headline(about([-0.3, 0.4]), state),
            explanation(about([0, 0]), state), explanation(about(null), state)];
        }"""
    )
    brief = "Half: the left grip is 2 cm out of reach."
    way = "30 cm towards the robot and 40 cm to the left"
    assert told == [f"{brief[:-1]}, after the cloth was dragged {way}.", brief, brief, brief]


def test_a_reason_without_words_is_not_shown(modules: Page) -> None:
    told = modules.evaluate(
        """async () => {
          const { details } = await import("/static/js/dock/reasons.js");
          const plan = { reasons: [{ fold: 0, message: "" }, { fold: 0, message: "too far" }] };
          return details({ status: "infeasible", plan }, { drawing: { folds: [{ name: "half" }] }, problems: [] });
        }"""
    )
    assert told == ["\N{LEFT DOUBLE QUOTATION MARK}half\N{RIGHT DOUBLE QUOTATION MARK}: too far."]


def test_when_a_search_is_cut_short_the_pill_is_brief_and_the_dock_says_how_far_the_search_came(modules: Page) -> None:
    told = modules.evaluate(
        """async () => {
          const { explanation, headline } = await import("/static/js/dock/reasons.js");
          const text = "No plan: searched 1,207 candidates and found none; any takes 9 s. To look longer may help";
          const message = { status: "budget_exceeded", text, plan: { reasons: [], statistics: { ways: 1207 } } };
          const state = { drawing: { folds: [] }, problems: [] };
          return [headline(message, state), explanation(message, state)];
        }"""
    )
    brief = "Searched 1,207 candidates and found none"
    assert told == [f"{brief}.", f"{brief}; any takes 9 s. To look longer may help."]


def test_what_is_short_at_least_is_said_to_be(modules: Page) -> None:
    told = modules.evaluate(
        """async () => {
          const { sentence } = await import("/static/js/dock/reasons.js");
          const reason = { fold: 0, code: "out_of_reach", cause: "too_far", arm: "left", short_by_m: 0.8 };
          return [true, false].map((is_at_least) => sentence({ ...reason, is_at_least }, [{ name: "half" }]));
        }"""
    )
    assert told == [
        "Half: the left grip is at least 80 cm out of reach (too far).",
        "Half: the left grip is 80 cm out of reach (too far).",
    ]


@pytest.mark.long
def test_a_better_place_is_offered_and_taken_as_one_step(page: Page, front: Desk) -> None:
    front.lay(towel(placement={**FAR, "x_m": -0.1}))
    front.edit(keep_front_alone)
    before_s = planned(front)
    page.get_by_role("button", name="Best place").click()
    expect(page.get_by_text("Trying places")).to_be_visible()
    page.locator(".best-place .suggestion").click(timeout=SEARCH_MS)
    expect(page.locator(".total-change")).to_contain_text("less than before")
    assert cost_s(page) < before_s
    assert (front.can_undo or "").startswith("Move the garment ")
    expect(page.locator(".best-place")).to_be_hidden()


def test_a_change_of_a_suggestion_keeps_the_ties_of_folds_that_stay(page: Page, stuck: Desk) -> None:
    drawing = stuck.drawing
    folds = [*drawing["folds"], {**drawing["folds"][0], "id": "f9", "name": "again"}]
    wanted = REST.get(stuck.path).json()["garment"]["folds"][0]
    shifted = {**wanted, "name": "again", "start": [0.4, 0.2], "end": [0.0, 0.2], "grip_radius_m": 0.3}
    changed = page.evaluate(
        """async ([drawing, folds]) => {
          const { applyChange } = await import("/static/js/dock/suggestion_button.js");
          applyChange(drawing, { garment: { folds } });
          return drawing.folds;
        }""",
        [{**drawing, "folds": folds}, [wanted, shifted]],
    )
    assert changed[0] == folds[0]
    assert changed[1]["id"] == "f9"
    assert changed[1]["start"] == {"point": [0.4, 0.2], "on": None}
    assert changed[1]["grip_radius_m"] == 0.3
