import math
import time
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from app.files.import_errors import ImportedFileError, UnitsNeededError
from app.files.import_file import import_file
from app.files.seam_allowance import Line
from app.files.sketch_garment import Imported

# A square of 60 by 40 in a drawing whose unit is a centimetre, and whose y goes down.
SQUARE = '<path d="M 0 0 H 60 V 40 H 0 Z"/>'
DASH = '<path d="M 0 0 H 1"/>'


def svg(*shapes: str, size: str = 'width="60cm" height="40cm"', box: str = "0 0 60 40", more: str = "") -> bytes:
    inside = "".join(shapes)
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="{box}" {more}>{inside}</svg>'.encode()


def read(data: bytes, units: str | None = None, scale: float = 1.0) -> Imported:
    return import_file("my shirt.svg", data, units, scale)


def outline(imported: Imported) -> list[tuple[float, float]]:
    return [(round(x, 9), round(y, 9)) for x, y in imported.garment.outline]


def area(imported: Imported) -> float:
    return float(imported.garment.pattern.area)


def refusal(data: bytes) -> str:
    with pytest.raises(ImportedFileError) as caught:
        read(data)
    assert caught.value.field == "file"
    return caught.value.message


def test_a_closed_path_is_the_outline_in_metres_with_y_up_and_its_lower_left_corner_at_the_origin() -> None:
    found = read(svg('<path d="M 10 10 H 40 V 30 H 10 Z"/>'))
    assert outline(found) == [(0.0, 0.2), (0.3, 0.2), (0.3, 0.0), (0.0, 0.0)]


def test_the_name_comes_from_the_file_and_the_title_from_the_drawing() -> None:
    plain = read(svg(SQUARE)).garment
    titled = read(svg("<title> Sunday  shirt </title>", SQUARE)).garment
    assert (plain.name, plain.title) == ("my-shirt", "my shirt")
    assert (titled.name, titled.title) == ("sunday-shirt", "Sunday shirt")


def test_the_largest_closed_path_is_taken_and_said_to_be() -> None:
    found = read(svg('<rect x="1" y="1" width="5" height="5"/>', SQUARE, '<circle cx="20" cy="20" r="3"/>'))
    assert outline(found) == [(0.0, 0.4), (0.6, 0.4), (0.6, 0.0), (0.0, 0.0)]
    assert any("2 other closed lines" in note.text for note in found.notes)


def test_lines_are_folds_by_the_colour_of_their_stroke_however_it_is_given_in_the_direction_of_the_line() -> None:
    found = read(
        svg(
            "<style>/* made up */ .mark, #last { stroke: #00F } path.mark { fill: none }</style>",
            SQUARE,
            '<line x1="30" y1="40" x2="30" y2="0" stroke="blue"><title>half</title></line>',
            '<g style="stroke:rgb(200, 10, 10)"><path id="back" d="M 0 10 L 30 10"/></g>',
            '<path class="mark" d="M 15 0 V 40"/>',
            '<polyline id="last" points="0,20 60,20"/>',
            '<path stroke="currentColor" d="M 1 1 L 9 9"/>',
            '<line x1="0" y1="5" x2="9" y2="5" stroke="#777"/>',
        )
    ).garment
    assert [(fold.name, fold.kind) for fold in found.folds] == [
        ("half", "blue"),
        ("back", "red"),
        ("fold 3", "blue"),
        ("last", "blue"),
    ]
    assert np.allclose([found.folds[0].start, found.folds[0].end], [(0.3, 0.0), (0.3, 0.4)])
    assert np.allclose([found.folds[1].start, found.folds[1].end], [(0.0, 0.3), (0.3, 0.3)])


def test_a_style_attribute_beats_a_style_sheet_and_a_sheet_beats_a_plain_attribute() -> None:
    found = read(
        svg(
            "<style>line { stroke: blue } .late { stroke: red }</style>",
            SQUARE,
            '<line x1="30" y1="0" x2="30" y2="40" stroke="red"/>',
            '<line class="late" x1="0" y1="20" x2="30" y2="20"/>',
            '<line class="late" x1="0" y1="10" x2="30" y2="10" style="stroke: blue !important"/>',
        )
    )
    assert [fold.kind for fold in found.garment.folds] == ["blue", "red", "blue"]


def test_lines_of_other_colours_and_what_is_hidden_are_no_folds() -> None:
    found = read(
        svg(
            SQUARE,
            '<line x1="30" y1="0" x2="30" y2="40" stroke="black"/>',
            '<g display="none"><line x1="20" y1="0" x2="20" y2="40" stroke="blue"/></g>',
            '<g visibility="hidden"><line x1="20" y1="0" x2="20" y2="40" stroke="blue"/></g>',
            '<defs><line x1="20" y1="0" x2="20" y2="40" stroke="blue"/></defs>',
        )
    )
    assert found.garment.folds == ()
    assert any("neither blue nor red" in note.text for note in found.notes)


def test_transforms_of_groups_shapes_and_references_are_all_made() -> None:
    # The bar from (0, 0) to (20, 10), turned by a quarter about the origin, lies at x -10..0, y 0..20; carried by
    # (30, 5), and by the use, drawn twice as large, by (2, 0) more, it lies at x 44..64, y 10..50: 20 wide, 40 high.
    bar = '<defs><rect id="bar" width="20" height="10" transform="translate(30 5) rotate(90)"/></defs>'
    used = '<g transform="scale(2)"><use href="#bar" x="2"/></g>'
    line = '<line x1="44" y1="30" x2="64" y2="30" stroke="blue"/>'
    found = read(svg(bar, used, line))
    assert sorted(outline(found)) == [(0.0, 0.0), (0.0, 0.4), (0.2, 0.0), (0.2, 0.4)]
    assert np.allclose(found.garment.folds[0].start, (0.0, 0.2))
    assert np.allclose(found.garment.folds[0].end, (0.2, 0.2))


def test_a_curve_becomes_straight_edges_that_are_off_by_half_a_millimetre_at_most() -> None:
    circle = read(svg('<circle cx="30" cy="20" r="20"/>')).garment
    middle = np.array([0.2, 0.2])
    corners = np.array(circle.outline)
    assert np.allclose(np.hypot(*(corners - middle).T), 0.2)
    halves = (corners + np.roll(corners, -1, axis=0)) / 2
    assert 0.2 - np.hypot(*(halves - middle).T).min() <= 0.0005
    assert len(corners) <= 400


def test_bezier_curves_of_both_degrees_are_followed() -> None:
    # Both bend from (0, 0) to (20, 20) towards the corner (20, 0), with which the ends make a triangle of 200. A
    # parabola cuts off 2/3 of it. From the corner the cubic's ends have the weights (1-t)^3 and t^3, so what it leaves
    # of the triangle is 1/2 * 400 * integral of 3 t^2 (1-t)^2 = 200 * 3/30 = 20: it cuts off 9/10.
    quadratic = read(svg('<path d="M 0 0 Q 20 0 20 20 Z"/>'))
    cubic = read(svg('<path d="M 0 0 C 20 0 20 0 20 20 Z"/>'))
    assert area(quadratic) == pytest.approx(2 / 3 * 200e-4, rel=0.01)
    assert area(cubic) == pytest.approx(9 / 10 * 200e-4, rel=0.01)


def test_an_outline_of_many_points_is_simplified_to_400_and_the_deviation_is_said() -> None:
    turns = np.linspace(0.0, math.tau, 3000, endpoint=False)
    points = " ".join(f"{30 + 19 * math.cos(a):.5f},{20 + 19 * math.sin(a):.5f}" for a in turns)
    found = read(svg(f'<polygon points="{points}"/>'))
    assert len(found.garment.outline) <= 400
    assert area(found) == pytest.approx(math.pi * 0.19**2, rel=0.01)
    # Half a millimetre for curves, one for points nearer than that to each other, half of one for simplifying.
    assert any("at most 2 mm off" in note.text for note in found.notes)
    away = np.hypot(*(np.array(found.garment.outline) - [0.19, 0.19]).T)
    assert np.abs(away - 0.19).max() < 0.002


@pytest.mark.parametrize(
    ("size", "box", "width_m"),
    [
        ('width="600mm" height="400mm"', "0 0 60 40", 0.6),
        ('width="60cm"', "0 0 60 40", 0.6),
        ('width="30in" height="20in"', "0 0 60 40", 30 * 0.0254),
        ('width="60cm" height="60cm"', "0 0 60 40", 0.6),  # shown with margins above and below
        ('width="60cm" height="60cm" preserveAspectRatio="xMidYMid slice"', "0 0 60 40", 0.9),
    ],
)
def test_the_size_of_the_sheet_says_how_long_a_unit_is(size: str, box: str, width_m: float) -> None:
    assert read(svg(SQUARE, size=size, box=box)).garment.pattern.length == pytest.approx(width_m)


def test_a_sheet_that_is_stretched_stretches_the_garment() -> None:
    stretched = svg(SQUARE, size='width="60cm" height="80cm" preserveAspectRatio="none"')
    assert sorted(outline(read(stretched)))[-1] == (0.6, 0.8)


def test_without_a_view_box_a_unit_is_a_px_of_which_96_make_an_inch() -> None:
    data = b'<svg xmlns="http://www.w3.org/2000/svg" width="10cm"><rect width="960" height="480"/></svg>'
    assert sorted(outline(read(data)))[-1] == (0.254, 0.127)


@pytest.mark.parametrize("size", ["", 'width="600" height="400"', 'width="100%"', 'width="600px"'])
def test_a_drawing_without_physical_units_asks_for_them_and_says_how_large_it_would_be(size: str) -> None:
    with pytest.raises(UnitsNeededError) as caught:
        read(svg(SQUARE, size=size))
    assert caught.value.sizes["mm"] == pytest.approx((0.06, 0.04))
    assert caught.value.sizes["in"] == pytest.approx((1.524, 1.016))


def test_units_that_are_given_overrule_the_file_and_a_scale_multiplies() -> None:
    assert sorted(outline(read(svg(SQUARE), "mm", 5.0)))[-1] == (0.3, 0.2)


def test_lines_that_meet_at_their_ends_make_an_outline_together() -> None:
    sides = ['<path d="M 0 0 H 60"/>', '<path d="M 0 0 V 40 H 30"/>', '<path d="M 60 0 V 40 H 30"/>']
    assert area(read(svg(*sides))) == pytest.approx(0.24)


def gapped(across: float, gap: float) -> str:
    """Return the sides of a square, each with its end so far before the next one's beginning."""
    ends = ((across, 0.0), (across, across), (0.0, across), (0.0, 0.0))
    starts = (ends[-1], *ends[:-1])
    lines = [
        (start, np.subtract(end, np.sign(np.subtract(end, start)) * gap))
        for start, end in zip(starts, ends, strict=True)
    ]
    return "".join(f'<path d="M {x} {y} L {to[0]} {to[1]}"/>' for (x, y), to in lines)


@pytest.mark.parametrize("across_cm", [8.0, 40.0])
def test_gaps_of_a_millimetre_are_closed_however_small_the_garment(across_cm: float) -> None:
    assert area(read(svg(gapped(across_cm, 0.1)))) == pytest.approx((across_cm / 100.0) ** 2, rel=0.05)


def test_where_the_unit_is_not_known_gaps_of_a_millimetre_do_not_hide_the_outline() -> None:
    with pytest.raises(UnitsNeededError):
        read(svg(gapped(40.0, 0.1), size=""))


def test_a_bent_fold_line_is_straightened_and_said_to_be() -> None:
    found = read(svg(SQUARE, '<path stroke="blue" d="M 0 20 Q 30 30 60 20"/>'))
    assert np.allclose([found.garment.folds[0].start, found.garment.folds[0].end], [(0.0, 0.2), (0.6, 0.2)])
    assert any("not straight" in note.text for note in found.notes)


def test_a_red_line_that_comes_first_becomes_blue_and_is_said_to() -> None:
    found = read(svg(SQUARE, '<path stroke="red" d="M 0 20 H 60"/>'))
    assert found.garment.folds[0].kind == "blue"
    assert any("made blue" in note.text for note in found.notes)


def test_entities_are_refused_and_none_is_expanded() -> None:
    laughs = '<!ENTITY a "ha">'
    for a, b in pairwise("abcdefghij"):
        laughs += f'<!ENTITY {b} "{10 * f"&{a};"}">'
    bomb = f"<!DOCTYPE svg [{laughs}]><svg><title>&j;</title></svg>".encode()
    assert "declares an entity" in refusal(bomb)


def test_nothing_outside_the_file_is_read(tmp_path: Path) -> None:
    secret = tmp_path / "secret.txt"
    secret.write_text("60 40")
    entity = f'<!DOCTYPE svg [<!ENTITY there SYSTEM "{secret.as_uri()}">]><svg><title>&there;</title></svg>'
    assert "declares an entity" in refusal(entity.encode())
    assert "not in this file" in refusal(svg(f'<use href="{secret.as_uri()}#shape"/>'))
    typed = f'<!DOCTYPE svg SYSTEM "{secret.as_uri()}">'.encode() + svg(SQUARE)
    assert len(read(typed).garment.outline) == 4


def test_references_that_multiply_are_refused() -> None:
    groups = ['<g id="g0"><path d="M 0 0 H 1"/></g>']
    for i in range(1, 12):
        inside = 10 * f'<use href="#g{i - 1}"/>'
        groups.append(f'<g id="g{i}">{inside}</g>')
    assert "more than 5000 shapes" in refusal(svg(f"<defs>{''.join(groups)}</defs>", '<use href="#g11"/>'))
    assert "references" in refusal(svg('<g id="g"><use href="#g"/></g>', '<use href="#g"/>'))


@pytest.mark.parametrize(
    "data",
    [
        svg(f"<style>{'a' * 1_000_000}</style>"),
        svg(f"<style>{'/*' * 500_000}</style>"),
        svg(f"<style>{'.a{stroke:red}' * 500}</style>"),
        svg(f'<rect width="{" " * 1_000_000}x" height="4"/>'),
        svg(f'<rect width="{"9" * 1_000_000}x" height="4"/>'),
        svg(f'<path d="M 0 0 {"L 1 1 " * 100_000}"/>'),
        svg(f'<path d="M 0 0 {"C 9 9 8 -9 7 7 " * 3_000}"/>', size='width="60km" height="40cm"'),
        svg(f'<path d="M 0 0 {"C 1e4 0 0 1e4 5 5 " * 3_000}"/>'),
        svg(f'<path id="p" d="M 0 0{" " * 500_000}H 1"/>', '<use href="#p"/>' * 4_000),
        svg(f'<g stroke="{"9" * 1_000_000}">', 4_000 * DASH, "</g>"),
        svg("<g>" * 90, 60_000 * DASH, "</g>" * 90),
    ],
    ids=range(11),
)
def test_what_is_made_to_take_long_is_refused_at_once(data: bytes) -> None:
    began = time.thread_time()
    assert refusal(data)
    assert time.thread_time() - began < 5.0


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "line 1, column 1: no element found"),
        (b"<svg>\n  <path", "line 2, column 3: unclosed token"),
        (b"hello", "line 1, column 1: syntax error"),
        (b"<html></html>", "begins with <html>"),
        (svg("\n", '<path d="M 0 0 L 5"/>'), "line 2: the data of this <path> is not understood"),
        (svg('<path d="M 0 0 R 5 5"/>'), "paths have no 'R'"),
        (svg('<path d="M 0 0 L 5 5 # 8 8"/>'), "paths have no '#'"),
        (svg('<path transform="scale(1 2 3)" d="M 0 0 H 5"/>'), "transform='scale(1 2 3)' is not understood"),
        (svg('<path transform="scale(1" d="M 0 0 H 5"/>'), "transform='scale(1' is not understood"),
        (svg('<path transform="scale(1e200) scale(1e200)" d="M 0 0 H 5"/>'), "is too large"),
        (svg('<path d="M 0 0 L 1e999 0"/>'), "too large"),
        (svg('<rect width="wide" height="4"/>'), "width='wide' is no length"),
        (svg('<polygon points="1 2 three 4"/>'), "no list of numbers"),
        (svg('<g transform="turn(3)"><path d="M 0 0 H 5"/></g>'), "transform='turn(3)' is not understood"),
        (svg(SQUARE, box="0 0 60"), "viewBox"),
        (svg('<use href="#nothing"/>'), "refers to '#nothing', which is not in this file"),
        (svg(), "nothing drawn"),
        (svg('<path d="M 0 0 H 60"/>'), "no closed line"),
        (b"<a>" * 200, "nested more than 100 deep"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(data: bytes, message: str) -> None:
    assert message in refusal(data)


LONG = '<path d="M 0 0 H 6000 V 40 H 0 Z"/>'
TINY = '<path d="M 0 0 H 0.6 V 0.4 H 0 Z"/>'


@pytest.mark.parametrize(
    ("shape", "told", "mm"), [(LONG, "60 m long", (6.0, 0.04)), (TINY, "0.006 m long", (6e-4, 4e-4))]
)
def test_where_the_units_of_the_file_cannot_be_meant_they_are_asked_for(
    shape: str, told: str, mm: tuple[float, float]
) -> None:
    with pytest.raises(UnitsNeededError, match=told) as caught:
        read(svg(shape))
    assert caught.value.sizes["mm"] == pytest.approx(mm)


def test_a_drawing_larger_than_a_room_by_the_units_that_were_said_is_refused_with_its_size() -> None:
    with pytest.raises(ImportedFileError) as caught:
        read(svg(LONG), "cm")
    assert caught.value.field == "scale"
    assert "the outline is 60 m wide" in caught.value.message


def test_the_sizes_in_other_units_are_told_with_the_garment() -> None:
    sizes = read(svg(SQUARE)).sizes
    assert sizes is not None
    assert sizes["cm"] == pytest.approx((0.6, 0.4))
    assert sizes["in"] == pytest.approx((60 * 0.0254, 40 * 0.0254))


@pytest.mark.parametrize(
    ("shape", "told"),
    [
        (SQUARE, "The outline has 4 corners."),
        ('<path d="M0 0C20 0 40 0 60 0V40H0Z"/>', "The outline has 4 corners."),
        ('<path d="M0 0H60V40Q30 50 0 40Z"/>', "curves were replaced by straight edges that are at most 0.5 mm off."),
        ('<path d="M0 0H60V40H30.05V40.05H0Z"/>', "others were left out, so that its edges are at most 1.5 mm off."),
    ],
    ids=["straight", "a curve that is straight", "bent", "corners too near to each other"],
)
def test_curves_are_said_to_be_replaced_only_where_there_are_some(shape: str, told: str) -> None:
    notes = read(svg(shape)).notes
    assert next(note.text for note in notes if note.text.startswith("The outline has")).endswith(told)


def test_an_odd_size_is_pointed_out() -> None:
    assert any("odd size" in note.text for note in read(svg(SQUARE), "mm", 0.5).notes)


CUT = '<path d="M 1 1 H 59 V 39 H 1 Z"/>'
SEAM = '<path d="M 2 2 H 58 V 38 H 2 Z"/>'


@pytest.mark.parametrize(("line", "size"), [(None, (0.56, 0.36)), ("seam", (0.56, 0.36)), ("cut", (0.58, 0.38))])
def test_of_a_cut_line_and_a_seam_line_the_one_that_is_wanted_is_taken(
    line: Line | None, size: tuple[float, float]
) -> None:
    found = import_file("piece.svg", svg(CUT, SEAM), line=line)
    assert np.ptp(np.array(found.garment.outline), axis=0) == pytest.approx(size)
    assert found.allowance is not None
    assert found.allowance.line == (line or "seam")
    assert found.allowance.width_m == pytest.approx(0.01)
    assert not any("left out" in note.text for note in found.notes)
    assert any("10.0 mm" in note.text for note in found.notes)


@pytest.mark.parametrize(
    "inner",
    [
        '<rect x="20" y="10" width="10" height="10"/>',  # a hole
        '<rect x="1" y="1" width="20" height="38"/>',  # it touches the cut line
        '<path d="M 2 2 H 58 V 33 H 2 Z"/>',  # wider at one side
        '<path d="M 12 12 H 48 V 28 H 12 Z"/>',  # parallel, but far too wide
    ],
)
def test_another_closed_line_that_is_no_seam_line_is_left_out(inner: str) -> None:
    found = read(svg(CUT, inner))
    assert found.allowance is None
    assert np.ptp(np.array(found.garment.outline), axis=0) == pytest.approx((0.58, 0.38))


def test_a_round_pattern_and_one_with_sharp_corners_have_their_allowance_told() -> None:
    rounded = read(svg('<circle cx="30" cy="20" r="19"/>', '<circle cx="30" cy="20" r="18.2"/>'))
    assert rounded.allowance is not None and rounded.allowance.width_m == pytest.approx(0.008, rel=0.05)
    # A triangle of 50 by 30: each side of the inner one is 1 inside, its corners are up to 3.6 away.
    half = math.atan2(30, 50) / 2
    near, top = 5 + 1 / math.tan(half), 7 + 1 / math.tan(math.pi / 4 - half)
    inner = f'<path d="M {near} 36 H 54 V {top} Z"/>'
    sharp = read(svg('<path d="M 5 37 H 55 V 7 Z"/>', inner))
    assert sharp.allowance is not None and sharp.allowance.width_m == pytest.approx(0.01, rel=0.05)
