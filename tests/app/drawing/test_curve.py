"""An edge pulled into a curve: the polygon that stands for it, the folds on it, its form in files."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from app.drawing.curve import CURVE_TOLERANCE_M, Curve, Ellipse
from app.drawing.draft import draft_of
from app.drawing.drawing import Corner, Crease, Drawing, EdgeTie, End
from app.drawing.drawing_json import drawing_from_dict, drawing_to_dict
from app.drawing.garment_drawing import garment_to_dict
from app.drawing.quick_fixes import quick_fixes
from app.drawing.ring import reordered, ring_of
from app.drawing.solve import garment_of, solve
from app.files.import_file import import_file
from app.files.svg_drawing import svg_drawing
from planner.cloth.garment import Garment
from planner.cloth.outline import POINTS_MAX
from planner.errors import FieldError
from planner.geometry.region import Region
from tests.app.drawing.drawings import crease, towel_drawing, with_corner

SEMICIRCLE = Curve(0.0, -0.5)
"""Out of a counter-clockwise outline, by half the chord."""

parts = st.floats(-1.5, 1.5)
points = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))


def curved(drawing: Drawing, **curves: Curve | None) -> Drawing:
    """Return the drawing with other curves, by the ids of the corners at which their edges begin."""
    outline = (replace(corner, curve=curves.get(corner.id, corner.curve)) for corner in drawing.outline)
    return replace(drawing, outline=tuple(outline))


def arch(*folds: Crease) -> Drawing:
    """Return a towel of 0.4 x 0.3 m whose far edge, v2 -> v3 along y = 0.3, is a semicircle."""
    return curved(replace(towel_drawing(), folds=folds), v2=SEMICIRCLE)


def test_a_semicircle_has_the_area_of_half_a_disc() -> None:
    area = Region.polygon(ring_of(arch().outline).points).area
    assert area == pytest.approx(0.4 * 0.3 + math.pi * 0.2**2 / 2, rel=5e-3)


@given(along=parts, across=parts, x=st.floats(0.05, 3.0))
def test_points_are_within_the_tolerance_of_the_curve_and_its_handle_is_on_it(
    along: float, across: float, x: float
) -> None:
    curve, ends = Curve(along, across), ((0.1, 0.2), (0.1 + x, 0.5))
    points = np.array([ends[0], *curve.points(*ends), ends[1]])
    ellipse = Ellipse.of(curve, *ends)
    fine = ellipse.at(np.linspace(-ellipse.half_angle_rad, ellipse.half_angle_rad, 2001))
    assert np.allclose(fine[[0, 1000, 2000]], [ends[0], curve.handle(*ends), ends[1]], atol=1e-6)
    a, b = points[:-1, None], points[1:, None]
    along_piece = np.clip(((fine - a) * (b - a)).sum(-1) / ((b - a) ** 2).sum(-1), 0.0, 1.0)
    off = np.hypot(*np.moveaxis(a + along_piece[..., None] * (b - a) - fine, -1, 0)).min(axis=0)
    is_smooth = abs(across) > 0.1 and abs(along) < 0.5 and x > 0.2  # no points nearer than 2 mm were left out
    assert off.max() <= (CURVE_TOLERANCE_M + 1e-9 if is_smooth else 3e-3)


@given(along=parts, across=parts)
def test_the_curve_of_the_edge_turned_round_is_the_same(along: float, across: float) -> None:
    a, b = (0.0, 0.0), (0.5, 0.2)
    there, back = Curve(along, across).points(a, b), Curve(along, across).turned.points(b, a)
    assume(abs(across) > 0.1)  # nothing is left out
    assert np.array(there) == pytest.approx(np.array(back[::-1]), abs=1e-9)


def test_a_fold_across_a_curve_stays_on_it_when_the_curve_is_pulled_further() -> None:
    drawing = solve(arch(crease("half", (0.2, 0.5), (0.2, 0.0)))).drawing
    top = drawing.folds[0].start
    assert isinstance(top.tie, EdgeTie)
    assert (top.tie.start, top.tie.end) == ("v2", "v3")
    assert top.tie.fraction == pytest.approx(0.5)
    flatter = solve(curved(drawing, v2=Curve(0.0, -0.25)))
    assert flatter.problems == ()
    assert flatter.drawing.folds[0].start.point == pytest.approx((0.2, 0.4))
    straight = solve(curved(drawing, v2=None))
    assert straight.drawing.folds[0].start.point == pytest.approx((0.2, 0.3))


def test_a_corner_pulled_keeps_the_form_of_its_curves() -> None:
    wider = with_corner(arch(), 2, (0.6, 0.3))
    highest = max(y for _, y in ring_of(wider.outline).points)
    assert highest == pytest.approx(0.3 + 0.3)  # a semicircle over 0.6 m


@given(along=st.floats(-0.3, 0.3), across=st.floats(-0.6, -0.05), x=st.floats(0.05, 0.35))
def test_solved_again_it_is_the_same(along: float, across: float, x: float) -> None:
    folds = (crease("up", End((x, 0.9)), End((x, 0.0))), crease("over", End((0.0, 0.1)), End((0.4, 0.1))))
    once = solve(replace(curved(towel_drawing(), v2=Curve(along, across)), folds=folds)).drawing
    assert solve(once).drawing == once


def test_json_keeps_curves_and_has_none_for_straight_edges() -> None:
    drawing = draft_of(curved(arch(), v0=Curve(0.1, 0.2))).drawing
    data = json.loads(json.dumps(drawing_to_dict(drawing)))
    assert drawing_from_dict(data) == drawing
    assert [sorted(corner) for corner in data["outline"]] == [
        ["curve", "id", "point"],
        ["id", "point"],
        ["curve", "id", "point"],
        ["id", "point"],
    ]
    data["outline"][2]["curve"] = {"across": 0.0}
    assert drawing_from_dict(data).outline[2].curve is None
    data["outline"][2]["curve"] = {"across": 2.5}
    with pytest.raises(FieldError, match="across"):
        drawing_from_dict(data)


def test_a_garment_file_has_the_polygon() -> None:
    drawing = solve(arch()).drawing
    garment = Garment.from_dict(garment_to_dict(drawing))
    assert garment == garment_of(drawing)
    assert len(garment.outline) > 10


def test_the_svg_has_an_arc_and_is_read_again_as_the_same_shape() -> None:
    drawing = solve(curved(arch(crease("half", (0.2, 0.5), (0.2, 0.0))), v0=Curve(0.2, 0.15))).drawing
    text = svg_drawing(garment_of(drawing), drawing.outline)
    assert "A 20.000000 20.000000 " in text
    read = import_file("arch.svg", text.encode()).garment
    before, after = Region.polygon(ring_of(drawing.outline).points), Region.polygon(read.outline)
    apart = before.difference(after).area + after.difference(before).area
    assert apart < 2 * CURVE_TOLERANCE_M * 1.5  # along its rim of less than 1.5 m
    assert len(read.folds) == 1


def test_curves_that_cross_are_found_by_their_edges_and_can_be_straightened() -> None:
    """The near edge pulled up through the far one."""
    draft = draft_of(curved(towel_drawing(), v0=Curve(0.0, 0.9)))
    problem = draft.solution.problems[0]
    assert problem.code == "outline_crosses"
    assert problem.says is not None
    assert problem.says.values["edges"] == [0, 3]  # a circle's arc of 0.36 m height is wider than its chord
    fixes = quick_fixes(draft)
    assert fixes[0].says.code == "straighten"
    assert solve(fixes[0].drawing).problems == ()


def test_corners_in_another_order_keep_the_curves_between_them() -> None:
    a, b, c, d = (Corner(name, (0.0, 0.0)) for name in "abcd")
    a, c = replace(a, curve=Curve(0.1, 0.2)), replace(c, curve=Curve(0.3, -0.4))
    after = reordered((b, a, c, d), (a, b, c, d))
    assert [corner.curve for corner in after] == [Curve(-0.1, -0.2), None, Curve(0.3, -0.4), None]


def test_many_curves_have_fewer_points_each_so_that_a_garment_may_have_them() -> None:
    count = 60
    ring = [(2.0 * math.cos(math.tau * i / count), 2.0 * math.sin(math.tau * i / count)) for i in range(count)]
    outline = tuple(Corner(f"v{i}", point, SEMICIRCLE) for i, point in enumerate(ring))
    assert sum(len(SEMICIRCLE.points(p, ring[(i + 1) % count])) for i, p in enumerate(ring)) > POINTS_MAX
    assert len(ring_of(outline).points) <= POINTS_MAX
