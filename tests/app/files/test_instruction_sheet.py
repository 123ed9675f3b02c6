"""The instruction sheet has a numbered picture for each step, all on the page, and is a whole SVG or PDF file."""

import io
import re
from dataclasses import replace
from xml.etree import ElementTree

import pytest
from pypdf import PdfReader

from app.files.instruction_sheet import HEIGHT, WIDTH, instruction_sheet
from app.files.sheet_page import Disc, Outline, Page, Words, page_svg
from app.files.sheet_pdf import page_pdf
from planner import Plan, load_garment, make_plan
from planner.errors import UnsolvedPlanError
from tests.replay.planned import shipped_plan

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module", params=["hand-towel", "letter-towel"])
def plan(request: pytest.FixtureRequest) -> Plan:
    return shipped_plan(request.param)


@pytest.fixture(scope="module")
def page(plan: Plan) -> Page:
    return instruction_sheet(plan)


def test_each_step_has_a_number_its_hands_and_how_long_it_takes(plan: Plan, page: Page) -> None:
    words = [shape.text for shape in page.shapes if isinstance(shape, Words)]
    for number, step in enumerate(plan.steps, 1):
        assert str(number) in words
        assert any(text.endswith(f"{step.duration_s:.1f} s") for text in words)
    hands = [text for text in words if text in ("L", "R")]
    assert len(hands) == sum(len(step.grips) for step in plan.steps)
    assert words[-1] == f"after {plan.cost_s:.1f} s"


def test_what_a_step_does_goes_on_in_a_second_line_where_it_is_long() -> None:
    garment = load_garment("letter-towel")
    long = replace(garment.folds[0], name="the long side that hangs over the near edge of the table")
    plan = make_plan(replace(garment, folds=(long, *garment.folds[1:])), time_limit_s=60.0)
    words = [shape for shape in instruction_sheet(plan).shapes if isinstance(shape, Words) and shape.size == 8.0]
    first = next(index for index, shape in enumerate(words) if shape.text.startswith("Fold: the long side"))
    title, goes_on, details = words[first : first + 3]
    assert f"{title.text} {goes_on.text}".startswith("Fold: the long side that hangs over the near edge")
    assert title.is_bold and goes_on.is_bold and not details.is_bold
    assert title.at[1] < goes_on.at[1] < details.at[1]
    assert details.text.endswith(" s")


def test_all_shapes_are_on_the_page(page: Page) -> None:
    for shape in page.shapes:
        spots = shape.points if isinstance(shape, Outline) else [shape.middle if isinstance(shape, Disc) else shape.at]
        assert all(0 <= x <= WIDTH and 0 <= y <= HEIGHT for x, y in spots)


def test_the_svg_file_has_all_that_is_on_the_page(page: Page) -> None:
    root = ElementTree.fromstring(page_svg(page))
    drawn = [len(root.findall(f"{SVG}{tag}")) for tag in ("path", "circle", "text")]
    assert drawn == [sum(isinstance(shape, kind) for shape in page.shapes) for kind in (Outline, Disc, Words)]


def test_another_reader_finds_the_page_and_its_words_in_the_pdf_file(page: Page) -> None:
    reader = PdfReader(io.BytesIO(page_pdf(page)), strict=True)
    (read,) = reader.pages
    assert (read.mediabox.width, read.mediabox.height) == (WIDTH, HEIGHT)
    assert reader.metadata is not None and reader.metadata.title == page.title
    words = read.extract_text().replace("\n", " ")
    for shape in page.shapes:
        assert not isinstance(shape, Words) or shape.text in words


def test_shapes_are_where_the_page_has_them() -> None:
    triangle = Outline(((1.0, 2.0), (5.0, 2.0), (1.0, 8.0)), fill="ff0000", stroke="")
    (read,) = PdfReader(io.BytesIO(page_pdf(Page(10.0, 10.0, "t", (triangle,))))).pages
    drawn = read.get_contents().get_data().decode("latin-1")  # type: ignore[union-attr]
    ends = [tuple(map(float, end)) for end in re.findall(r"^([\d.]+) ([\d.]+) [ml]$", drawn, re.MULTILINE)]
    assert set(ends) >= {(1.0, 8.0), (5.0, 8.0), (1.0, 2.0)}
    assert "1 0 0 rg" in drawn


@pytest.mark.parametrize(
    "words",
    ["a) (b\\ $x$", "Za\u017c\u00f3\u0142\u0107", "\u0424\u0443\u0442\u0431\u043e\u043b\u043a\u0430 \u0395\u03bb"],
)
def test_letters_of_many_scripts_and_those_that_mean_something_to_pdf_are_kept(words: str) -> None:
    reader = PdfReader(io.BytesIO(page_pdf(Page(200.0, 20.0, words, (Words((1.0, 10.0), words),)))))
    assert reader.pages[0].extract_text() == words
    assert reader.metadata is not None and reader.metadata.title == words


def test_a_letter_that_no_font_has_becomes_an_empty_square() -> None:
    hieroglyph = "\U00013000"
    reader = PdfReader(io.BytesIO(page_pdf(Page(20.0, 20.0, "t", (Words((1.0, 10.0), f"a{hieroglyph}b"),)))))
    assert reader.pages[0].extract_text() == "a\N{WHITE SQUARE}b"


def test_without_a_plan_there_is_no_sheet(plan: Plan) -> None:
    with pytest.raises(UnsolvedPlanError):
        instruction_sheet(replace(plan, steps=(), trajectory=None, status="infeasible"))
