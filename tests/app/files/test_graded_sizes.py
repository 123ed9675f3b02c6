"""Patterns in several sizes: one is taken by its name, and none is the seam line of another."""

import io
import math
from itertools import pairwise

import numpy as np
import pytest
from ezdxf import filemanagement
from ezdxf.document import Drawing

from app.files.import_errors import ImportedFileError
from app.files.import_file import import_file
from app.files.piece_labels import in_order, size_in
from app.files.pieces import Pieces
from app.files.sketch_garment import Imported

GROWTH_MM: dict[str, float] = {"S": -10, "M": 0, "L": 10}


def pattern(sizes: dict[str, float], *, sample: str | None = None, say: bool = True, seams: bool = False) -> Drawing:
    """Return pieces of 500 by 700 mm that grow by so much on all sides, upon each other, in the form of ASTM D6673."""
    made = filemanagement.new("R12")
    space = made.modelspace()
    space.add_text("UNITS: METRIC", dxfattribs={"layer": "1"})
    if sample:
        space.add_text(f"SAMPLE SIZE: {sample}", dxfattribs={"layer": "1"})
    for size, by in sizes.items():
        block = made.blocks.new(f"BACK_{size}")
        x, y = 250 + by, 350 + by
        block.add_polyline2d([(-x, -y), (x, -y), (x, y), (-x, y), (-x, -y)], dxfattribs={"layer": "1"})
        block.add_line((-x, 0), (x, 0), dxfattribs={"layer": "8", "color": 5})
        if seams:
            x, y = x - 6, y - 6
            block.add_polyline2d([(-x, -y), (x, -y), (x, y), (-x, y), (-x, -y)], dxfattribs={"layer": "14"})
        if say:
            block.add_text(f"SIZE: {size}", dxfattribs={"layer": "1"})
        space.add_blockref(block.name, (0, 0), dxfattribs={"layer": "1"})
    return made


def read(made: Drawing, size: str | None = None, piece: str | None = None) -> Imported:
    text = io.StringIO()
    made.write(text)
    return import_file("back.dxf", text.getvalue().encode(), size=size, piece=piece)


def sides(imported: Imported) -> tuple[float, float]:
    width, height = np.ptp(np.array(imported.garment.outline), axis=0).tolist()
    return (round(width, 6), round(height, 6))


@pytest.mark.parametrize("say", [True, False], ids=["by text", "by the block's name"])
def test_the_sizes_of_a_pattern_are_listed_and_the_middle_one_is_taken(say: bool) -> None:
    found = read(pattern(GROWTH_MM, say=say))
    assert found.graded is not None
    assert (found.graded.size, found.graded.sizes) == ("M", ("S", "M", "L"))
    assert sides(found) == (0.5, 0.7) and found.allowance is None
    assert len(found.garment.folds) == 1
    assert any("sizes S, M, L; size M was taken" in note.text for note in found.notes)


@pytest.mark.parametrize(("size", "wide"), [("S", 0.48), ("l", 0.52), (" m ", 0.5)])
def test_a_size_is_taken_by_its_name(size: str, wide: float) -> None:
    found = read(pattern(GROWTH_MM), size)
    assert sides(found)[0] == wide
    assert len(found.garment.folds) == 1


def test_the_sample_size_is_taken_where_the_pattern_names_one() -> None:
    assert sides(read(pattern({"36": -20, "38": -10, "40": 0, "42": 10}, sample="40"))) == (0.5, 0.7)
    assert sides(read(pattern(GROWTH_MM, sample="XL"))) == (0.5, 0.7)


@pytest.mark.parametrize("is_closed", [True, False], ids=["closed lines", "open lines"])
def test_pieces_in_blocks_that_lie_over_each_other_are_told_by_their_blocks(is_closed: bool) -> None:
    made = filemanagement.new("R12")
    made.modelspace().add_text("UNITS: METRIC", dxfattribs={"layer": "1"})
    for name, x, y in (("BACK", 200, 300), ("SLEEVE", 150, 250), ("YOKE", 280, 100)):
        block = made.blocks.new(name)
        ring = [(-x, -y), (x, -y), (x, y), (-x, y), (-x, -y)]
        block.add_line((-x, 0), (x, 0), dxfattribs={"layer": "8", "color": 5})
        if is_closed:
            block.add_polyline2d(ring, dxfattribs={"layer": "1"})
        for start, end in () if is_closed else pairwise(ring):
            block.add_line(start, end, dxfattribs={"layer": "1"})
        if name == "YOKE":
            block.add_line((0, -y), (0, y), dxfattribs={"layer": "6"})
        made.modelspace().add_blockref(name, (0, 0), dxfattribs={"layer": "1"})
    assert read(made).pieces == Pieces("BACK", ("BACK", "SLEEVE", "YOKE"))
    for piece, size in (("BACK", (0.4, 0.6)), ("sleeve", (0.3, 0.5)), ("YOKE", (0.56, 0.2))):
        found = read(made, piece=piece)
        assert sides(found) == size
        (fold,) = found.garment.folds
        assert math.dist(fold.start, fold.end) == pytest.approx(size[0])


@pytest.mark.parametrize("size", ["XL", "", "40"])
def test_a_size_that_is_not_there_is_refused_with_the_list(size: str) -> None:
    with pytest.raises(ImportedFileError, match="one of S, M, L") as caught:
        read(pattern(GROWTH_MM), size)
    assert caught.value.field == "size"


def test_a_size_of_a_drawing_in_one_size_is_refused() -> None:
    with pytest.raises(ImportedFileError, match="has one size") as caught:
        read(pattern({"M": 0}), "M")
    assert caught.value.field == "size"


def test_layers_of_a_plain_drawing_may_be_sizes() -> None:
    made = filemanagement.new("R2004")
    made.header["$INSUNITS"] = 4
    for size, by in GROWTH_MM.items():
        made.modelspace().add_lwpolyline(
            [(-by, -by), (500 + by, -by), (500 + by, 700 + by), (-by, 700 + by)],
            close=True,
            dxfattribs={"layer": f"Size {size}"},
        )
    assert sides(read(made, "S")) == (0.48, 0.68)


def svg(label: str, sizes: list[str], extra: str = "") -> bytes:
    groups = []
    for number, size in enumerate(sizes):
        by = number - 1
        rect = f'<rect x="{10 - by}" y="{10 - by}" width="{50 + 2 * by}" height="{70 + 2 * by}"/>'
        fold = f'<line x1="{10 - by}" y1="45" x2="{60 + by}" y2="45" stroke="blue"/>'
        groups.append(f"<g {label.format(size)}>{rect}<g>{fold}</g></g>")
    head = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:i="urn:i" width="90cm" height="90cm" viewBox="0 0 90 90">'
    return f'{head}<g fill="none" stroke="black">{"".join(groups)}{extra}</g></svg>'.encode()


@pytest.mark.parametrize(
    "label", ['id="{}"', 'i:label="Size {}"', 'id="back-{}"', 'class="size-{}"', 'data-name="Größe {}"', 'id="{}_back"']
)
def test_groups_of_an_svg_may_be_sizes(label: str) -> None:
    data = svg(label, ["XS", "M", "XL"])
    assert sides(import_file("back.svg", data)) == (0.5, 0.7)
    large = import_file("back.svg", data, size="xl")
    assert sides(large) == (0.52, 0.72) and len(large.garment.folds) == 1


def test_what_is_of_no_size_belongs_to_all() -> None:
    line = '<line x1="35" y1="9" x2="35" y2="81" stroke="blue"/>'
    found = import_file("back.svg", svg('id="_{}"', ["38", "40", "42"], line), size="42")
    assert sides(found) == (0.52, 0.72) and len(found.garment.folds) == 2


def test_the_size_counts_where_units_are_asked_for_too() -> None:
    data = svg('id="{}"', ["S", "M", "L"]).replace(b'width="90cm" height="90cm"', b"")
    found = import_file("back.svg", data, "cm", size="L")
    assert sides(found) == (0.52, 0.72)
    assert found.sizes is not None and found.sizes["cm"] == pytest.approx((0.52, 0.72))


def test_a_cut_line_and_a_seam_line_are_still_told_from_each_other() -> None:
    rects = '<rect x="1" y="1" width="60" height="80"/><rect x="2" y="2" width="58" height="78"/>'
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="90cm" height="90cm" viewBox="0 0 90 90">'
    found = import_file("back.svg", f'{head}<g fill="none" stroke="black">{rects}</g></svg>'.encode())
    assert found.graded is None and found.allowance is not None
    assert sides(found) == (0.58, 0.78)


def test_three_lines_inside_each_other_without_names_have_no_seam_line() -> None:
    rects = "".join(
        f'<rect x="{5 - by}" y="{5 - by}" width="{50 + 2 * by}" height="{70 + 2 * by}"/>' for by in range(3)
    )
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="90cm" height="90cm" viewBox="0 0 90 90">'
    found = import_file("back.svg", f'{head}<g fill="none" stroke="black">{rects}</g></svg>'.encode())
    assert found.allowance is None and sides(found) == (0.54, 0.74)
    assert any("2 other closed lines" in note.text for note in found.notes)


@pytest.mark.parametrize(
    ("label", "size"),
    [
        ("SIZE: M", "M"),
        ("Size 38", "38"),
        ("Größe XL", "XL"),
        ("back_2XL", "2XL"),
        ("Taille: 40", "40"),
        ("40", "40"),
        ("m-front", "M"),
        ("path38", None),
        ("path-38", None),
        ("sleeve", None),
        ("small", None),
        ("", None),
        ("resize", None),
    ],
)
def test_a_label_names_a_size(label: str, size: str | None) -> None:
    assert size_in(label) == size


def test_sizes_are_listed_from_small_to_large() -> None:
    assert in_order({"L", "XXS", "M", "2XL", "S", "XL", "XS"}) == ["XXS", "XS", "S", "M", "L", "XL", "2XL"]
    assert in_order({"44", "8", "36"}) == ["8", "36", "44"]
