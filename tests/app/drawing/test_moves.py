"""Pulling a corner keeps the folds legal."""

import math
from dataclasses import replace

import pytest

from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from planner import load_garment
from planner.cloth.garment import DrawnFold
from planner.errors import FoldError
from planner.folds.fold_sequence import FoldSequence
from tests.app.drawing.drawings import pulled
from tests.sweep import sweep

NINE = ["t-shirt", "jeans", "shirt", "tie", "scarf", "vest", "skirt", "big-towel", "hand-towel"]
MOVE_M = 0.01


def moves() -> list[tuple[float, float]]:
    return [(MOVE_M * math.cos(i * math.pi / 4), MOVE_M * math.sin(i * math.pi / 4)) for i in range(8)]


@sweep("name", NINE, ("t-shirt", "tie", "hand-towel"))
def test_no_corner_pulled_by_a_centimetre_makes_a_fold_illegal(name: str) -> None:
    drawing = solve(drawing_of(load_garment(name))).drawing
    for corner in range(len(drawing.outline)):
        for dx_m, dy_m in moves():
            moved = solve(pulled(drawing, corner, dx_m, dy_m))
            assert moved.problems == (), (corner, dx_m, dy_m)


@pytest.mark.parametrize("name", ["t-shirt", "jeans", "letter-towel"])
def test_what_was_solved_is_legal_for_the_planner_too(name: str) -> None:
    drawing = solve(drawing_of(load_garment(name))).drawing
    for corner in range(len(drawing.outline)):
        garment = solve(pulled(drawing, corner, -MOVE_M, MOVE_M)).garment
        assert garment is not None
        for drawn, fold in zip(garment.folds, FoldSequence.of(garment).folds, strict=True):
            assert fold.line.start == pytest.approx(drawn.start, abs=2e-5)
            assert fold.line.end == pytest.approx(drawn.end, abs=2e-5)


def test_as_points_they_would_be_illegal() -> None:
    """Without ties the ends of its folds stay where they were, and nearly every other pulled T-shirt is illegal."""
    garment = load_garment("t-shirt")
    illegal = 0
    for corner, (x, y) in enumerate(garment.outline):
        for dx_m, dy_m in moves():
            outline = list(garment.outline)
            outline[corner] = (x + dx_m, y + dy_m)
            try:
                FoldSequence.of(replace(garment, outline=tuple(outline)))
            except FoldError:
                illegal += 1
    assert illegal > 20


def test_a_fold_keeps_to_its_part_of_the_cloth_when_a_corner_is_pulled() -> None:
    """The T-shirt's sleeves end at the armpit and the shoulder, wherever those are."""
    drawing = solve(drawing_of(load_garment("t-shirt"))).drawing
    moved = solve(pulled(drawing, 1, 0.03, -0.02))
    sleeve: DrawnFold = moved.garment.folds[0]  # type: ignore[union-attr]
    assert sleeve.start == pytest.approx((0.03, 0.419 - 0.02))
    assert sleeve.end == (0.0, 0.61)
