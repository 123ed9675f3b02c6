"""The Fold-DAG as a graph."""

import re
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from tests.browser.conftest import Garment, Sheet, windows
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned

LAID = """async ([count, edges]) => {
  const { columns, wayOf } = await import("page/dock/dag_layout.js");
  const laid = columns(count, edges);
  const own = laid.map((column) => column.filter(({ to }) => to < 0).map(({ fold }) => fold));
  const ways = edges.map(([from, to]) => wayOf(laid, from, to).map(({ depth, row }) => [depth, row]));
  return { own, ways };
}"""


@pytest.fixture(scope="module")
def planned(chromium: Browser, new_sheet: Callable[[Garment], Sheet]) -> Iterator[Page]:
    """Open the page with a plan and its graph."""
    with windows(chromium) as context:
        page = context.new_page()
        page.goto(new_sheet(napkin()).page_url)
        expect_planned(page)
        yield page


@pytest.fixture
def page(planned: Page) -> Page:
    """Return the page at the beginning of the plan."""
    planned.get_by_role("slider", name="Time").press("Home")
    return planned


@pytest.fixture
def graph(page: Page) -> Iterator[Locator]:
    page.get_by_role("button", exact=True, name="Order", pressed=False).click()
    yield page.get_by_role("group", name="Fold-DAG")
    page.get_by_role("button", exact=True, name="Order", pressed=True).click()


def node(graph: Locator, name: str) -> Locator:
    return graph.get_by_role("button", name=re.compile(f"^{name},"))


def test_the_graph_shows_what_is_done_available_and_waiting(page: Page, graph: Locator) -> None:
    expect(graph).to_have_accessible_name("Fold-DAG of 3 in 2 steps")
    expect(node(graph, "left")).to_have_accessible_name("left, Blue, can be folded, before half")
    expect(node(graph, "right")).to_have_attribute("data-state", "available")
    expect(graph.locator("[data-state=waiting]")).to_have_accessible_name("half, Blue, waits, after left and right")
    page.get_by_role("button", name="Next step").click()
    page.get_by_role("button", name="Next step").click()
    expect(graph.locator("[data-state=done]")).to_have_accessible_name("left, Blue, done, before half")
    page.get_by_role("slider", name="Time").press("End")
    expect(graph.locator("[data-state=done]")).to_have_count(3)
    expect(graph.locator(".dag-edge.is-done")).to_have_count(2)


def test_pointing_at_a_fold_lights_up_its_neighbours(page: Page, graph: Locator) -> None:
    node(graph, "left").hover()
    expect(graph.locator(".dag-node.is-near")).to_have_count(2)
    expect(graph.locator(".dag-edge.is-near")).to_have_count(1)


def test_a_fold_is_selected_in_graph_and_list_at_once(page: Page, graph: Locator) -> None:
    node(graph, "right").press("Enter")
    expect(node(graph, "right")).to_have_attribute("aria-pressed", "true")
    page.get_by_role("button", exact=True, name="Order").click()
    expect(page.get_by_role("list", name="Folds").locator(".is-selected .fold-name")).to_have_text(["right"])
    page.get_by_role("button", exact=True, name="Order").click()


def test_a_graph_that_was_shown_before_knows_of_folds_that_have_gone(page: Page) -> None:
    toggle = page.get_by_role("button", exact=True, name="Order")
    toggle.click()
    toggle.click()
    folds = page.get_by_role("list", name="Folds").locator(".fold-name")
    folds.last.click()
    page.keyboard.press("Delete")
    expect(folds).to_have_count(2)
    toggle.click()
    expect(page.get_by_role("group", name="Fold-DAG")).to_have_accessible_name("Fold-DAG of 2 in 1 steps")
    toggle.click()
    page.keyboard.press("Control+z")
    expect(folds).to_have_count(3)
    expect_planned(page)


def test_folds_stand_in_columns_by_depth_and_edges_keep_clear_of_them(page: Page) -> None:
    # 0 -> 1 -> 2 -> 4 and 3 -> 4: the edge from 3 passes two columns by, under what stands there.
    laid = page.evaluate(LAID, [5, [[0, 1], [1, 2], [2, 4], [3, 4]]])
    assert laid["own"] == [[0, 3], [1], [2], [4]]
    assert laid["ways"][3] == [[0, 0.5], [1, 0.5], [2, 0.5], [3, 0]]
    assert laid["ways"][0] == [[0, -0.5], [1, -0.5]]
