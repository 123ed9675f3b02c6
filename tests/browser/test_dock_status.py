"""The status pill, and the page while a plan is awaited."""

import json
import re
from collections.abc import Callable

import pytest
from playwright.sync_api import BrowserContext, Page, WebSocketRoute, expect

from tests.app.conftest import Served
from tests.browser.board_window import DRAWN
from tests.browser.conftest import Garment, Sheet
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned
from tests.patience import wait_until

WAITING = """async (millis) => {
  const { Planning } = await import("/static/js/dock/planning.js");
  const known = { isLive: true, state: { version: 2 }, plan: { status: "solved", version: 1 } };
  const store = Object.assign(new EventTarget(), known);
  const planning = new Planning(store);
  store.dispatchEvent(new Event("document"));
  await new Promise((resolve) => setTimeout(resolve, millis));
  const waited = planning.wait;
  store.plan = { status: "solved", version: 2 };
  store.dispatchEvent(new Event("plan"));
  return [waited, planning.wait];
}"""


@pytest.mark.parametrize(("millis", "wait"), [(20, "short"), (400, "noticed"), (1200, "long")])
def test_planning_shows_only_when_it_takes_long(modules: Page, millis: int, wait: str) -> None:
    assert modules.evaluate(WAITING, millis) == [wait, ""]


REFINING = """async (ids) => {
  const { Refining } = await import("/static/js/dock/planning.js");
  const store = Object.assign(new EventTarget(), { isLive: true, state: { version: 2 } });
  const refining = new Refining(store);
  const tell = (id, isFinal) => {
    store.plan = { status: "solved", plan: { id, version: 2, is_final: isFinal } };
    store.dispatchEvent(new Event("plan"));
  };
  for (const id of ids) {
    tell(id, false);
    await new Promise((resolve) => setTimeout(resolve, 500));
  }
  const waited = refining.isLong;
  tell(ids.at(-1), true);
  return [waited, refining.isLong];
}"""


@pytest.mark.parametrize(("ids", "is_told"), [("a", False), ("aaa", True), ("abc", False)])
def test_that_a_quicker_plan_is_looked_for_is_told_once_a_plan_has_stayed_for_a_second(
    modules: Page, ids: str, is_told: bool
) -> None:
    assert modules.evaluate(REFINING, list(ids)) == [is_told, False]


def test_while_a_quicker_plan_is_looked_for_the_one_on_show_can_be_kept(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    page.route_web_socket("**/live", still_looking)
    page.goto(new_sheet(napkin()).page_url)
    status, numbers = page.get_by_role("status"), page.get_by_role("region", name="Numbers")
    expect(numbers).to_contain_text("Looking for a quicker plan")
    expect(status).to_have_text(re.compile(r"^Planned: \d steps, [\d.]+ s$"))
    keep = page.get_by_role("button", name="Stop")
    expect(keep).to_have_attribute("title", "Keep this plan")
    before = status.inner_text()
    keep.click()
    expect(numbers).not_to_contain_text("Looking for a quicker plan")
    expect(keep).to_be_hidden()
    assert status.inner_text() == before


def test_what_was_stopped_can_be_planned_again(page: Page, new_sheet: Callable[[Garment], Sheet]) -> None:
    page.route_web_socket("**/live", stopped)
    page.goto(new_sheet(napkin()).page_url)
    expect(page.get_by_role("status")).to_have_text("No plan: Planning was stopped")
    again = page.get_by_role("button", name="Plan again")
    again.click()
    expect_planned(page)
    expect(again).to_be_hidden()


def stopped(page: WebSocketRoute) -> None:
    """Fake a server that has been told to stop, until it is told to plan again."""
    server = page.connect_to_server()
    kept: list[str | bytes] = []
    is_again = False

    def tell(text: str | bytes) -> None:
        message = json.loads(text)
        if message["kind"] == "plan" and not is_again:
            kept[:] = [text]
            message |= {"status": "failed", "text": "No plan: planning was stopped", "plan": None}
        page.send(json.dumps(message))

    def hear(text: str | bytes) -> None:
        nonlocal is_again
        if json.loads(text) == {"do": "plan"}:
            is_again = True
            page.send(kept[0])
        else:
            server.send(text)

    server.on_message(tell)
    page.on_message(hear)


def test_where_a_quicker_plan_may_exist_that_is_told_with_what_any_takes(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    page.route_web_socket("**/live", out_of_time)
    # It lies where joints take no longer than the cost model says: in the end it is known that nothing is quicker.
    proven = napkin(placement={"x_m": -0.6, "y_m": -0.2, "yaw_rad": 0.0})
    page.goto(new_sheet(proven).page_url)
    numbers = page.get_by_role("region", name="Numbers")
    expect(numbers).to_contain_text("A faster plan may exist; lower bound 6.5 s.")
    expect(numbers).to_contain_text("1,234 candidates examined.")
    longer = numbers.get_by_role("button", name="Look longer")
    longer.click()
    expect(longer).to_be_hidden()
    expect(numbers).not_to_contain_text("A faster plan may exist")


def out_of_time(page: WebSocketRoute) -> None:
    """Fake a server that knows only that any plan takes 6.5 s or more, until it looks longer."""
    server = page.connect_to_server()
    last: list[str | bytes] = []

    def tell(text: str | bytes) -> None:
        message = json.loads(text)
        if message["kind"] == "plan" and message["plan"] is not None:
            last[:] = [text]
            message["plan"]["at_least_s"] = 6.5
            message["plan"]["statistics"]["ways"] = 1234
            message["may_look_longer"] = True
        page.send(json.dumps(message))

    def hear(text: str | bytes) -> None:
        if json.loads(text) == {"do": "look_longer"}:
            page.send(last[0])
        else:
            server.send(text)

    server.on_message(tell)
    page.on_message(hear)


def still_looking(page: WebSocketRoute) -> None:
    """Fake a server that looks for a quicker plan, in vain, until it is told to stop."""
    server = page.connect_to_server()
    last: list[str | bytes] = []

    def tell(text: str | bytes) -> None:
        message = json.loads(text)
        if message["kind"] == "plan" and message["plan"] is not None:
            if not message["plan"]["is_final"]:
                return
            last[:] = [text]
            message["plan"]["is_final"] = False
        page.send(json.dumps(message))

    def hear(text: str | bytes) -> None:
        if json.loads(text) == {"do": "stop"}:
            page.send(last[0])
        else:
            server.send(text)

    server.on_message(tell)
    page.on_message(hear)


def cut_off(page: Page, sheet: Sheet, then: Callable[[WebSocketRoute], None]) -> None:
    """Open a page and cut its connection once it has a plan; connections that it opens later are passed on."""
    sockets = []
    page.route_web_socket("**/live", lambda route: sockets.append((route, route.connect_to_server())))
    page.goto(sheet.page_url)
    expect_planned(page)
    expect(page.get_by_role("button", name="Play")).to_be_enabled()
    page.route_web_socket("**/live", then)
    sockets[0][0].close()
    expect(page.get_by_role("status")).to_have_text("Connection lost, trying again...")


def test_a_document_that_is_not_there_is_told_of(page: Page, designer: Served) -> None:
    page.goto(f"{designer.url}/d/nothing")
    expect(page.get_by_role("status")).to_contain_text("There is no such document")


def test_a_lost_connection_is_told_and_the_player_rests(
    context: BrowserContext, page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    cut_off(page, new_sheet(napkin()), lambda route: route.close())
    expect(page.get_by_role("button", name="Play")).to_be_disabled()
    expect(page.get_by_role("list", name="Plan").get_by_role("listitem")).not_to_have_count(0)


def test_a_connection_that_came_back_is_told_with_what_the_server_says_not_before(
    context: BrowserContext, page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    sheet = new_sheet(napkin())
    held: list[str | bytes] = []
    again: list[WebSocketRoute] = []

    def all_but_the_plan(route: WebSocketRoute) -> None:
        again.append(route)

        def tell(text: str | bytes) -> None:
            (held.append if json.loads(text)["kind"] == "plan" else route.send)(text)

        route.connect_to_server().on_message(tell)

    cut_off(page, sheet, all_but_the_plan)
    status = page.get_by_role("status")
    sheet.edit(lambda drawing: drawing.update(title="Seen again"))
    expect(page).to_have_title("Seen again - Pleat")
    wait_until(lambda: page.evaluate(DRAWN) and held)
    assert status.inner_text() == "Connection lost, trying again..."
    again[-1].send(held[-1])
    expect(status).not_to_contain_text("Connection lost")


def learning(page: WebSocketRoute) -> None:
    """Fake a server that maps a fixed robot's arms before it plans, and is never done."""
    server = page.connect_to_server()

    def tell(text: str | bytes) -> None:
        message = json.loads(text)
        if message["kind"] == "document":
            message["robot"] |= {"base": "fixed", "mounts": [[0.0, 0.3], [0.0, -0.3]]}
        if message["kind"] == "plan":
            message |= {"status": "planning", "prepared": 0.42}
        page.send(json.dumps(message))

    server.on_message(tell)


def test_while_a_robots_arms_are_mapped_that_is_told_and_a_fixed_base_has_no_lane(
    page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    page.route_web_socket("**/live", learning)
    page.goto(new_sheet(napkin()).page_url)
    told = "Building the reach map (first use): 42 %"
    expect(page.get_by_role("status").filter(has_text=told)).to_be_visible()
    expect(page.locator(".lane-name").filter(has_text="Left arm")).to_be_visible()
    expect(page.locator(".lane-name").filter(has_text="Base")).to_be_hidden()


def compiling(page: WebSocketRoute) -> None:
    """Fake a server that compiles the planner before it plans, and is never done."""
    server = page.connect_to_server()

    def tell(text: str | bytes) -> None:
        message = json.loads(text)
        if message["kind"] == "plan":
            message |= {"status": "planning", "is_compiling": True}
        page.send(json.dumps(message))

    server.on_message(tell)


def test_while_the_planner_is_compiled_that_is_told(page: Page, new_sheet: Callable[[Garment], Sheet]) -> None:
    page.route_web_socket("**/live", compiling)
    page.goto(new_sheet(napkin()).page_url)
    expect(page.get_by_role("status").filter(has_text="Compiling the planner (first use)")).to_be_visible()


TOLD = """async (reasons) => {
  const { reasonWithPlace } = await import("/static/js/board/draw_reason.js");
  const { toldReason } = await import("/static/js/messages/reasons.js");
  const plan = { reasons, is_stale: false };
  return [toldReason(reasons)?.short_by_m, reasonWithPlace({ plan: { plan, status: "infeasible" } })?.short_by_m];
}"""


@pytest.mark.parametrize(("first", "shown"), [([0.3, 0.1, 0.8], 0.412), (None, None)])
def test_the_board_shows_the_shortfall_of_the_reason_that_the_status_tells(
    modules: Page, first: list[float] | None, shown: float | None
) -> None:
    reasons = [
        {"message": "out of reach", "point": first, "short_by_m": 0.412},
        {"message": "out of reach", "point": [0.2, 0.0, 0.8], "short_by_m": 0.1},
    ]
    assert modules.evaluate(TOLD, reasons) == [0.412, shown]
