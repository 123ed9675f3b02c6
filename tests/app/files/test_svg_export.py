import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.files.import_file import import_file
from app.files.svg_drawing import svg_drawing
from planner import load_garment
from planner.cloth.garment import Garment
from planner.cloth.garment_files import shipped_garment_names
from planner.geometry.pose import Pose2
from tests.builders import fold, garment, rectangle_points


def round_trip(cloth: Garment) -> Garment:
    return import_file("drawing.svg", svg_drawing(cloth).encode()).garment


def require_same(one: Garment, other: Garment) -> None:
    """Compare lengths to a micrometre, and everything else exactly."""
    assert np.allclose(one.outline, other.outline, rtol=0.0, atol=1e-6)
    for a, b in zip(one.folds, other.folds, strict=True):
        assert np.allclose([a.start, a.end], [b.start, b.end], rtol=0.0, atol=1e-6)
        assert (a.name, a.kind, a.grip_radius_m) == (b.name, b.kind, b.grip_radius_m)
    assert (one.name, one.title, one.placement) == (other.name, other.title, other.placement)
    assert (one.areal_density_kg_m2, one.thickness_m) == (other.areal_density_kg_m2, other.thickness_m)
    assert one.grip_radius_m == other.grip_radius_m


@pytest.mark.parametrize("name", shipped_garment_names())
def test_a_garment_comes_back_from_its_drawing_to_a_micrometre(name: str) -> None:
    cloth = load_garment(name)
    require_same(cloth, round_trip(cloth))


def test_a_turn_comes_back_as_a_turn() -> None:
    folds = fold((0.0, 0.15), (0.4, 0.15)), fold((0.1, 0.0), (0.3, 0.0), "turn"), fold((0.2, -0.15), (0.2, 0.0))
    cloth = garment(rectangle_points(0.4, 0.3), *folds)
    require_same(cloth, round_trip(cloth))


@settings(max_examples=60, derandomize=True, deadline=None)
@given(
    x=st.floats(-5.0, 5.0),
    y=st.floats(-5.0, 5.0),
    width=st.floats(0.02, 2.0),
    height=st.floats(0.02, 2.0),
    radius=st.floats(0.01, 9.0),
    name=st.text(st.characters(exclude_categories=["C", "Z"]), min_size=1, max_size=40),
)
def test_any_place_size_and_name_comes_back(
    x: float, y: float, width: float, height: float, radius: float, name: str
) -> None:
    line = fold((x + width / 3, y), (x + width / 3, y + height), name=name, radius_m=radius)
    back = fold((x + width / 2, y), (x + width / 2, y + height), "red", 'second & <last> "one"')
    cloth = garment(rectangle_points(width, height, x, y), line, back, placement=Pose2(0.1, -0.2, 0.3))
    require_same(cloth, round_trip(cloth))


def test_a_title_that_xml_cannot_hold_is_made_to_fit() -> None:
    cloth = replace(garment(rectangle_points(0.4, 0.3)), title="a\x00b\ud800c")
    assert round_trip(cloth).title == "a b c"


def test_a_drawing_says_its_size_in_centimetres_and_shows_the_folds_in_their_colours_with_arrows() -> None:
    # 40 by 30 cm and a margin of 2 cm all round; a fold from (10, 0) up to (10, 30): in SVG y goes down.
    cloth = garment(rectangle_points(0.4, 0.3), fold((0.1, 0.0), (0.1, 0.3)), fold((0.25, 0.0), (0.25, 0.3), "red"))
    root = ET.fromstring(svg_drawing(cloth))
    assert (float(root.attrib["width"].removesuffix("cm")), root.attrib["height"][-2:]) == (44.0, "cm")
    assert [float(number) for number in root.attrib["viewBox"].split()] == [-2.0, -32.0, 44.0, 34.0]
    outline, blue, red = root.findall("./{*}g/{*}path")
    assert [float(part) for part in blue.attrib["d"].split() if part not in "ML"] == [10.0, 0.0, 10.0, -30.0]
    assert (blue.attrib["stroke"], red.attrib["stroke"]) == ("#0047a3", "#b33600")
    assert blue.attrib["marker-end"] == "url(#blue-arrow)"
    assert "stroke-dasharray" in red.attrib
    assert outline.attrib["d"].endswith("Z")


def test_what_a_drawing_keeps_beside_its_lines_is_left_out_when_it_makes_no_sense() -> None:
    text = svg_drawing(load_garment("t-shirt")).replace('"areal_density_kg_m2": 0.16', '"areal_density_kg_m2": -1')
    found = import_file("drawing.svg", text.encode())
    assert found.garment.areal_density_kg_m2 == 0.2
    assert any("could not be read" in note.text for note in found.notes)
