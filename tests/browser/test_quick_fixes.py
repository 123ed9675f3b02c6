"""The button of a quick fix: it removes the problem, and undo brings the problem back."""

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.app.samples import towel
from tests.browser.board.conftest import desk as desk
from tests.browser.board.conftest import page as page
from tests.browser.board_desk import Desk
from tests.browser.status_pill import expect_planned

Change = Callable[[dict[str, Any]], None]


def first_red(drawing: dict[str, Any]) -> None:
    drawing["folds"][0]["kind"] = "red"


def red_beside_the_flap(drawing: dict[str, Any]) -> None:
    corner, miss = ([0.4, 0.1], [0.3, 0.0]), ([0.0, 0.2], [0.2, 0.3])
    ends = [{"start": {"point": start}, "end": {"point": end}} for start, end in (corner, miss)]
    kinds = ({"name": "corner", "kind": "blue"}, {"name": "miss", "kind": "red"})
    drawing["folds"] = [{**kind, **both} for kind, both in zip(kinds, ends, strict=True)]


def end_in_the_cloth(drawing: dict[str, Any]) -> None:
    drawing["folds"][0]["start"] = {"point": [0.3, 0.15]}


def crossing(drawing: dict[str, Any]) -> None:
    first, second = drawing["outline"][:2]
    first["point"], second["point"] = second["point"], first["point"]


def short_edge(drawing: dict[str, Any]) -> None:
    drawing["outline"].insert(1, {"id": "twin", "point": [0.0, 0.0]})


def unknown_station(drawing: dict[str, Any]) -> None:
    drawing["start_station"] = "nowhere"


HALF = "\N{LEFT DOUBLE QUOTATION MARK}half\N{RIGHT DOUBLE QUOTATION MARK}"
MISS = HALF.replace("half", "miss")
WRONG: list[tuple[Change, str]] = [
    (first_red, f"Make {HALF} blue"),
    (red_beside_the_flap, f"Make {MISS} blue"),
    (end_in_the_cloth, f"Put {HALF} onto the cloth"),
    (crossing, "Exchange the two corners"),
    (short_edge, "Merge the two corners"),
    (unknown_station, "Start at front"),
]


def quick_fixes(page: Page) -> Locator:
    return page.get_by_role("group", name="Suggestions").get_by_role("button")


@pytest.mark.parametrize(("spoil", "label"), WRONG, ids=[spoil.__name__ for spoil, _ in WRONG])
def test_what_is_wrong_is_fixed_by_the_first_button(page: Page, desk: Desk, spoil: Change, label: str) -> None:
    desk.lay(towel())
    desk.edit(spoil)
    wrong = desk.state["problems"]
    expect(quick_fixes(page).first).to_have_text(label)
    assert quick_fixes(page).count() <= 3
    quick_fixes(page).first.click()
    expect_planned(page)
    assert desk.state["problems"] == []
    assert desk.can_undo == label
    expect(quick_fixes(page)).to_have_count(0)
    page.get_by_role("button", name="Undo").click()
    expect(quick_fixes(page).first).to_have_text(label)
    assert desk.state["problems"] == wrong
    page.get_by_role("button", name="Redo").click()
    expect_planned(page)
    assert desk.state["problems"] == []


def test_a_quick_fix_under_the_pointer_is_shown_on_the_board(page: Page, desk: Desk) -> None:
    desk.lay(towel())
    desk.edit(end_in_the_cloth)
    quick_fixes(page).filter(has_text="Put ").hover()
    expect(page.locator(".fold.is-preview")).to_have_count(1)
    crosses = page.locator(".problem-cross")
    expect(crosses).to_have_count(1)
    quick_fixes(page).filter(has_text="Delete ").hover()
    expect(page.locator(".fold.is-preview")).to_have_count(0)
    expect(crosses).to_have_count(2)
    page.mouse.move(1, 1)
    expect(crosses).to_have_count(1)
