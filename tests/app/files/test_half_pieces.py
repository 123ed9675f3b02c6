"""Half pieces of SVG and DXF drawings become whole: cut on the fold, or drawn beside their mirror image."""

import io
import math

import numpy as np
import pytest
from ezdxf import filemanagement
from ezdxf.document import Drawing

from app.files.halves import mirrored_line, whole_line
from app.files.import_file import import_file
from app.files.sketch_garment import Imported
from planner.geometry.arrangement import reflected
from planner.geometry.segment import Segment

# A half of 24 by 60 cm with a neck, folded along x = 0, in cm with y down; its area is 24 * 60 - 8 * 10 / 2 = 1400.
HALF = "M 0 10 L 8 0 H 24 V 60 H 0 Z"
WHOLE_M2 = 2 * 0.14


def svg(*shapes: str) -> bytes:
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="200cm" height="100cm" viewBox="-100 -20 200 100">'
    return f"{head}<style>path {{ fill: none; stroke: #000 }}</style>{''.join(shapes)}</svg>".encode()


def read(*shapes: str) -> Imported:
    return import_file("front.svg", svg(*shapes))


def codes(imported: Imported) -> set[str]:
    return {note.code for note in imported.notes}


def sides(imported: Imported) -> tuple[float, float]:
    width, height = np.ptp(np.array(imported.garment.outline), axis=0).tolist()
    return (round(width, 6), round(height, 6))


def is_symmetric(imported: Imported) -> bool:
    """Return whether the outline is its own mirror image over its vertical middle."""
    corners = np.array(imported.garment.outline)
    image = corners * [-1.0, 1.0] + [corners[:, 0].min() + corners[:, 0].max(), 0.0]
    away = np.hypot(*(corners[:, None] - image[None]).transpose(2, 0, 1)).min(axis=1)
    return bool(away.max() < 1e-5)


@pytest.mark.parametrize(
    "mark",
    [
        '<path class="note" id="front.cutonfold" d="M 0 12 H 2 V 58 H 0"/>',
        '<path id="p1" d="M 0 12 L 2 12 L 2 58 L 0 58"/><text><textPath href="#p1">Cut on fold</textPath></text>',
        '<path id="p1" d="M 0 12 V 58"/><text><textPath href="#p1"><tspan>Im Stoffbruch</tspan></textPath></text>',
        '<path id="p1" d="M 0 12 V 58"/><text><textPath href="#p1">Couper sur la pliure</textPath></text>',
        '<path marker-start="url(#cutonfoldFrom)" marker-end="url(#cutonfoldTo)" d="M 0 12 H 2 V 58 H 0"/>',
        '<line id="place_on_fold" x1="0" y1="58" x2="0" y2="12" stroke="black"/>',
        '<path class="fold-line on-fold" d="M 1.5 15 V 55"/>',
        '<path d="M 2 15 V 55"><title>Place on fold</title></path>',
        '<path d="M 0 10 V 60" data-name="Mirror Line"/>',
        '<path id="au_pli" stroke="blue" d="M 0.05 10 V 60"/>',
        '<path id="p1" d="M 0 12 V 58"/><text><textPath href="#p1">Pliure</textPath></text>',
        '<path id="p1" d="M 0 12 V 58"/><text><textPath href="#p1">BRUCH</textPath></text>',
        '<path id="p1" d="M 0 12 V 58"/><text><textPath href="#p1"><tspan>1</tspan> Pliure du tissu</textPath></text>',
        '<path id="pliure_1" d="M 0 12 V 58"/>',
        '<path d="M 2 15 V 55"><title>Línea de doblez</title></path>',
        '<line id="doblez" x1="0" y1="58" x2="0" y2="12" stroke="black"/>',
    ],
    ids=range(16),
)
def test_a_piece_cut_on_the_fold_is_mirrored_over_the_edge_that_is_marked(mark: str) -> None:
    found = read(f'<path d="{HALF}"/>', mark)
    assert "piece_unfolded" in codes(found)
    assert sides(found) == (0.48, 0.6) and is_symmetric(found)
    assert found.garment.pattern.area == pytest.approx(WHOLE_M2, rel=1e-6)
    assert found.garment.folds == ()


@pytest.mark.parametrize("turn_deg", [0, 90, 37])
def test_the_fold_may_have_any_direction(turn_deg: int) -> None:
    mark = '<path class="cutonfold" d="M 0 12 H 2 V 58 H 0"/>'
    found = read(f'<g transform="rotate({turn_deg}) scale(0.8)"><path d="{HALF}"/>{mark}</g>')
    assert found.garment.pattern.area == pytest.approx(0.64 * WHOLE_M2, rel=1e-5)


def test_a_half_with_curves_is_mirrored_too_and_the_largest_whole_piece_is_taken() -> None:
    # Alone the sleeve is larger than the half, and smaller than the whole.
    front = '<path id="front" d="M 0 10 C 4 10 8 6 8 0 H 24 V 60 H 0 Z"/><path id="cutonfold" d="M 0 12 H 2 V 58 H 0"/>'
    sleeve = '<path id="sleeve" d="M 40 0 H 80 V 40 H 40 Z"/>'
    found = read(front, sleeve)
    assert sides(found) == (0.48, 0.6) and is_symmetric(found)
    assert any("curves were replaced" in note.text for note in found.notes)


def near(*point: float) -> object:
    return pytest.approx([*point])


def folds_on_half(*lines: str) -> list[tuple[str, list[float], list[float]]]:
    """Return the folds drawn on a half piece as name, start and end (m), as on the flat cloth of the whole."""
    mark = '<path id="cutonfold" d="M 0 12 V 58"/>'
    found = import_file("front.svg", svg(f'<path d="{HALF}"/>', mark, *lines), creases="folded")
    return [(fold.name, [*fold.start], [*fold.end]) for fold in found.garment.folds]


def test_a_fold_line_across_a_half_goes_on_to_the_other_half_in_its_direction() -> None:
    ((_, start, end),) = folds_on_half('<path style="stroke: blue" d="M 0 35 H 24"/>')
    assert (start, end) == (near(0.0, 0.25), near(0.48, 0.25))


def test_a_fold_line_along_the_fold_stays_one() -> None:
    ((_, start, end),) = folds_on_half('<path style="stroke: blue" d="M 0 10 V 60"/>')
    assert (start, end) == (near(0.24, 0.5), near(0.24, 0.0))


def test_a_fold_line_beside_the_fold_has_a_mirror_image_that_moves_the_other_side() -> None:
    one, other = folds_on_half('<path style="stroke: blue" d="M 15 60 V 0"><title>side</title></path>')
    assert one == ("side", near(0.39, 0.0), near(0.39, 0.6))
    assert other == ("side, mirrored", near(0.09, 0.6), near(0.09, 0.0))


def test_a_mirrored_fold_moves_the_mirrored_side() -> None:
    line = Segment((0.0, 0.0), (0.0, 1.0))
    ends = np.array([(0.3, 0.1), (0.4, 0.9)])
    image = mirrored_line(ends, line)
    assert image is not None
    moving = np.array([(0.1, 0.5)])  # to the left of the line
    assert Segment((0.3, 0.1), (0.4, 0.9)).left_distances(moving)[0] > 0.0
    mirrored = Segment(*(tuple(end) for end in image.tolist()))
    assert mirrored.left_distances(reflected(moving, line))[0] > 0.0
    assert mirrored_line(np.array([(0.0, 0.1), (0.0, 0.9)]), line) is None
    assert mirrored_line(np.array([(-0.3, 0.1), (0.3, 0.1)]), line) is None
    assert whole_line(ends, line) is None


@pytest.mark.parametrize(
    "mark",
    [
        '<text x="3" y="30">Cut 1 on fold</text>',
        '<text x="3" y="30"><tspan>Vorderteil</tspan> <tspan>im Bruch</tspan></text>',
        '<path id="cutonfold" d="M 40 0 V 30"/>',
        '<text x="0" y="30">pliure</text>',
        '<text x="0" y="30">Bruch</text><path d="M 0 12 V 58"/>',
        '<text x="0" y="30">- doblez -</text>',
    ],
)
def test_where_the_edge_is_not_marked_it_is_said_that_the_piece_is_a_half(mark: str) -> None:
    found = read(f'<path d="{HALF}"/>', mark)
    assert "fold_unknown" in codes(found)
    assert sides(found) == (0.24, 0.6)


@pytest.mark.parametrize("word", ["pliure", "Bruch", "Doblez 1"])
def test_a_line_in_the_colour_of_a_fold_that_is_called_a_fold_is_one(word: str) -> None:
    line = f'<path id="p1" style="stroke: blue" d="M 12 60 V 0"><title>{word}</title></path>'
    found = read(f'<path d="{HALF}"/>', line, f'<text x="12" y="30"><textPath href="#p1">{word}</textPath></text>')
    assert [fold.name for fold in found.garment.folds] == [word]
    assert not codes(found) & {"piece_unfolded", "fold_unknown"}


@pytest.mark.parametrize(
    "text", ["Umbruch", "Abbruchkante", "pliures 1 et 2", "dobladillo", "2 cm bis zum Bruch falten"]
)
def test_other_texts_say_nothing_of_a_fold(text: str) -> None:
    assert "fold_unknown" not in codes(read(f'<path d="{HALF}"/>', f'<text x="0" y="30">{text}</text>'))


def test_a_piece_that_is_drawn_whole_around_its_fold_line_stays_as_it_is() -> None:
    found = read('<path d="M -24 0 H 24 V 60 H -24 Z"/>', '<path id="cutonfold" d="M 0 0 V 60"/>')
    assert sides(found) == (0.48, 0.6)
    assert "piece_unfolded" not in codes(found)


@pytest.mark.parametrize(
    "other",
    [
        '<use href="#half" transform="matrix(-1,0,0,1,0,0)"/>',
        '<use href="#half" transform="scale(-1 1)"/>',
        '<use xmlns:x="http://www.w3.org/1999/xlink" x:href="#half" transform="rotate(180) scale(1 -1)"/>',
        '<path d="M 0 10 L -8 0 H -24 V 60 H 0 Z"/>',
        '<path d="M 0 60 V 10 L -8 0 H -24 V 60 Z"/>',
        '<g transform="translate(-0.08 0)"><use href="#half" transform="scale(-1 1)"/></g>',
    ],
    ids=range(6),
)
def test_a_half_and_its_mirror_image_beside_it_are_one_piece(other: str) -> None:
    found = read(f'<path id="half" d="{HALF}"/>', other, '<path style="stroke: blue" d="M -24 40 H 24"/>')
    assert "halves_joined" in codes(found)
    assert found.garment.pattern.area == pytest.approx(WHOLE_M2, rel=3e-3)
    assert sides(found) == pytest.approx((0.48, 0.6), abs=1e-3)
    assert len(found.garment.folds) == 1
    assert not any("other closed line" in note.text for note in found.notes)


def test_halves_without_the_edge_between_them_are_one_piece() -> None:
    half = "M 0 10 L 8 0 H 24 V 60 H 0"
    found = read(f'<path id="half" d="{half}"/>', '<use href="#half" transform="scale(-1,1)"/>')
    assert sides(found) == (0.48, 0.6)
    assert found.garment.pattern.area == pytest.approx(WHOLE_M2, rel=1e-6)


@pytest.mark.parametrize(
    "other",
    ['<use href="#half" x="-60"/>', '<use href="#half" transform="translate(-10 0) scale(-1 1)"/>'],
)
def test_pieces_that_do_not_share_an_edge_are_not_joined(other: str) -> None:
    found = read(f'<path id="half" d="{HALF}"/>', other)
    assert sides(found) == (0.24, 0.6)
    assert "halves_joined" not in codes(found)


def dxf(made: Drawing) -> Imported:
    text = io.StringIO()
    made.write(text)
    return import_file("front.dxf", text.getvalue().encode())


HALF_MM = [(0, 0), (260, 0), (260, 420), (400, 480), (360, 600), (90, 690), (0, 620)]
HALF_M2 = abs(sum(a * d - b * c for (a, b), (c, d) in zip(HALF_MM, HALF_MM[1:] + HALF_MM[:1], strict=True))) / 2e6


def half_pattern(
    mirror: list[tuple[float, float]], *, is_closed: bool = True, turn_deg: float = 0.0, layer: str = "6"
) -> Drawing:
    """Return a half piece in the form of ASTM D6673, its mirror line on layer 6."""
    made = filemanagement.new("R12")
    block = made.blocks.new("FRONT_M")
    block.add_polyline2d([*HALF_MM, HALF_MM[0]] if is_closed else HALF_MM, dxfattribs={"layer": "1"})
    block.add_polyline2d(mirror, dxfattribs={"layer": layer})
    block.add_line((130, 100), (130, 500), dxfattribs={"layer": "7"})
    block.add_text("SIZE: M", dxfattribs={"layer": "1"})
    made.modelspace().add_text("UNITS: METRIC", dxfattribs={"layer": "1"})
    made.modelspace().add_blockref("FRONT_M", (50, 20), dxfattribs={"rotation": turn_deg})
    return made


@pytest.mark.parametrize("turn_deg", [0.0, 90.0, 33.0])
@pytest.mark.parametrize(
    "mirror", [[(0, 0), (0, 620)], [(0, 620), (0, 0)], [(0.4, 60), (-0.3, 500)], [(0, -40), (0, 300), (0, 660)]]
)
def test_a_sewing_pattern_is_mirrored_over_layer_6(mirror: list[tuple[float, float]], turn_deg: float) -> None:
    found = dxf(half_pattern(mirror, turn_deg=turn_deg))
    assert "piece_unfolded" in codes(found)
    assert found.garment.pattern.area == pytest.approx(2 * HALF_M2, rel=2e-3)
    assert found.graded is None


def test_a_sewing_pattern_whose_mirror_line_is_its_middle_is_whole() -> None:
    made = half_pattern([(130, 0), (130, 640)])
    found = dxf(made)
    assert found.garment.pattern.area == pytest.approx(HALF_M2)
    assert not codes(found) & {"piece_unfolded", "fold_unknown"}


@pytest.mark.parametrize("layer", ["CUT ON FOLD", "Pliure", "BRUCH", "doblez"])
def test_a_layer_named_for_the_fold_is_a_mirror_line_in_any_drawing(layer: str) -> None:
    made = filemanagement.new("R2004")
    made.header["$INSUNITS"] = 4
    made.modelspace().add_lwpolyline(HALF_MM, close=True)
    made.modelspace().add_line((0, 0), (0, 620), dxfattribs={"layer": layer})
    assert dxf(made).garment.pattern.area == pytest.approx(2 * HALF_M2)


def test_a_blue_line_on_a_layer_called_fold_is_a_fold() -> None:
    made = filemanagement.new("R2004")
    made.header["$INSUNITS"] = 4
    made.modelspace().add_lwpolyline(HALF_MM, close=True)
    made.modelspace().add_line((130, 0), (130, 640), dxfattribs={"layer": "PLIURE", "color": 5})
    made.modelspace().add_text("Pliure")
    found = dxf(made)
    assert len(found.garment.folds) == 1 and "fold_unknown" not in codes(found)


@pytest.mark.parametrize("text", ["FRONT - CUT 1 ON FOLD", "pliure", "Im Bruch", "%%uBruch%%u", "{\\fArial|b0;Doblez}"])
def test_a_text_that_says_so_without_a_line_is_passed_on(text: str) -> None:
    made = filemanagement.new("R2004")
    made.header["$INSUNITS"] = 4
    made.modelspace().add_lwpolyline(HALF_MM, close=True)
    (made.modelspace().add_mtext if "{" in text else made.modelspace().add_text)(text)
    assert "fold_unknown" in codes(dxf(made))


def test_a_line_that_ends_square_on_the_fold_goes_on_to_the_other_half() -> None:
    fold = Segment((0.0, 0.0), (math.sqrt(0.5), math.sqrt(0.5)))
    ends = np.array([(0.3, 0.3), (0.5, 0.1)])
    whole = whole_line(ends, fold)
    assert whole is not None
    np.testing.assert_allclose(whole, [(0.1, 0.5), (0.5, 0.1)], atol=1e-9)
