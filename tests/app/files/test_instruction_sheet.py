"""The instruction sheet has a numbered picture for each step, all on the page, and is a whole SVG or PDF file."""

import re
from xml.etree import ElementTree

import pytest

from app.files.instruction_sheet import HEIGHT, WIDTH, instruction_sheet
from app.files.sheet_page import Disc, Outline, Page, Words
from app.files.sheet_pdf import page_pdf
from app.files.sheet_svg import page_svg
from planner import Plan, load_garment, make_plan
from planner.errors import UnsolvedPlanError

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module", params=["hand-towel", "letter-towel"])
def plan(request: pytest.FixtureRequest) -> Plan:
    return make_plan(load_garment(request.param), time_limit_s=60.0)


@pytest.fixture(scope="module")
def page(plan: Plan) -> Page:
    return instruction_sheet(plan)


def test_each_step_has_a_number_its_hands_and_how_long_it_takes(plan: Plan, page: Page):
    words = [shape.text for shape in page.shapes if isinstance(shape, Words)]
    for number, step in enumerate(plan.steps, 1):
        assert str(number) in words
        assert any(text.endswith(f"{step.duration_s:.1f} s") for text in words)
    hands = [text for text in words if text in ("L", "R")]
    assert len(hands) == sum(len(step.grips) for step in plan.steps)
    assert words[-1] == f"after {plan.cost_s:.1f} s"


def test_all_shapes_are_on_the_page(page: Page):
    for shape in page.shapes:
        spots = shape.points if isinstance(shape, Outline) else [shape.middle if isinstance(shape, Disc) else shape.at]
        assert all(0 <= x <= WIDTH and 0 <= y <= HEIGHT for x, y in spots)


def test_the_svg_file_has_all_that_is_on_the_page(page: Page):
    root = ElementTree.fromstring(page_svg(page))
    drawn = [len(root.findall(f"{SVG}{tag}")) for tag in ("path", "circle", "text")]
    assert drawn == [sum(isinstance(shape, kind) for shape in page.shapes) for kind in (Outline, Disc, Words)]


def test_the_pdf_file_says_truly_where_its_objects_are(page: Page):
    data = page_pdf(page)
    table = int(re.search(rb"startxref\n(\d+)\n%%EOF\n$", data)[1])  # type: ignore[index]
    assert data[table:].startswith(b"xref\n0 ")
    places = [int(row) for row in re.findall(rb"(\d{10}) 00000 n", data[table:])]
    for number, place in enumerate(places, 1):
        assert data[place:].startswith(b"%d 0 obj\n" % number)
    length, content = re.search(rb"/Length (\d+) >>\nstream\n(.*)\nendstream", data, re.DOTALL).groups()  # type: ignore[union-attr]
    assert int(length) == len(content)
    assert content.count(b" Tj ET") == sum(isinstance(shape, Words) for shape in page.shapes)


def test_letters_that_mean_something_to_pdf_or_are_not_in_its_fonts_do_no_harm():
    data = page_pdf(Page(10.0, 10.0, "a) (b\\ \u4e2d", (Words((1.0, 1.0), "a) (b\\ \u4e2d"),)))
    assert rb"(a\) \(b\\ ?) Tj" in data


def test_without_a_plan_there_is_no_sheet():
    with pytest.raises(UnsolvedPlanError):
        instruction_sheet(make_plan(load_garment("tie-halved"), time_limit_s=60.0))
