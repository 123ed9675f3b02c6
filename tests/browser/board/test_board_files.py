"""Garments from templates and files, and exports; dialogs say what is wrong."""

import io
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from ezdxf import filemanagement
from playwright.sync_api import FilePayload, Page, expect

from app.files.exports import EXPORTS
from planner import Task
from planner.cloth.garment import Garment
from tests.app.samples import towel
from tests.browser.board_desk import Desk, expect_step
from tests.browser.board_hand import Hand
from tests.browser.conftest import REST, Sheet
from tests.browser.conftest import Garment as GarmentGiven
from tests.browser.napkin import napkin
from tests.browser.status_pill import expect_planned
from tests.small_plan import unsolved

SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="400mm" height="300mm" viewBox="0 0 400 300">
  <path d="M0 0H400V300H0Z" fill="none" stroke="black"/>
  <line x1="100" y1="300" x2="100" y2="0" stroke="blue"/>
</svg>"""


def choose_file(page: Page, name: str, content: str) -> None:
    page.get_by_role("button", name="Import", exact=True).click()
    file = FilePayload(name=name, mimeType="application/octet-stream", buffer=content.encode())
    page.get_by_label("File", exact=True).set_input_files([file])


def test_a_template_with_other_measures_becomes_a_new_document(page: Page, cloth: Desk) -> None:
    page.get_by_role("button", name="New", exact=True).click()
    dialog = page.get_by_role("dialog", name="New garment")
    dialog.get_by_role("option", name="Towel").click()
    fields = dialog.locator(".measure .field")
    fields.nth(0).fill("20in")
    dialog.get_by_role("button", name="Create").click()
    page.wait_for_url(lambda url: url != cloth.page_url)
    expect(page.get_by_role("combobox", name="Garment").locator("option:checked")).to_have_text("Towel")
    expect(page.locator(".corner")).to_have_count(4)
    found = Sheet(page.url.partition("/d/")[0], page.url.rpartition("/")[2])
    sides = [abs(corner["point"][0]) for corner in found.drawing["outline"]]
    assert max(sides) - min(sides) == pytest.approx(20 * 0.0254, abs=1e-9)
    assert cloth.can_undo == "Begin"


def test_a_measure_out_of_range_is_refused_in_words(page: Page, cloth: Desk) -> None:
    page.get_by_role("button", name="New", exact=True).click()
    dialog = page.get_by_role("dialog", name="New garment")
    dialog.locator(".measure .field").nth(0).fill("11 m")
    expect(dialog.get_by_role("alert")).not_to_be_empty()
    page.keyboard.press("Escape")
    expect(dialog).to_have_count(0)


@pytest.mark.long
def test_a_towel_wider_than_the_table_is_made_and_explained_on_the_board(page: Page, cloth: Desk) -> None:
    page.get_by_role("button", name="New", exact=True).click()
    dialog = page.get_by_role("dialog", name="New garment")
    dialog.get_by_role("option", name="Towel").click()
    dialog.locator(".measure .field").first.fill("150")
    folded = dialog.locator(".measure .field").nth(2)
    expect(folded).to_have_value("65.2")  # 150 / 68.6 of the 29.8 that it is at first
    folded.fill("30")
    expect(dialog.get_by_role("alert")).to_have_text(
        "Folded width (30 cm) must be at least a third of the width, or the sides would stick out (50 cm)"
    )
    folded.fill("70")
    dialog.get_by_role("button", name="Create").click()
    page.wait_for_url(lambda url: url != cloth.page_url)
    expect(page.get_by_role("status")).to_have_attribute("data-status", "infeasible")
    expect(page.locator(".reason")).not_to_be_empty()


def test_templates_are_gone_through_with_the_keys(page: Page, cloth: Desk) -> None:
    page.get_by_role("button", name="New", exact=True).click()
    options = page.get_by_role("listbox", name="Templates").get_by_role("option")
    expect(options.first).to_be_focused()
    page.keyboard.press("End")
    expect(options.last).to_be_focused()
    expect(options.last).to_have_attribute("aria-selected", "true")
    expect(page.get_by_role("button", name="Start drawing")).to_be_visible()
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("Home")
    expect(options.first).to_be_focused()
    expect(page.get_by_role("listbox").locator("[aria-selected=true]")).to_have_count(1)
    page.keyboard.press("Escape")


def test_without_the_server_the_dialog_says_why_there_are_no_templates(page: Page, cloth: Desk) -> None:
    page.route("**/api/templates", lambda route: route.abort())
    page.get_by_role("button", name="New", exact=True).click()
    expect(page.get_by_role("dialog", name="New garment").locator(".dialog-problem")).to_contain_text("server")
    page.keyboard.press("Escape")
    page.unroute("**/api/templates")


def test_the_blank_board_is_one_of_the_templates(page: Page, cloth: Desk) -> None:
    page.get_by_role("button", name="New", exact=True).click()
    page.get_by_role("option", name="Blank board").click()
    page.get_by_role("button", name="Start drawing").click()
    page.wait_for_url(lambda url: url != cloth.page_url)
    expect(page.get_by_role("button", name="Draw outline", exact=True)).to_have_attribute("aria-pressed", "true")
    expect(page.locator(".hint-line")).to_have_text("Click the corners one after the other; close at the first one.")
    hand = Hand(page)
    for corner in [(0.0, 0.0), (0.4, 0.0), (0.4, 0.3), (0.0, 0.0)]:
        hand.click(corner)
    expect(page.locator(".corner")).to_have_count(3)
    expect(page.get_by_role("status")).to_have_text("No folds yet: draw the first one")
    assert "#" not in page.url


def test_an_svg_is_imported_as_one_step_and_undone(page: Page, cloth: Desk) -> None:
    choose_file(page, "square.svg", SVG)
    page.get_by_role("button", name="Open here").click()
    expect(page.locator(".corner")).to_have_count(4)
    expect(page.get_by_role("button", name="Undo")).to_have_attribute("title", "Undo: Import square.svg (Ctrl+Z)")
    # 400 x 300 mm; the line runs from the lower edge up, 100 mm from the left, so what is left of it moves.
    drawing = cloth.drawing
    xs = [corner["point"][0] for corner in drawing["outline"]]
    ys = [corner["point"][1] for corner in drawing["outline"]]
    assert (max(xs) - min(xs), max(ys) - min(ys)) == pytest.approx((0.4, 0.3), abs=1e-9)
    (fold,) = drawing["folds"]
    assert fold["kind"] == "blue"
    assert fold["start"]["point"][0] - min(xs) == pytest.approx(0.1, abs=1e-9)
    assert fold["end"]["point"][1] - fold["start"]["point"][1] == pytest.approx(0.3, abs=1e-9)
    page.get_by_role("button", name="Undo").click()
    expect(page.locator(".corner")).to_have_count(10)


def test_a_drawing_without_units_asks_for_them(page: Page, cloth: Desk) -> None:
    pattern = filemanagement.new("R2000", units=0)
    pattern.modelspace().add_lwpolyline([(0, 0), (50, 0), (50, 40), (0, 40)], close=True, dxfattribs={"layer": "1"})
    written = io.StringIO()
    pattern.write(written)
    choose_file(page, "plain.dxf", written.getvalue())
    page.get_by_role("button", name="cm: 50.0 cm x 40.0 cm").click()
    page.get_by_role("button", name="Open here").click()
    expect(page.locator(".corner")).to_have_count(4)
    assert max(corner["point"][0] for corner in cloth.drawing["outline"]) == pytest.approx(0.5, abs=1e-9)


def dxf(units: int, *corners: tuple[float, float]) -> str:
    pattern = filemanagement.new("R2000", units=units)
    pattern.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": "1"})
    written = io.StringIO()
    pattern.write(written)
    return written.getvalue()


def test_where_the_unit_in_a_file_does_not_fit_another_is_chosen_or_the_width_is_written(
    page: Page, cloth: Desk
) -> None:
    # A header that says metres of a drawing in pixels: as millimetres it would be 3.2 m wide, as metres 3,200.
    choose_file(page, "pixels.dxf", dxf(6, (0, 0), (3200, 0), (3200, 1600), (0, 1600)))
    dialog = page.get_by_role("dialog", name="Import")
    expect(dialog.locator(".unit-choices button")).to_have_text(
        ["mm: 320.0 cm x 160.0 cm", "pt: 112.9 cm x 56.4 cm", "px: 84.7 cm x 42.3 cm"]
    )
    width = dialog.get_by_label("Its width")
    width.fill("half")
    page.keyboard.press("Enter")
    expect(dialog.get_by_role("alert")).to_contain_text("no number")
    width.fill("64")
    dialog.get_by_role("button", name="Use this width").click()
    page.get_by_role("button", name="Open here").click()
    expect(page.locator(".corner")).to_have_count(4)
    sides = [corner["point"] for corner in cloth.drawing["outline"]]
    assert (max(x for x, _ in sides), max(y for _, y in sides)) == pytest.approx((0.64, 0.32), abs=1e-9)


def test_another_size_can_be_given_to_what_was_read(page: Page, cloth: Desk) -> None:
    choose_file(page, "square.svg", SVG)
    page.get_by_role("button", name="Another size").click()
    page.get_by_label("Its width").fill("20")
    page.get_by_role("button", name="Use this width").click()
    page.get_by_role("button", name="Open here").click()
    expect(page.locator(".corner")).to_have_count(4)
    assert max(corner["point"][0] for corner in cloth.drawing["outline"]) == pytest.approx(0.2, abs=1e-9)


def test_fold_lines_are_read_on_the_cloth_that_is_chosen(page: Page, cloth: Desk) -> None:
    # The first line halves the square; the second one runs over all of it, as on cloth that nobody has folded.
    flat = SVG.replace("</svg>", '<line x1="0" y1="200" x2="400" y2="200" stroke="blue"/></svg>')
    choose_file(page, "square.svg", flat.replace("100", "200"))
    dialog = page.get_by_role("dialog", name="Import")
    expect(dialog.get_by_label("the flat cloth")).to_be_checked()
    dialog.get_by_label("the folded cloth").check()
    expect(dialog.get_by_label("the folded cloth")).to_be_checked()
    expect(dialog.locator(".notes")).to_contain_text("does not fit")
    dialog.get_by_label("the flat cloth").check()
    expect(dialog.locator(".notes")).not_to_contain_text("does not fit")
    dialog.get_by_role("button", name="Open here").click()
    expect_step(page, "Import square.svg")
    assert cloth.state["problems"] == []


def test_a_pattern_ends_at_its_seam_line_unless_the_cut_line_is_chosen(page: Page, cloth: Desk) -> None:
    seam = SVG.replace("<line", '<path d="M10 10H390V290H10Z" fill="none" stroke="black"/><line')
    choose_file(page, "piece.svg", seam)
    dialog = page.get_by_role("dialog", name="Import")
    expect(dialog.get_by_label("the seam line")).to_be_checked()
    expect(dialog.locator(".notes")).to_contain_text(
        "The drawing has a seam allowance of 1 cm; the seam line was taken."
    )
    dialog.get_by_label("the cut line, 1 cm outside of it").check()
    expect(dialog.locator(".notes")).to_contain_text("the cut line was taken")
    dialog.get_by_label("the seam line").check()
    expect(dialog.locator(".notes")).to_contain_text("the seam line was taken")
    dialog.get_by_role("button", name="Open here").click()
    expect_step(page, "Import piece.svg")
    assert max(corner["point"][0] for corner in cloth.drawing["outline"]) == pytest.approx(0.38)


def test_an_arc_of_a_drawing_is_a_curve_that_can_be_pulled(page: Page, cloth: Desk) -> None:
    rounded = '<path d="M0 0H200A100 100 0 0 1 200 200H0Z"/>'
    choose_file(page, "rounded.svg", f"{SVG.partition('>')[0]}>{rounded}</svg>")
    page.get_by_role("dialog", name="Import").get_by_role("button", name="Open here").click()
    expect_step(page, "Import rounded.svg")
    expect(page.locator(".corner")).to_have_count(4)
    expect(page.locator(".handle.middle.is-curved")).to_have_count(1)
    hand = Hand(page)
    hand.tool("Select")
    hand.tool("Fit")
    hand.drag((0.3, 0.1), (0.25, 0.1))
    expect_step(page, "Bend edge")
    (bent,) = (corner["curve"] for corner in cloth.drawing["outline"] if "curve" in corner)
    assert abs(bent["across"]) == pytest.approx(0.25, abs=5e-3)


def test_of_a_plan_file_the_garment_is_opened(page: Page, cloth: Desk) -> None:
    plan = replace(unsolved(), task=Task.of(Garment.from_dict(towel())))
    choose_file(page, "my-towel.plan.json", json.dumps(plan.to_dict()))
    expect(page.get_by_role("dialog", name="Import").locator(".notes")).to_contain_text(
        "The file is a plan: its garment"
    )
    page.get_by_role("button", name="Open here").click()
    expect_step(page, "Import my-towel.plan.json")
    expect(page.locator(".corner")).to_have_count(4)
    assert cloth.drawing["placement"] == towel()["placement"]


def test_a_file_that_is_no_drawing_is_told_of(page: Page, cloth: Desk) -> None:
    choose_file(page, "broken.svg", "<svg><path")
    expect(page.get_by_role("dialog").get_by_role("alert")).to_contain_text("broken.svg")
    assert cloth.can_undo == "Begin"


def test_every_format_is_saved(page: Page, shirt: Desk, tmp_path: Path) -> None:
    expect_planned(page)
    page.get_by_role("button", name="Export", exact=True).click()
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("listitem")).to_have_count(len(EXPORTS))
    expect(dialog.get_by_role("list", name="For a robot").get_by_role("listitem").first).to_contain_text("Plan (CSV)")
    saved = {}
    for link in dialog.locator(".export a").all():
        with page.expect_download() as download:
            link.click()
        path = tmp_path / download.value.suggested_filename
        download.value.save_as(path)
        saved[path.name] = path.read_text(errors="replace")
    sheets = ["t-shirt-steps.pdf", "t-shirt-steps.svg"]
    files = ["t-shirt.fold", "t-shirt.json", "t-shirt.plan.json", "t-shirt.svg"]
    poses = ["t-shirt-poses.json", "t-shirt-poses.yaml"]
    assert set(saved) == {"t-shirt-plan.csv", *sheets, *files, *poses}
    assert len(json.loads(saved["t-shirt.json"])["outline"]) == 10
    plan = json.loads(saved["t-shirt.plan.json"])
    assert (plan["pleat_plan"], plan["status"], len(plan["steps"])) == (1, "solved", len(plan["primitives"]))
    expect(page.get_by_role("button", name="Save Recording (HTML)")).to_be_enabled()


def test_what_becomes_available_while_the_dialog_is_open_can_be_saved_there(
    page: Page, new_sheet: Callable[[GarmentGiven], Sheet]
) -> None:
    sheet = new_sheet(None)
    page.goto(sheet.page_url)
    page.get_by_role("button", name="Export", exact=True).click()
    dialog = page.get_by_role("dialog", name="Export")
    verbs = [dialog.get_by_label(f"Save {title}") for title in ("Plan (JSON)", "Plan (CSV)", "Recording (HTML)")]
    for verb in verbs:
        expect(verb).to_be_disabled()
    REST.put(f"{sheet.path}/garment", json={"garment": napkin()}).raise_for_status()
    for verb in verbs:
        expect(verb).to_be_enabled()
    kept = dialog.get_by_label("Save Garment (JSON)")
    kept.focus()
    with page.expect_response("**/files"):
        sheet.edit(lambda drawing: drawing.update(title="Another"))
    expect(page).to_have_title("Another - Pleat")
    expect(verbs[0]).to_be_enabled()
    expect(kept).to_be_focused()


def test_control_s_saves_the_garment_as_it_is_drawn(page: Page, cloth: Desk, tmp_path: Path) -> None:
    hand = Hand(page)
    hand.click((0.61, 0.572))
    page.get_by_label("x of the vertex").fill("64")
    page.keyboard.press("Enter")
    expect_step(page, "Move vertex")
    with page.expect_download() as download:
        page.keyboard.press("Control+s")
    download.value.save_as(tmp_path / "saved.json")
    outline = json.loads((tmp_path / "saved.json").read_text())["outline"]
    assert [0.64, 0.572] in outline


def test_help_tells_the_keys_and_goes_away(page: Page, cloth: Desk) -> None:
    page.keyboard.press("?")
    dialog = page.get_by_role("dialog", name="Help")
    expect(dialog).to_contain_text("whether your robot can fold it")
    expect(dialog).to_contain_text("Ctrl + Shift + Z")
    page.keyboard.press("Escape")
    expect(dialog).to_have_count(0)


def test_the_garment_is_renamed_as_one_step(page: Page, cloth: Desk) -> None:
    page.get_by_role("button", name="Rename").click()
    dialog = page.get_by_role("dialog", name="Rename garment")
    dialog.get_by_label("Name").fill("Été: Lena's shirt")
    page.keyboard.press("Enter")
    expect_step(page, "Rename garment")
    expect(page.get_by_role("combobox", name="Garment").locator("option:checked")).to_have_text("Été: Lena's shirt")
    # Letters lose their accents, all else becomes dashes.
    assert cloth.drawing["name"] == "ete-lena-s-shirt"
    assert cloth.drawing["title"] == "Été: Lena's shirt"
