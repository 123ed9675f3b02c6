import io

import numpy as np
import pytest
from ezdxf import filemanagement
from ezdxf._options import options
from ezdxf.document import Drawing

from app.files.import_errors import ImportedFileError, UnitsNeededError
from app.files.import_file import import_file
from app.files.sketch_garment import Imported

SQUARE = [(0, 0), (600, 0), (600, 400), (0, 400)]
MM, NO_UNIT = 4, 0


def drawing(units: int = MM) -> Drawing:
    made = filemanagement.new("R2004")
    made.header["$INSUNITS"] = units
    return made


def saved(made: Drawing) -> bytes:
    """Return a drawing's file, the same on every run: without its time and its identifier."""
    options.write_fixed_meta_data_for_testing = True
    text = io.StringIO()
    made.write(text)
    return text.getvalue().encode()


def read(made: Drawing, units: str | None = None) -> Imported:
    return import_file("piece.dxf", saved(made), units)


def outline(imported: Imported) -> list[tuple[float, float]]:
    return [(round(x, 9), round(y, 9)) for x, y in imported.garment.outline]


def lines(imported: Imported) -> list[tuple[str, list[float], list[float]]]:
    return [(f.kind, np.round(f.start, 9).tolist(), np.round(f.end, 9).tolist()) for f in imported.garment.folds]


def pattern_piece(made: Drawing, width: float, height: float, name: str = "FRONT", x: float = 1000.0) -> None:
    """Write a rectangle in the form of an ASTM D6673 piece: a block with numbered layers, inserted once."""
    block = made.blocks.new(name)
    corners = [(0, 0), (width, 0), (width, height), (0, height), (0, 0)]
    block.add_polyline2d(corners, dxfattribs={"layer": "1", "color": 1})
    block.add_line((width / 2, 0), (width / 2, height), dxfattribs={"layer": "7", "color": 5})  # grain
    block.add_line((0, height / 4), (width, height / 4), dxfattribs={"layer": "14", "color": 5})  # seam
    block.add_line((0, height / 2), (width, height / 2), dxfattribs={"layer": "8", "color": 5})  # drawn only
    block.add_text("PIECE NAME: " + name, dxfattribs={"layer": "1"})
    made.modelspace().add_blockref(name, (x, 50))


def test_a_closed_polyline_is_the_outline_in_the_units_of_the_header() -> None:
    made = drawing()
    made.modelspace().add_lwpolyline(SQUARE, close=True)
    assert outline(read(made)) == [(0.0, 0.0), (0.6, 0.0), (0.6, 0.4), (0.0, 0.4)]


@pytest.mark.parametrize(("code", "unit_m"), [(1, 0.0254), (2, 0.3048), (4, 0.001), (5, 0.01), (6, 1.0), (14, 0.1)])
def test_the_headers_code_says_the_unit(code: int, unit_m: float) -> None:
    made = drawing(code)
    made.modelspace().add_lwpolyline([(0, 0), (3, 0), (3, 2), (0, 2)], close=True)
    found = import_file("piece.dxf", saved(made), None, 0.1 / unit_m).garment
    assert max(x for x, _ in found.outline) == pytest.approx(0.3)


def test_a_plain_file_without_units_asks_for_them_and_takes_them() -> None:
    made = drawing(NO_UNIT)
    made.modelspace().add_lwpolyline(SQUARE, close=True)
    with pytest.raises(UnitsNeededError) as caught:
        read(made)
    assert caught.value.sizes["mm"] == pytest.approx((0.6, 0.4))
    assert sorted(outline(read(made, "mm")))[-1] == (0.6, 0.4)


METRES = 6


def test_a_plain_file_in_metres_is_taken_as_it_is() -> None:
    made = drawing(METRES)
    made.modelspace().add_lwpolyline([(0, 0), (0.6, 0), (0.6, 0.4), (0, 0.4)], close=True)
    assert outline(read(made)) == [(0.0, 0.0), (0.6, 0.0), (0.6, 0.4), (0.0, 0.4)]


def test_a_file_that_says_metres_of_millimetres_asks_for_its_units() -> None:
    made = drawing(METRES)
    made.modelspace().add_lwpolyline(SQUARE, close=True)
    with pytest.raises(UnitsNeededError, match="600 m long") as caught:
        read(made)
    assert caught.value.sizes["mm"] == pytest.approx((0.6, 0.4))
    assert max(x for x, _ in read(made, "mm").garment.outline) == pytest.approx(0.6)


@pytest.mark.parametrize(("is_bent", "told"), [(False, "4 corners."), (True, "at most 0.5 mm off.")])
def test_arcs_are_said_to_be_replaced_and_straight_lines_are_not(is_bent: bool, told: str) -> None:
    made = drawing()
    corners = [(0, 0, 0.2 if is_bent else 0.0), (600, 0, 0), (600, 400, 0), (0, 400, 0)]
    made.modelspace().add_lwpolyline(corners, format="xyb", close=True)
    assert any(note.text.startswith("The outline has") and note.text.endswith(told) for note in read(made).notes)


def test_blue_and_red_lines_are_folds_by_their_colour_that_of_their_layer_or_its_name() -> None:
    made = drawing()
    made.layers.add("marks", color=1)
    space = made.modelspace()
    space.add_lwpolyline(SQUARE, close=True, dxfattribs={"color": 5})
    space.add_line((300, 0), (300, 400), dxfattribs={"color": 5})
    space.add_line((0, 200), (300, 200), dxfattribs={"layer": "marks"})
    space.add_line((150, 200), (150, 400), dxfattribs={"layer": "Fold blue", "color": 3})
    space.add_line((0, 0), (60, 60), dxfattribs={"true_color": 0xB33600})
    space.add_line((0, 10), (60, 60), dxfattribs={"color": 3})
    assert lines(read(made)) == [
        ("blue", [0.3, 0.0], [0.3, 0.4]),
        ("red", [0.0, 0.2], [0.3, 0.2]),
        ("blue", [0.15, 0.2], [0.15, 0.4]),
        ("red", [0.0, 0.0], [0.06, 0.06]),
    ]


def test_of_a_sewing_pattern_layer_1_is_the_outline_and_only_layer_8_carries_folds() -> None:
    made = drawing()
    pattern_piece(made, 600, 400)
    found = read(made)
    assert sorted(outline(found)) == [(0.0, 0.0), (0.0, 0.4), (0.6, 0.0), (0.6, 0.4)]
    assert lines(found) == [("blue", [0.0, 0.2], [0.6, 0.2])]
    assert any("sewing pattern" in note.text for note in found.notes)
    assert any(note.text.startswith("2 lines on its other layers") for note in found.notes)


def test_of_several_pieces_the_largest_is_taken() -> None:
    made = drawing()
    pattern_piece(made, 600, 400)
    pattern_piece(made, 50, 50, "POCKET", 1700.0)
    found = read(made)
    assert sorted(outline(found))[-1] == (0.6, 0.4)
    assert len(found.garment.folds) == 1
    assert any("the pieces FRONT, POCKET; FRONT was taken" in note.text for note in found.notes)
    assert "Fold lines away from the outline were left out: 1." in [note.text for note in found.notes]


@pytest.mark.parametrize(("word", "unit_m"), [("METRIC", 0.001), ("ENGLISH", 0.0254)])
def test_the_text_of_a_style_says_the_units_of_a_sewing_pattern(word: str, unit_m: float) -> None:
    made = drawing(NO_UNIT)
    pattern_piece(made, 60, 40)
    made.modelspace().add_text(f"UNITS: {word}", dxfattribs={"layer": "1"})
    assert max(x for x, _ in read(made).garment.outline) == pytest.approx(60 * unit_m)


def test_inserted_blocks_are_placed_turned_and_scaled() -> None:
    made = drawing()
    bar = made.blocks.new("BAR")
    bar.add_lwpolyline([(0, 0), (20, 0), (20, 10), (0, 10)], close=True)
    outer = made.blocks.new("OUTER")
    outer.add_blockref("BAR", (0, 0), dxfattribs={"rotation": 90})
    made.modelspace().add_blockref("OUTER", (5, 5), dxfattribs={"xscale": 10, "yscale": 10})
    made.modelspace().add_line((5, 105), (-95, 105), dxfattribs={"color": 5})
    found = read(made)
    assert sorted(outline(found)) == [(0.0, 0.0), (0.0, 0.2), (0.1, 0.0), (0.1, 0.2)]
    assert lines(found) == [("blue", [0.1, 0.1], [0.0, 0.1])]


def test_bulges_arcs_and_splines_are_followed() -> None:
    made = drawing()
    # A stadium: a square of 200 between two half circles of radius 100 (a bulge of 1 is half a circle).
    made.modelspace().add_lwpolyline([(0, 0), (200, 0, 0, 0, 1), (200, 200), (0, 200, 0, 0, 1)], close=True)
    assert read(made).garment.pattern.area == pytest.approx(0.04 + np.pi * 0.01, rel=0.01)


def test_loose_lines_and_arcs_that_meet_make_the_outline() -> None:
    made = drawing()
    space = made.modelspace()
    space.add_line((0, 0), (200, 0))
    space.add_line((0, 200), (200, 200))
    space.add_arc((200, 100), 100, 270, 90)
    space.add_arc((0, 100), 100, 90, 270)
    assert read(made).garment.pattern.area == pytest.approx(0.04 + np.pi * 0.01, rel=0.01)


@pytest.mark.parametrize(
    "more",
    [
        [(0, 0, 600, 0)],
        [(600, 0, 0, 0), (0, 400, 0, 0), (600, 400, 600, 0)],
        [(0, 0, 600, 400)],
        [(0, 0.4, 600, 0.3)],
        [(300, -5, 300, 405), (100, 0, 500, 0)],
    ],
    ids=[
        "twice",
        "three of four twice",
        "a line between two corners",
        "twice, nearly",
        "a centre line that overshoots",
    ],
)
def test_edges_drawn_twice_and_lines_across_leave_the_outline_whole(
    more: list[tuple[float, float, float, float]],
) -> None:
    made = drawing()
    sides = [(0, 0, 600, 0), (600, 0.9, 600, 400), (600, 400, 0, 400), (0, 400, 0, 0)]
    for x1, y1, x2, y2 in (*sides, *more):
        made.modelspace().add_line((x1, y1), (x2, y2))
    made.modelspace().add_line((300, 0), (300, 400), dxfattribs={"color": 5})
    found = read(made)
    assert len(found.garment.outline) == 4
    assert found.garment.pattern.area == pytest.approx(0.24, rel=3e-3)
    assert [kind for kind, *_ in lines(found)] == ["blue"]


def test_lines_that_cross_too_often_are_refused() -> None:
    made = drawing()
    for number in range(400):
        made.modelspace().add_line((number, 0), (400 - number, 400))
        made.modelspace().add_line((0, number), (400, 400 - number))
    with pytest.raises(ImportedFileError, match="cross each other more than 20000 times"):
        read(made)


def test_what_is_on_a_layer_that_is_off_is_not_there() -> None:
    made = drawing()
    made.layers.add("notes", color=5).off()
    made.modelspace().add_lwpolyline(SQUARE, close=True)
    made.modelspace().add_line((300, 0), (300, 400), dxfattribs={"layer": "notes"})
    assert read(made).garment.folds == ()


@pytest.mark.parametrize("far", [1e308, -2e12])
def test_a_number_that_cannot_be_reckoned_with_is_refused(far: float) -> None:
    made = drawing()
    made.modelspace().add_lwpolyline([*SQUARE[:3], (0, far)], close=True)
    with pytest.raises(ImportedFileError, match=f"coordinate of {abs(far):.3g} is too large".replace("+", r"\+")):
        read(made)


def test_blocks_that_multiply_are_refused() -> None:
    made = drawing()
    made.blocks.new("B0").add_line((0, 0), (1, 1))
    for number in range(1, 8):
        block = made.blocks.new(f"B{number}")
        for _ in range(10):
            block.add_blockref(f"B{number - 1}", (0, 0))
    made.modelspace().add_blockref("B7", (0, 0))
    with pytest.raises(ImportedFileError, match="more than 1000 blocks inserted"):
        read(made)


def test_a_spline_that_would_take_long_to_find_is_refused() -> None:
    made = drawing()
    made.modelspace().add_spline(fit_points=[(number, number % 7, 0) for number in range(1500)])
    with pytest.raises(ImportedFileError, match="spline in it has more than 1000 points"):
        read(made)


@pytest.mark.parametrize(
    "data",
    [b"", b"hello", b"\x00\x01" * 50, b"AutoCAD Binary DXF\r\n\x1a\x00junk", b"  0\nSECTION\n  2\nENTI", b"0\nEOF\n"],
)
def test_what_is_no_dxf_is_refused_as_such(data: bytes) -> None:
    with pytest.raises(ImportedFileError) as caught:
        import_file("piece.dxf", data)
    assert caught.value.field == "file"
