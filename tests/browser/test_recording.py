"""A recording plays from the disk, without any request."""

from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from app.files.recording import recording
from tests.browser.conftest import VIEW_PATIENCE_MS
from tests.replay.planned import shipped_plan

MESHES = """() => {
  const robot = window.__viserMutable?.nodeRefFromName["/robot"];
  let meshes = 0;
  robot?.traverse((part) => { meshes += part.isMesh ? 1 : 0; });
  return meshes;
}"""
HAND = """() => {
  const names = Object.keys(window.__viserMutable.nodeRefFromName);
  const hand = window.__viserMutable.nodeRefFromName[names.find((name) => name.endsWith("l_gripper_tool_frame"))];
  hand.updateWorldMatrix(true, false);
  return hand.matrixWorld.elements.slice(12, 15);
}"""

WOVEN = """() => {
  const pattern = [];
  window.__viserMutable.nodeRefFromName["/cloth/front"]?.traverse((part) => {
    if (part.isMesh) pattern.push(part.geometry.attributes.pattern);
  });
  return pattern.length > 0 && pattern.every((places) => places?.count > 0);
}"""


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    path = tmp_path / "hand-towel.html"
    path.write_bytes(recording(shipped_plan("hand-towel"), 5.0, lambda: False, "en", is_dark=False))
    return path


def test_a_recording_plays_from_the_disk_and_asks_for_nothing(saved: Path, browser: Browser) -> None:
    asked: list[str] = []
    faults: list[str] = []
    page = browser.new_page(viewport={"width": 400, "height": 300})
    page.on("request", lambda request: asked.append(request.url))
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.goto(saved.as_uri())
    assert page.title() == "Hand towel - Pleat"
    page.wait_for_function(f"({MESHES})() > 20", timeout=VIEW_PATIENCE_MS)
    page.wait_for_function(WOVEN)
    first = page.evaluate(HAND)
    moved = f"({HAND})().some((value, axis) => Math.abs(value - {first}[axis]) > 0.05)"
    page.wait_for_function(moved, timeout=VIEW_PATIENCE_MS)
    page.close()
    assert faults == []
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []


CAPTIONED = """() => "/caption" in (window.__viserMutable?.nodeRefFromName ?? {})"""
SHOWN = """() => [...document.querySelectorAll("button, input, [role=slider], [role=alert], [class*=Notification]")]
  .filter((part) => part.checkVisibility({ visibilityProperty: true }) && part.clientWidth > 0)
  .map((part) => part.getAttribute("aria-label") ?? part.innerText)"""


def test_a_recording_has_a_title_and_captions_and_only_a_button_and_a_time_line(saved: Path, browser: Browser) -> None:
    page = browser.new_page(viewport={"width": 400, "height": 300})
    page.goto(saved.as_uri())
    expect(page.get_by_role("heading", name="Hand towel")).to_be_in_viewport()
    play = page.get_by_role("button", name="Play or pause")
    expect(play).to_be_in_viewport(timeout=VIEW_PATIENCE_MS)
    page.wait_for_function(CAPTIONED, timeout=VIEW_PATIENCE_MS)
    assert page.evaluate(SHOWN) == ["Play or pause", "Seconds"]
    play.click()
    time = page.get_by_label("Seconds")
    stopped = time.input_value()
    page.locator(".mantine-Slider-track").click()
    expect(time).not_to_have_value(stopped)
    page.close()
