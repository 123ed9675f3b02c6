"""`Fold it for me`: ways to fold the garment to a size, as cards that come while they are looked for."""

import json
import re
from collections.abc import Callable
from typing import Any

from playwright.sync_api import Page, Route, expect

from planner.proposals.target import PRESETS, SIDE_MAX_M, SIDE_MIN_M, TOLERANCE_M
from tests.app.conftest import REST
from tests.browser.board.conftest import page as page
from tests.browser.board_hand import Hand
from tests.browser.conftest import Garment, Sheet
from tests.browser.searches import SEARCH_MS
from tests.patience import wait_until

NewSheet = Callable[[Garment], Sheet]

TOWEL: dict[str, Any] = {"name": "towel", "outline": [[0, 0], [0.6, 0], [0.6, 0.4], [0, 0.4]]}


def size(wide_cm: float, long_cm: float) -> re.Pattern[str]:
    return re.compile(rf"{wide_cm:.1f} \S {long_cm:.1f} cm")


def have_all_ended(sheet: Sheet) -> bool:
    """Return whether no proposals are looked for any more."""
    jobs = REST.get(f"{sheet.path.partition('/api/')[0]}/api/jobs").json()["jobs"]
    return {job["status"] for job in jobs if job["kind"] == "proposals"} <= {"done", "cancelled"}


def test_a_way_is_looked_at_and_taken_by_keyboard_and_is_one_step(page: Page, new_sheet: NewSheet) -> None:
    sheet = new_sheet(TOWEL)
    with page.expect_websocket() as opened:
        page.goto(sheet.page_url)
    page.get_by_role("button", name="Fold it for me").press("a")
    panel = page.get_by_role("region", name="Fold it for me")
    expect(panel.get_by_role("button", name="Shop shelf")).to_be_focused()
    panel.get_by_role("button", name="Halves").press("Enter")
    expect(panel.get_by_role("textbox", name="Width of the packet")).to_have_value("30.0")
    card = panel.get_by_role("group", name="Ways to fold it").get_by_role("button").first
    expect(card).to_have_attribute("data-status", "solved", timeout=SEARCH_MS)
    expect(card).to_contain_text(size(30, 20), timeout=SEARCH_MS)
    expect(card.locator(".picture-layer")).to_have_count(4)
    with opened.value.expect_event("framesent", lambda frame: '"preview"' in frame and "null" not in frame):
        card.focus()  # the 3D view shows its plan
    expect(page.locator("#board-cloth .is-back")).not_to_have_count(0)
    card.press("Enter")
    expect(panel).to_be_hidden()
    expect(page.locator(".fold-row")).to_have_count(2)
    assert sheet.can_undo == "Fold it for me"
    wait_until(lambda: have_all_ended(sheet))
    page.keyboard.press("Control+z")
    expect(page.locator(".fold-row")).to_have_count(0)


def proposal(outline: list[list[float]], size_m: tuple[float, float]) -> dict[str, Any]:
    garment = {**TOWEL, "outline": outline, "folds": [], "grip_radius_m": 0.127}
    return {
        "folds": [],
        "garment": garment,
        "size_m": size_m,
        "layers": 2,
        "status": "solved",
        "cost_s": 9.0,
        "is_loose": False,
        "number": 1,
        "plan_id": "1",
    }


def test_the_size_is_pulled_and_what_changes_begins_anew(page: Page, new_sheet: NewSheet) -> None:
    """Where nothing fits, or none can be done, what comes nearest is shown."""
    asked: list[dict[str, Any]] = []

    def begin(route: Route) -> None:
        asked.append(json.loads(route.request.post_data or "{}"))
        route.fulfill(status=202, json={"id": str(len(asked))})

    def tell(route: Route) -> None:
        wanted = asked[-1]
        untried = {**proposal(TOWEL["outline"], (0.4, 0.3)), "status": "untried", "cost_s": None, "number": 0}
        del untried["plan_id"]
        if wanted["to"] == "suitcase":  # it is still looked for
            route.fulfill(content_type="text/event-stream", body=f"event: found\ndata: {json.dumps(untried)}\n\n")
            return
        like = wanted["to"].get("like") if isinstance(wanted["to"], dict) else None
        long_m = 0.2 if wanted["to"] == "drawer" else 0.3 if like == "tie" else 0.4 if like else 0.1
        size_m = (max(x for x, _ in wanted["garment"]["outline"]), long_m)
        is_unfit = wanted["to"] == {"width_m": 0.1, "length_m": 0.25}
        found = [proposal(TOWEL["outline"], (0.4, 0.3) if is_unfit else size_m)]
        if is_unfit:
            found = [untried, {**found[0], "number": 0}]
        elif wanted["to"] == "thirds" and wanted["robot"] == "pr2":
            found[0].update(status="infeasible", cost_s=None)
        found = [{**one, "is_loose": like == "tie"} for one in found]
        lines = [f"event: found\ndata: {json.dumps(one)}\n\n" for one in found]
        end = {"status": "done", "progress": 1.0, "message": "", "result": {"proposals": found}}
        body = "".join([*lines, f"event: end\ndata: {json.dumps(end)}\n\n"])
        route.fulfill(content_type="text/event-stream", body=body)

    page.route("**/api/proposals", begin)
    page.route("**/api/jobs/*/events", tell)
    folded = {**TOWEL, "folds": [{"name": "half", "kind": "blue", "start": [0.3, 0], "end": [0.3, 0.4]}]}
    mat, sheet = new_sheet({**folded, "title": "Bath mat"}), new_sheet(folded)
    page.goto(sheet.page_url)
    page.get_by_role("button", name="Fold it for me").click()
    panel = page.get_by_role("region", name="Fold it for me")
    cards = panel.get_by_role("group", name="Ways to fold it").get_by_role("button")
    panel.get_by_role("button", name="Suitcase").click()
    expect(cards).to_contain_text("Not planned yet")
    assert asked[-1]["untried"] > 0
    panel.get_by_role("button", name="Drawer").click()
    expect(cards).to_contain_text(size(60, 20))
    assert (asked[-1]["to"], asked[-1]["garment"]["folds"]) == ("drawer", [])
    sheet.edit(lambda drawing: drawing["outline"][1].update(point=[0.7, 0.0]))
    expect(cards).to_contain_text(size(70, 20))
    sheet.edit(lambda drawing: drawing["outline"][1].update(point=[0.6, 0.0]))
    expect(cards).to_contain_text(size(60, 20))
    panel.get_by_role("button", name="Keep the folds").click()
    expect(cards).to_have_count(1)
    like = panel.get_by_role("combobox", name="Fold it like another garment")
    like.select_option(label="Bath mat")
    expect(cards).to_contain_text(size(60, 40))
    expect(cards).not_to_contain_text("loose grips")
    assert asked[-1]["to"] == {"like": mat.state["garment"]}
    like.select_option(label="Tie")
    expect(like).to_have_class(re.compile("is-chosen"))
    expect(cards).to_contain_text(size(60, 30))
    expect(cards).to_contain_text("loose grips")
    assert asked[-1]["to"] == {"like": "tie"}
    panel.get_by_role("button", name="Thirds").click()
    expect(panel.get_by_role("status")).to_contain_text("PR2 cannot do the one way that was tried; ")
    expect(cards).to_contain_text("No plan found")
    assert (asked[-1]["robot"] == "pr2", "scene" in asked[-1], "placement" in asked[-1]) == (False, False, False)
    panel.get_by_role("button", name="Drawer").click()
    expect(like).to_have_value("")
    Hand(page).drag((0.4, 0.2), (0.35, 0.2))
    expect(page.get_by_role("status").filter(has_text=size(10, 25))).to_be_visible()
    expect(cards).to_have_count(1)
    expect(cards).to_have_attribute("data-status", "solved")
    assert (asked[-1]["to"], len(asked[-1]["garment"]["folds"])) == ({"width_m": 0.1, "length_m": 0.25}, 1)
    page.keyboard.press("Escape")
    expect(panel).to_be_hidden()


def test_the_page_has_the_sizes_of_the_server(page: Page, new_sheet: NewSheet) -> None:
    page.goto(new_sheet(TOWEL).page_url)
    names = ["PRESETS", "SIZES_M", "HUNG", "SHARES", "SIDES_M", "TOLERANCE_M"]
    ask = f"import('/static/js/proposals/target.js').then((m) => {json.dumps(names)}.map((name) => m[name]))"
    presets, sizes, hung, shares, sides, tolerance = page.evaluate(ask)
    assert presets == list(PRESETS)
    known = {name: [target.width, target.length] for name, target in PRESETS.items() if target.width}
    assert {**sizes, **hung, **shares} == known
    assert set(hung) == {name for name, target in PRESETS.items() if target.is_hung}
    assert set(shares) == {name for name, target in PRESETS.items() if target.is_share}
    assert (sides, tolerance) == ([SIDE_MIN_M, SIDE_MAX_M], TOLERANCE_M)
