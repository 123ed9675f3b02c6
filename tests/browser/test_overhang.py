"""Cloth that would not stay on the table: its message and its picture."""

import pytest
from playwright.sync_api import Page, expect

from tests.app.samples import towel
from tests.browser.board.conftest import desk as desk
from tests.browser.board.conftest import page as page
from tests.browser.board_desk import Desk
from tests.browser.status_pill import expect_planned


def lay_at(desk: Desk, x_m: float, y_m: float) -> None:
    """Lay a towel from a place of the table 0.4 m on and 0.3 m left; the table ends at 0.8 m and at 0.49 m."""
    desk.lay(towel(placement={"x_m": x_m, "y_m": y_m, "yaw_rad": 0.0}))


@pytest.mark.parametrize(
    ("place", "said", "by", "lines"),
    [
        # 0.3 m of towel from 0.38 m on: 0.19 m of it are beyond the left edge, more than half.
        ((-0.5, 0.38), "The cloth would slip off the table", "19 cm over the edge", 1),
        # All of it is beyond the left edge, its near side 0.11 m.
        ((-0.5, 0.6), "The cloth lies 11 cm beside the table.", "11 cm beside the table", 0),
    ],
)
def test_cloth_over_the_edge_is_a_sentence_and_a_picture(
    page: Page, desk: Desk, place: tuple[float, float], said: str, by: str, lines: int
) -> None:
    lay_at(desk, *place)
    expect(page.locator(".reason")).to_contain_text(said)
    expect(page.locator(".overhang")).to_have_count(1)
    expect(page.locator(".problem-line")).to_have_count(lines)
    expect(page.locator(".problem-cross")).to_have_count(1)
    expect(page.locator(".reason-text")).to_have_text(by)


def test_cloth_that_is_brought_back_from_the_edge_is_marked_no_more_until_that_is_undone(
    page: Page, desk: Desk
) -> None:
    lay_at(desk, -0.5, 0.38)
    expect(page.locator(".overhang")).to_have_count(1)
    desk.edit(lambda drawing: drawing["placement"].update(y_m=-0.15))
    expect_planned(page, desk.state["version"])
    expect(page.locator(".overhang, .problem-cross")).to_have_count(0)
    page.get_by_role("button", name="Undo").click()
    expect(page.locator(".overhang")).to_have_count(1)


def test_a_corner_of_the_table_under_the_cloth_is_marked_with_both_edges(page: Page, desk: Desk) -> None:
    lay_at(desk, 0.7, 0.39)
    expect(page.locator(".reason")).to_have_text("The cloth hangs over two edges of the table at a corner.")
    # What hangs over each edge is hatched, and what hangs over both is in both.
    expect(page.locator(".overhang")).to_have_count(2)
    expect(page.locator(".problem-line")).to_have_count(2)
    expect(page.locator(".problem-cross")).to_have_count(1)


def test_what_hangs_loose_is_said_in_the_unit_of_the_page(modules: Page) -> None:
    told = modules.evaluate(
        """async () => {
          const { sentence } = await import("/static/js/dock/reasons.js");
          const what = { code: "hangs_loose", layer: 0, edge: "far", at: [0.61, 0.57], beyond_m: 0.177 };
          const reason = { fold: null, code: "not_a_g_state", says: { code: "at_start", what, is_too_large: false } };
          const later = { ...reason, fold: 0, says: { code: "afterwards", what } };
          const off = { code: "afterwards", what: { code: "beside_table", off_m: 0 }, dragged: [-0.2, 0] };
          const folds = [{ name: "half" }];
          return [sentence(reason, []), sentence(later, folds), sentence({ ...later, says: off }, folds)];
        }"""
    )
    assert told == [
        "The cloth hangs 17.7 cm over the table\N{RIGHT SINGLE QUOTATION MARK}s far edge, and nothing holds it there.",
        "Half: afterwards the cloth hangs 17.7 cm over the table\N{RIGHT SINGLE QUOTATION MARK}s far edge, and nothing "
        "holds it there.",
        "Half: afterwards nothing of the cloth lies on the table.",
    ]
