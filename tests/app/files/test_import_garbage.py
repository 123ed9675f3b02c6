"""Any file is imported, or refused with the field's name: no other error, no warning."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.files.import_file import import_file
from app.files.svg_drawing import svg_drawing
from planner import load_garment
from planner.errors import FoldingError
from tests.app.files.test_dxf_import import drawing, pattern_piece, saved

ALL_OF_SVG = b"""<svg xmlns="http://www.w3.org/2000/svg" width="60cm" height="40cm" viewBox="0 0 60 40">
<style>.a{stroke:#00f}</style><defs><g id="q"><rect x="1" y="2" width="50" height="30" rx="3" ry="2"
transform="rotate(10) scale(1 -1) skewX(3) matrix(1 0 0 1 2 3)"/></g></defs><use href="#q" x="1"/>
<path class="a" d="M 0 0 C 1 2 3 4 5 6 S 7 8 9 1 Q 3 4 5 6 T 7 8 A 3 4 10 0 1 20 20 h 3 v 4 l 1 1 z m 5 5 1 1"/>
<ellipse cx="3" cy="4" rx="9" ry="8"/><polygon points="1,2 3,4 5,9"/>
<line x1="0" y1="10" x2="60" y2="10" style="stroke:hsl(240,100%,50%)"/>
<svg x="2" y="3" width="10" height="10" viewBox="0 0 5 5"><circle r="2"/></svg></svg>"""

HALVES_OF_SVG = b"""<svg xmlns="http://www.w3.org/2000/svg" width="60cm" height="40cm" viewBox="0 0 60 40">
<style>#S path, g > .a[id] {stroke: color(display-p3 0 0 0.2)}</style><rect width="100%" height="100%" fill="#fff"/>
<clipPath id="c"><rect x="1" width="30" height="40"/></clipPath><g id="S" clip-path="url(#c)"><path id="h"
fill="none" d="M 20 5 h 15 v 20 h -15 z"/><use href="#h" transform="translate(40 0) scale(-1 1)"/></g>
<g id="M"><path d="M 20 4 h 16 v 22 h -16"/><path class="cutonfold" stroke="#000" d="M 20 6 h 1 v 18 h -1"/></g>
<path stroke="#000" d="M 40 5 H 55"/><path stroke="#000" d="M 55 5.1 V 30 H 40"/><path stroke="#000" d="M 40 30.1 V 5"/>
</svg>"""


def all_of_dxf() -> bytes:
    made = drawing()
    pattern_piece(made, 600, 400)
    space = made.modelspace()
    space.add_lwpolyline([(0, 0), (600, 0, 0, 0, 0.3), (600, 400), (0, 400)], close=True)
    space.add_spline([(0, 0), (1, 2), (3, 4), (5, 6)])
    space.add_ellipse((5, 5), (30, 0), 0.4)
    space.add_arc((3, 3), 50, 10, 200)
    space.add_line((0, 200), (600, 200), dxfattribs={"color": 5})
    space.add_text("UNITS: METRIC")
    return saved(made)


def half_of_dxf() -> bytes:
    made = drawing()
    for size, by in (("S", 0), ("M", 10)):
        block = made.blocks.new(f"FRONT_{size}")
        corners = [(0, 0), (300 + by, 0), (300 + by, 500), (0, 500)]
        for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
            block.add_line(start, end, dxfattribs={"layer": "1"})
        block.add_line((0, 0), (0, 500), dxfattribs={"layer": "6"})
        block.add_text(f"SIZE: {size}", dxfattribs={"layer": "1"})
        made.modelspace().add_blockref(block.name, (100, 50))
    return saved(made)


BASES = {
    "a.svg": [svg_drawing(load_garment("t-shirt")).encode(), ALL_OF_SVG, HALVES_OF_SVG],
    "a.dxf": [all_of_dxf(), half_of_dxf()],
}
NUMBER = re.compile(rb"-?\d+\.?\d*")
ODD = (
    b"1e308",
    b"-1e308",
    b"nan",
    b"inf",
    b"0",
    b"-1",
    b"1e-320",
    b"",
    b"\xff",
    b"9" * 400,
    b"#00f",
    b"M",
    b"z",
    b"<g>",
)


@pytest.mark.parametrize("filename", BASES)
@settings(max_examples=120, derandomize=True, deadline=None)
@given(data=st.data())
def test_a_file_that_was_damaged_is_imported_or_refused_by_name(filename: str, data: st.DataObject) -> None:
    content = bytearray(data.draw(st.sampled_from(BASES[filename])))
    for _ in range(data.draw(st.integers(1, 3))):
        numbers = list(NUMBER.finditer(content))
        hit = numbers[data.draw(st.integers(0, len(numbers) - 1))]
        start, end = hit.span()
        if data.draw(st.booleans()):
            start = data.draw(st.integers(0, len(content) - 1))
            end = min(len(content), start + data.draw(st.integers(0, 12)))
        content[start:end] = data.draw(st.sampled_from(ODD))
    units = data.draw(st.sampled_from([None, "mm", "m", "in"]))
    try:
        found = import_file(filename, bytes(content), units, data.draw(st.sampled_from([1.0, 0.001, 1000.0])))
    except FoldingError as error:
        assert str(error)
    else:
        assert 3 <= len(found.garment.outline) <= 400


def test_what_the_damage_is_done_to_is_whole() -> None:
    for filename, contents in BASES.items():
        for content in contents:
            assert import_file(filename, content).garment.outline
