"""The page in a real browser. The 3D view is tested through the page's own scene, not through pixels."""

from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.app.conftest import Served
from tests.browser.conftest import IN_VIEW, REST, Sheet
from tests.browser.status_pill import expect_planned
from tests.browser.view_hand import CAMERA, corner_in_picture, drag, look_from_above
from tests.patience import wait_until
from tests.required import required

NODE = """(name) => {
  const view = document.getElementById("view3d").contentWindow;
  const node = view.__viserMutable?.nodeRefFromName[name];
  if (!node) return null;
  let low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9], meshes = 0;
  node.updateWorldMatrix(true, true);
  node.traverse((part) => {
    const places = part.isMesh && part.geometry?.attributes?.position;
    if (!places) return;
    meshes += 1;
    const point = part.position.clone();
    for (let i = 0; i < places.count; i += 1) {
      point.fromBufferAttribute(places, i).applyMatrix4(part.matrixWorld);
      low = low.map((value, axis) => Math.min(value, point.getComponent(axis)));
      high = high.map((value, axis) => Math.max(value, point.getComponent(axis)));
    }
  });
  const place = node.position.clone().applyMatrix4(node.parent.matrixWorld);
  return { meshes, size: high.map((value, axis) => value - low[axis]), place: place.toArray() };
}"""
WOVEN = """() => {
  const view = document.getElementById("view3d").contentWindow;
  const meshes = [];
  for (const face of ["front", "back"])
    view.__viserMutable.nodeRefFromName[`/cloth/${face}`].traverse((part) => part.isMesh && meshes.push(part));
  const { programs } = view.__viserTestpoints.rendererInfo;
  const drawn = programs.filter(({ cacheKey }) => cacheKey.includes("function weave("));
  const lent = meshes.map(({ geometry: { attributes } }) => [attributes.pattern?.count, attributes.position.count]);
  return drawn.length > 0 && drawn.every((one) => !one.diagnostics) && lent.every(([one, other]) => one === other);
}"""
"""Whether threads are drawn on both faces, and all of their corners have places in the pattern."""
RENDERED = """() => {
  const view = document.getElementById("view3d").contentWindow;
  return view.__viserTestpoints?.rendererInfo.render.triangles > 20000;
}"""


@pytest.fixture
def page(view_page: Page, designer: Served) -> Page:
    """Return the page with the T-shirt at rest, spread out."""
    view_page.set_viewport_size({"width": 900, "height": 500})
    document = f"{designer.url}/api/documents/{view_page.url.rpartition('/')[2]}"
    REST.put(f"{document}/garment", json={"garment": "t-shirt"}).raise_for_status()
    for command in ({"do": "pause"}, {"do": "seek", "t_s": 0.0}):
        REST.post(f"{document}/playback", json=command).raise_for_status()
    expect(view_page.locator("#time")).to_have_js_property("value", "0")
    expect_planned(view_page)
    until_there(view_page, "/cloth/front")
    until_there(view_page, "/robot")
    return view_page


def node(page: Page, name: str) -> dict[str, Any]:
    found: dict[str, Any] = page.evaluate(NODE, name)
    return found


def until_there(page: Page, name: str) -> None:
    page.wait_for_function(f"({NODE})({name!r})?.meshes > 0")


def scrub(page: Page, t_s: float) -> None:
    page.get_by_role("slider", name="Time").evaluate(
        "(slider, t) => { slider.value = t; slider.dispatchEvent(new Event('input', {bubbles: true})) }", t_s
    )


def duration_s(page: Page) -> float:
    return float(page.get_by_role("slider", name="Time").get_attribute("max") or 0.0)


def cloth_area(page: Page) -> float:
    """Return the area of the cloth's bounding box as seen from above (m2); y is up in the browser."""
    width, _, depth = node(page, "/cloth/front")["size"]
    return float(width * depth)


def test_robot_cloth_and_table_are_rendered(page: Page) -> None:
    assert node(page, "/robot")["meshes"] >= 30
    assert node(page, "/robot")["size"][1] > 1.0
    assert node(page, "/table")["meshes"] >= 1
    page.wait_for_function(RENDERED)


def test_the_picture_over_the_3d_view_goes_once_it_can_be_looked_at_and_no_panel_of_viser_is_seen(page: Page) -> None:
    expect(page.locator(".view3d-cover")).to_be_hidden()
    expect(page.get_by_role("toolbar", name="Look from")).to_be_visible()
    view = page.frame_locator("#view3d")
    expect(view.locator("canvas").first).to_be_visible()
    assert view.locator("button, input").count() > 0  # it is there, with the choice of viewpoints, and hidden
    expect(view.locator("button, input").locator("visible=true")).to_have_count(0)


def test_viewpoints_in_the_3d_view_move_its_camera(page: Page) -> None:
    """Viser's y is up."""
    height = f"{IN_VIEW}.camera.position.y"
    before = page.evaluate(height)
    page.get_by_role("button", name="Top", exact=True).click()
    page.wait_for_function(f"Math.hypot({IN_VIEW}.camera.position.x, {IN_VIEW}.camera.position.z) < 0.05")
    page.get_by_role("button", name="Free", exact=True).click()
    page.wait_for_function(f"Math.abs({height} - {before}) < 0.01")


def test_the_server_knows_that_the_processor_draws_the_3d_view(page: Page) -> None:
    # As it does in these tests, see the browser's flags.
    assert required(page.locator("#view3d").get_attribute("src")).endswith("/by-software/")


def test_the_page_names_garment_folds_and_plan(page: Page) -> None:
    expect(page.get_by_role("combobox", name="Garment").locator("option:checked")).to_have_text("T-shirt")
    expect(page.get_by_role("list", name="Folds").get_by_role("listitem")).to_have_count(5)
    expect(page.get_by_role("list", name="Plan").get_by_role("listitem")).not_to_have_count(0)
    expect(page.locator(".block")).not_to_have_count(0)


def test_playing_moves_the_robot_and_the_clock(page: Page) -> None:
    scrub(page, 0.0)
    elbow = "/robot/base_footprint/base_link/torso_lift_link/l_shoulder_pan_link/l_shoulder_lift_link"
    wait_until(lambda: page.get_by_role("slider", name="Time").input_value() == "0")
    before = node(page, elbow)["place"]
    page.get_by_role("button", name="Play").click()
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    wait_until(lambda: node(page, elbow)["place"] != before)
    page.wait_for_function("Number(document.getElementById('time').value) > 0.5")
    page.get_by_role("button", name="Pause").click()
    expect(page.get_by_role("button", name="Play")).to_be_visible()


def test_scrubbing_to_the_end_shows_the_folded_cloth(page: Page) -> None:
    scrub(page, 0.0)
    wait_until(lambda: cloth_area(page) > 0.35)
    spread_out = cloth_area(page)
    scrub(page, duration_s(page))
    wait_until(lambda: cloth_area(page) < 0.35 * spread_out)
    assert node(page, "/cloth/front")["size"][1] < 0.1
    page.wait_for_function(WOVEN)
    slider = page.get_by_role("slider", name="Time")
    expect(slider).to_have_attribute("aria-valuetext", f"{duration_s(page):.1f} s")
    expect(page.get_by_role("list", name="Folds").locator("[data-state=done]")).to_have_count(5)


def test_the_space_bar_plays_and_arrows_step(page: Page) -> None:
    scrub(page, 1.0)
    wait_until(lambda: page.get_by_role("slider", name="Time").input_value() == "1")
    page.get_by_role("slider", name="Time").focus()
    page.keyboard.press("ArrowRight")
    wait_until(lambda: page.get_by_role("slider", name="Time").input_value() == "1.5")
    page.keyboard.press(" ")
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    page.keyboard.press(" ")
    expect(page.get_by_role("button", name="Play")).to_be_visible()


def test_the_3d_view_takes_on_the_pages_theme_and_its_ground(page: Page) -> None:
    grounds = """() => [document, document.getElementById("view3d").contentDocument].map(
      ({ body, defaultView }) => defaultView.getComputedStyle(body).backgroundColor)"""
    dark, light = ["rgb(22, 24, 28)"] * 2, ["rgb(250, 250, 248)"] * 2
    wait_until(lambda: page.evaluate(grounds) == light)
    page.get_by_role("button", name="Dark").click()
    wait_until(lambda: page.evaluate(grounds) == dark)
    page.get_by_role("button", name="Light").click()
    wait_until(lambda: page.evaluate(grounds) == light)


@pytest.mark.long
def test_page_and_3d_view_come_back_by_themselves_when_the_server_does(page: Page, designer: Served) -> None:
    page.evaluate("document.getElementById('view3d').contentWindow.isOfBefore = true")
    designer.stop()
    expect(page.get_by_role("status")).to_contain_text("Connection lost")
    designer.start_again()
    expect_planned(page)
    page.wait_for_function("!document.getElementById('view3d').contentWindow.isOfBefore")
    until_there(page, "/cloth/front")


def test_a_corner_is_dragged_from_above_and_undone_and_the_camera_stays(page: Page, designer: Served) -> None:
    sheet = Sheet(designer.url, page.url.rpartition("/")[2])
    before = sheet.drawing
    above = look_from_above(page)
    x, y = corner_in_picture(page, sheet, 0)
    page.mouse.move(x, y)
    overlay = page.locator(".view3d-surface")
    expect(overlay).to_be_visible()
    drag(page, (x, y), (x + 20, y - 12))
    wait_until(lambda: sheet.state["gesture"] == "Move vertex")
    page.mouse.up()
    wait_until(lambda: sheet.state["gesture"] is None)
    assert sheet.can_undo == "Move vertex"
    u, v = corner_in_picture(page, sheet, 0)
    assert (u, v) == pytest.approx((x + 20, y - 12), abs=3.0)  # as near as the board's snapping lets it come
    assert [c["point"] for c in sheet.drawing["outline"][1:]] == [c["point"] for c in before["outline"][1:]]
    assert page.evaluate(CAMERA) == above

    page.keyboard.press("Control+z")
    wait_until(lambda: sheet.drawing == before)
    page.locator("#drafting-board").hover()
    expect(overlay).to_be_hidden()


def test_where_there_is_nothing_to_take_the_pointer_turns_the_camera(page: Page, designer: Served) -> None:
    sheet = Sheet(designer.url, page.url.rpartition("/")[2])
    before, above = sheet.drawing, look_from_above(page)
    x, y = corner_in_picture(page, sheet, 0)
    drag(page, (x + 40, y - 40), (x + 90, y - 80))  # on the cloth, with the tool that selects
    page.mouse.up()
    wait_until(lambda: page.evaluate(CAMERA) != above)
    assert sheet.drawing == before
