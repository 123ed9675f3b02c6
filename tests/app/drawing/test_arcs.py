"""Arcs of circles in a file are curves of the drawing again; other edges stay as they are."""

import math

import numpy as np
import pytest

from app.drawing.arcs import with_arcs
from app.drawing.drawing import Drawing
from app.drawing.garment_drawing import drawing_of
from app.drawing.ring import ring_of
from app.drawing.solve import solve
from app.files.import_file import import_file
from planner.geometry.region import Region


def drawn(*shapes: str) -> Drawing:
    """Return the drawing of an SVG in centimetres, its edges straight."""
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="60cm" height="40cm" viewBox="0 0 60 40">'
    return drawing_of(import_file("piece.svg", f"{head}{''.join(shapes)}</svg>".encode()).garment)


def area(drawing: Drawing) -> float:
    return float(Region.polygon(ring_of(drawing.outline).points).area)


def bulges(drawing: Drawing) -> list[float]:
    return [corner.curve.across for corner in drawing.outline if corner.curve is not None]


def test_a_circle_becomes_four_quarters() -> None:
    before = drawn('<circle cx="30" cy="20" r="18"/>')
    after = with_arcs(before)
    assert len(before.outline) > 40
    assert [abs(across) for across in bulges(after)] == pytest.approx([math.tan(math.pi / 8) / 2] * 4, rel=0.05)
    assert len(after.outline) == 4
    assert area(after) == pytest.approx(math.pi * 0.18**2, rel=0.01)


@pytest.mark.parametrize("way", ["M 10 10 H 50 A 8 8 0 0 1 50 26 H 10 Z", "M 10 10 V 26 H 50 A 8 8 0 0 0 50 10 Z"])
def test_half_a_circle_between_straight_edges_is_one_curve_whichever_way_it_was_drawn(way: str) -> None:
    after = with_arcs(drawn(f'<path d="{way}"/>'))
    assert len(after.outline) == 4
    (across,) = bulges(after)
    assert abs(across) == pytest.approx(0.5, abs=1e-6)
    assert area(after) == pytest.approx(0.40 * 0.16 + math.pi * 0.08**2 / 2, rel=0.005)


def test_a_notch_and_a_rounded_corner_bend_to_their_own_sides() -> None:
    path = "M 10 10 H 25 A 6 6 0 0 0 37 10 H 50 V 26 A 8 8 0 0 1 42 34 H 10 Z"
    after = with_arcs(drawn(f'<path d="{path}"/>'))
    assert len(after.outline) == 7
    notch, rounded = sorted(bulges(after), key=abs, reverse=True)
    assert abs(notch) == pytest.approx(0.5, abs=1e-6)
    assert rounded == pytest.approx(-math.copysign(math.tan(math.pi / 8) / 2, notch), abs=1e-6)


@pytest.mark.parametrize(
    "shape",
    [
        '<path d="M 10 10 H 50 V 30 H 10 Z"/>',
        '<polygon points="'
        + " ".join(
            f"{30 + 18 * math.cos(math.tau * i / 16)},{20 + 18 * math.sin(math.tau * i / 16)}" for i in range(16)
        )
        + '"/>',
        '<path d="M 10 30 V 15 C 20 2 40 2 50 15 V 30 Z"/>',
        '<ellipse cx="30" cy="20" rx="25" ry="12"/>',
    ],
    ids=["rectangle", "sixteen corners", "Bezier", "ellipse"],
)
def test_what_is_no_arc_stays_as_it_is(shape: str) -> None:
    before = drawn(shape)
    assert with_arcs(before) is before


def test_folds_that_end_on_an_arc_are_tied_to_it() -> None:
    fold = '<line x1="30" y1="2" x2="30" y2="38" stroke="blue"/>'
    after = solve(with_arcs(drawn('<circle cx="30" cy="20" r="18"/>', fold)))
    assert after.problems == ()
    (crease,) = after.drawing.folds
    ends = np.array([crease.start.point, crease.end.point])
    assert np.abs(ends[:, 0] - 0.18).max() < 1e-3
    assert len(bulges(after.drawing)) == 4
