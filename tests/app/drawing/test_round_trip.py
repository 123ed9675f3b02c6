"""From a file to a drawing and back, and from a drawing to JSON and back, nothing changes."""

import json
import math
from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from app.drawing.draft import draft_of
from app.drawing.drawing import ChordTie, CornerTie, CreaseTie, EdgeTie, End
from app.drawing.drawing_json import drawing_from_dict, drawing_to_dict
from app.drawing.garment_drawing import drawing_of, garment_to_dict
from app.drawing.place_crease import along_line
from app.drawing.solve import garment_of, solve
from planner import load_garment, shipped_garment_names
from planner.cloth.garment import Garment
from planner.errors import FieldError, GarmentError, RequestError
from planner.geometry.segment import Segment
from tests.app.samples import towel

unit = st.floats(-1.0, 1.0)


@st.composite
def folded_garments(draw: st.DrawFn) -> Garment:
    """Random outlines round the origin with up to three legal folds along random lines."""
    reach = draw(st.lists(st.floats(0.15, 0.5), min_size=4, max_size=8))
    turns = [math.tau * i / len(reach) for i in range(len(reach))]
    outline = [[r * math.cos(a), r * math.sin(a)] for r, a in zip(reach, turns, strict=True)]
    garment = Garment.from_dict(towel(outline=outline, folds=[]))
    drawing = drawing_of(garment)
    for _ in range(draw(st.integers(0, 3))):
        turn, x, y = math.pi * draw(unit), 0.2 * draw(unit), 0.2 * draw(unit)
        guide = Segment((x, y), (x + math.cos(turn), y + math.sin(turn)))
        try:
            line = along_line(solve(drawing), None, guide, "blue").line
            drawn = {"name": "", "kind": "blue", "start": list(line.start), "end": list(line.end)}
            file = {**garment.to_dict(), "folds": [*garment.to_dict()["folds"], drawn]}
            garment = Garment.from_dict(file)
            drawing = drawing_of(garment)
        except (RequestError, GarmentError):
            continue
    assume(not solve(drawing).problems)
    return garment


@given(garment=folded_garments())
def test_a_garment_that_is_opened_and_saved_is_the_same(garment: Garment) -> None:
    solution = solve(drawing_of(garment))
    assert solution.problems == ()
    assert garment_of(solution.drawing) == garment


@given(garment=folded_garments())
def test_a_drawing_that_is_solved_again_is_the_same(garment: Garment) -> None:
    once = solve(drawing_of(garment)).drawing
    assert all(end.tie is not None for fold in once.folds for end in fold.ends)
    assert solve(once).drawing == once


@given(garment=folded_garments())
def test_a_drawing_read_from_its_json_is_the_same(garment: Garment) -> None:
    drawing = draft_of(drawing_of(garment)).drawing
    assert drawing_from_dict(json.loads(json.dumps(drawing_to_dict(drawing)))) == drawing


@pytest.mark.parametrize("name", shipped_garment_names())
def test_a_shipped_garment_stays_as_it_is_but_for_ends_that_are_off_the_boundary(name: str) -> None:
    """Ends on the boundary keep their numbers; ends off it are put onto it, and then stay."""
    garment = load_garment(name)
    saved = Garment.from_dict(garment_to_dict(solve(drawing_of(garment)).drawing))
    for before, after in zip(garment.folds, saved.folds, strict=True):
        assert math.dist(before.start, after.start) < 1e-3
        assert math.dist(before.end, after.end) < 1e-3
    assert replace(saved, folds=()) == replace(garment, folds=())
    again = Garment.from_dict(garment_to_dict(solve(drawing_of(saved)).drawing))
    assert again == saved


def test_the_t_shirt_stays_as_it_is_to_the_last_digit() -> None:
    garment = load_garment("t-shirt")
    assert garment_to_dict(solve(drawing_of(garment)).drawing) == garment.to_dict()


def test_every_kind_of_tie_is_read_as_it_was_written() -> None:
    drawing = drawing_of(Garment.from_dict(towel()))
    ties = (CornerTie("v0"), EdgeTie("v1", "v2", 0.25), CreaseTie("f0", 0.5, ("f1",)), ChordTie(), None)
    fold = drawing.folds[0]
    for tie in ties:
        drawn = replace(drawing, folds=(replace(fold, start=End((0.1, 0.2), tie), twin=None),))
        assert drawing_from_dict(json.loads(json.dumps(drawing_to_dict(drawn)))) == drawn


def test_corners_and_folds_without_names_are_given_some() -> None:
    data = drawing_to_dict(drawing_of(Garment.from_dict(towel())))
    for corner in data["outline"][1:]:
        del corner["id"]
    data["outline"][0]["id"] = "v1"
    data["folds"][0]["id"] = None
    drawing = drawing_from_dict(data)
    assert [corner.id for corner in drawing.outline] == ["v1", "v0", "v2", "v3"]
    assert drawing.folds[0].id == "f0"


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"colour": "red"}, "colour"),
        ({"outline": [{"id": "a", "point": [0, 0]}, {"id": "a", "point": [1, 0]}]}, "outline[1].id"),
        ({"outline": [{"id": "a b", "point": [0, 0]}]}, "outline[0].id"),
        ({"outline": [{"point": [0, 11]}]}, "outline[0].point[1]"),
        ({"outline": [{"point": [0, 0]}] * 401}, "outline"),
        ({"areal_density_kg_m2": "1"}, "areal_density_kg_m2"),
        ({"thickness_m": 0.03}, "thickness_m"),
        ({"scene": {"friction": -1}}, "scene.friction"),
        ({"name": "My towel"}, "name"),
        ({"comfort_radius_m": 0.2}, "comfort_radius_m"),
    ],
)
def test_what_is_no_drawing_is_refused_by_its_field(change: dict[str, object], field: str) -> None:
    data = {**drawing_to_dict(drawing_of(Garment.from_dict(towel()))), **change}
    with pytest.raises(FieldError) as refused:
        drawing_from_dict(data)
    assert refused.value.field == field


def test_a_twin_that_is_not_there_is_forgotten() -> None:
    data = drawing_to_dict(drawing_of(Garment.from_dict(towel())))
    data["folds"][0]["twin"] = "f7"
    assert drawing_from_dict(data).folds[0].twin is None
