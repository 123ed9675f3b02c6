"""The status pill, and how waiting for a plan shows."""

from collections.abc import Callable

import pytest
from playwright.sync_api import BrowserContext, Page, expect

from tests.app.conftest import Served
from tests.browser.conftest import Garment, Sheet
from tests.browser.napkin import napkin

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
def test_planning_shows_only_when_it_takes_long(page: Page, designer: Served, millis: int, wait: str) -> None:
    page.goto(f"{designer.url}/static/icon.svg")
    assert page.evaluate(WAITING, millis) == [wait, ""]


def test_a_lost_connection_is_told_and_the_player_rests(
    context: BrowserContext, page: Page, new_sheet: Callable[[Garment], Sheet]
) -> None:
    sheet = new_sheet(napkin())
    sockets = []
    page.route_web_socket("**/live", lambda route: sockets.append((route, route.connect_to_server())))
    page.goto(sheet.page_url)
    expect(page.get_by_role("status")).to_contain_text("Planned: ")
    expect(page.get_by_role("button", name="Play")).to_be_enabled()
    page.route_web_socket("**/live", lambda route: route.close())
    sockets[0][0].close()
    expect(page.get_by_role("status")).to_have_text("Connection lost, trying again...")
    expect(page.get_by_role("button", name="Play")).to_be_disabled()
    expect(page.get_by_role("list", name="Plan").get_by_role("listitem")).not_to_have_count(0)
