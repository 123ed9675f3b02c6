"""Whenever a reason names an amount that would do, a card offers it: the same amount, at once, and it gives a plan."""

import json
import re
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, Route, expect

from planner import Scene
from planner.cloth.garment import Garment as Cloth
from tests.browser.conftest import Garment, Sheet
from tests.explain.test_reasons_tried import apron

NewSheet = Callable[[Garment], Sheet]

SCENE = Scene().to_dict()
PLACE = {"x_m": 0.1, "y_m": 0.2, "yaw_rad": 0.0}


def nothing_found(page: Page) -> None:
    """Have the server find nothing that would help."""

    def none(route: Route) -> None:
        done = {"count": 0, "elapsed_s": 1.0, "complete": True}
        route.fulfill(content_type="text/event-stream", body=f"event: done\ndata: {json.dumps(done)}\n\n")

    page.route("**/api/suggestions*", none)


@pytest.mark.long
def test_the_amount_that_a_reason_names_is_offered_and_gives_a_plan(page: Page, new_sheet: NewSheet) -> None:
    nothing_found(page)
    sheet = new_sheet(apron(0.127, 0.127).to_dict())
    page.goto(sheet.page_url)
    reasons = page.get_by_role("list", name="Reasons")
    expect(reasons).to_contain_text("in drags too, would do")
    named = re.search(r"([\d.]+ cm), in drags too, would do", reasons.inner_text())
    assert named is not None
    card = page.get_by_role("group", name="Suggestions").get_by_role("button")
    expect(card).to_contain_text(f"within {named[1]} in")
    card.click()
    expect(page.get_by_role("status").first).to_have_attribute("data-status", "solved")
    assert (sheet.can_undo or "").startswith("Assume that one grip holds")


def named(modules: Page, cloth: Cloth, *reasons: dict[str, Any]) -> list[dict[str, Any]]:
    garment = cloth.to_dict()
    drawing = {"placement": PLACE, "scene": SCENE, "comfort_radius_m": 0.03}
    found: list[dict[str, Any]] = modules.evaluate(
        """async ([reasons, state]) => {
          const { namedChanges } = await import("/static/js/suggestions/named_changes.js");
          return namedChanges({ version: 3, plan: { reasons, is_stale: false } }, { ...state, version: 3 });
        }""",
        [list(reasons), {"drawing": drawing, "garment": garment}],
    )
    return found


def gives_plan(**change: Any) -> dict[str, Any]:
    return {"gives": "plan", "change": change}


def test_each_kind_of_change_has_its_words_and_several_are_assumed_together(modules: Page) -> None:
    cloth = apron(0.127, 0.127)
    (half,) = cloth.to_dict()["folds"]
    wider = gives_plan(garment={**cloth.to_dict(), "folds": [{**half, "grip_radius_m": 0.1968}]})
    moved = gives_plan(placement={**PLACE, "x_m": 0.15})
    rougher = gives_plan(scene={**SCENE, "friction": 1.504})
    nearer = gives_plan(comfort_radius_m=0.01)
    found = named(modules, cloth, wider, moved, rougher, nearer)
    assert [one["kind"] for one in found] == ["grip_radius", "placement", "friction", "comfort_radius"]
    assert [one["is_assumption"] for one in found] == [True, False, True, True]
    grip, place, friction, comfort = (one["says"] for one in found)
    assert (grip["grip_radius_m"], grip["folds"]) == (pytest.approx(0.197), [0])
    assert place["by"] == pytest.approx([0.05, 0.0])
    assert (friction["friction"], friction["now"]) == (pytest.approx(1.51), 1.0)
    assert (comfort["comfort_m"], comfort["now_m"]) == (0.01, 0.03)
    (both,) = named(modules, cloth, gives_plan(**rougher["change"], **nearer["change"]))
    assert (both["kind"], [part["code"] for part in both["says"]["parts"]]) == (
        "together",
        ["assume_friction", "assume_comfort"],
    )


def test_what_gives_no_plan_or_has_no_words_is_not_offered_and_of_a_kind_the_least_is(modules: Page) -> None:
    cloth = apron(0.127, 0.127)
    table = {**SCENE, "table": {**SCENE["table"], "height_m": 0.5}}
    for reason in (
        {"gives": "fold", "change": {"comfort_radius_m": 0.0}},
        {"gives": "plan", "change": None},
        gives_plan(scene=table),
        gives_plan(robot="other"),
    ):
        assert named(modules, cloth, reason) == []
    (least,) = named(modules, cloth, gives_plan(comfort_radius_m=0.0), gives_plan(comfort_radius_m=0.02))
    assert least["change"] == {"comfort_radius_m": 0.02}
