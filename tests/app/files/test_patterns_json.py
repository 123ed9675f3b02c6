"""Patterns as JSON: panels of GarmentCode, of which one is the garment, and crease patterns in the FOLD format."""

import json
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import pytest

from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from app.files.fold_format import fold_format
from app.files.import_errors import ImportedFileError, UnitsNeededError
from app.files.import_file import import_file
from app.files.sketch_garment import Imported
from planner import load_garment

Corners: TypeAlias = Sequence[Sequence[float]]
SQUARE: Corners = [[0, 0], [40, 0], [40, 60], [0, 60]]


def loop(count: int, **bends: Any) -> list[dict[str, Any]]:
    """Return the edges of a panel with so many corners, some of them bent."""
    edges: list[dict[str, Any]] = [{"endpoints": [n, (n + 1) % count]} for n in range(count)]
    for name, bend in bends.items():
        edges[int(name.removeprefix("edge"))]["curvature"] = bend
    return edges


def panel(vertices: Corners, **bends: Any) -> dict[str, Any]:
    placed = {"translation": [0, 100, 20], "rotation": [0, 0, 0]}
    return {**placed, "vertices": vertices, "edges": loop(len(vertices), **bends)}


def read(panels: dict[str, Any], stitches: list[Any] = [], piece: str | None = None) -> Imported:  # noqa: B006
    pattern = {"pattern": {"panels": panels, "stitches": stitches}, "properties": {"units_in_meter": 100}}
    return import_file("shirt_specification.json", json.dumps(pattern).encode(), piece=piece)


def sides(imported: Imported) -> list[float]:
    width, height = np.ptp(np.array(imported.garment.outline), axis=0).round(4).tolist()
    return [width, height]


def test_each_panel_is_a_piece_and_one_is_taken_by_its_name() -> None:
    small: Corners = [[0, 0], [20, 0], [20, 15], [0, 15]]
    panels = {"pocket": panel(small), "front": panel(SQUARE), "cuff": panel([[0, 0], [25, 0], [25, 8], [0, 8]])}
    found = read(panels)
    assert found.pieces is not None
    assert (found.pieces.piece, found.pieces.pieces) == ("front", ("front", "pocket", "cuff"))
    assert sides(found) == [0.4, 0.6]
    assert any("pieces front, pocket, cuff; front was taken" in note.text for note in found.notes)
    assert sides(read(panels, piece="Pocket")) == [0.2, 0.15]
    with pytest.raises(ImportedFileError, match="expected one of front, pocket, cuff; got 'sleeve'") as refused:
        read(panels, piece="sleeve")
    assert refused.value.field == "piece"


@pytest.mark.parametrize("is_reversed", [False, True])
def test_a_left_and_a_right_half_that_are_sewn_along_a_straight_edge_are_one_piece(is_reversed: bool) -> None:
    left: Corners = [[0, 0], [20, 0], [20, 50], [4, 60]]  # sewn along the edge from the second corner to the third
    right: Corners = [[30, 5], [10, 5], [10, 55], [26, 65]]  # its mirror image, and shifted
    if is_reversed:  # the same edge is the second one then, too
        right = [right[3], *right[2:0:-1], right[0]]
    stitches = [[{"panel": "right_torso", "edge": 1}, {"panel": "left_torso", "edge": 1}]]
    found = read({"left_torso": panel(left), "right_torso": panel(right)}, stitches)
    assert sides(found) == [0.4, 0.6]
    apart = read({"left_torso": panel(left), "right_torso": panel(right)})
    assert apart.pieces is not None and len(apart.pieces.pieces) == 2


@pytest.mark.parametrize(
    ("bend", "height"),
    [
        ([0.5, -0.5], 0.7),
        ({"type": "quadratic", "params": [[0.5, -0.5]]}, 0.7),
        ({"type": "cubic", "params": [[0.0, -0.4], [1.0, -0.4]]}, 0.72),
        ({"type": "circle", "params": [20.0, False, True]}, 0.8),
    ],
    ids=["a pair of numbers", "quadratic", "cubic", "an arc"],
)
def test_bent_edges_bulge_as_the_specification_says(bend: Any, height: float) -> None:
    """A control point lies to the left of its edge: below zero is outside of a panel that goes round to the left."""
    found = read({"front": panel(SQUARE, edge0=bend)})
    assert sides(found) == pytest.approx([0.4, height], abs=2e-3)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"edges": loop(3)[:2]}, "panels.front.edges"),
        (
            {"edges": [{"endpoints": [0, 9]}, *loop(4)[1:]]},
            "edge 0 of panel 'front' is not valid: there is no vertex",
        ),
        ({"edges": [loop(4)[0], loop(4)[2], loop(4)[1], loop(4)[3]]}, "edge 1 of panel 'front'"),
        ({"vertices": [[0, 0], [40, 0], ["a", 60], [0, 60]]}, "panels.front.vertices"),
    ],
)
def test_what_is_wrong_with_a_panel_is_said(change: dict[str, Any], told: str) -> None:
    with pytest.raises(ImportedFileError, match="pattern specification") as refused:
        read({"front": panel(SQUARE) | change})
    assert told in str(refused.value)


def creases(**fields: Any) -> bytes:
    """Return a square of half a metre with a valley fold across, and one that ends within it, in the FOLD format."""
    corners = [[0, 0], [0.25, 0], [0.5, 0], [0.5, 0.5], [0.25, 0.5], [0, 0.5], [0.25, 0.25], [0.4, 0.25]]
    edges = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 0], [1, 6], [6, 4], [6, 7]]
    kinds = ["B", "B", "B", "B", "B", "B", "V", "V", "M"]
    whole = {"file_spec": 1.2, "frame_unit": "m", "vertices_coords": corners, "edges_vertices": edges}
    return json.dumps({**whole, "edges_assignment": kinds, **fields}).encode()


@pytest.mark.parametrize("name", ["square.fold", "square.json"])
def test_creases_from_edge_to_edge_are_folds_and_others_are_told_of(name: str) -> None:
    found = import_file(name, creases())
    assert (found.format, sides(found)) == (name.rpartition(".")[2], [0.5, 0.5])
    (fold,) = found.garment.folds
    assert {fold.start, fold.end} == {(0.25, 0.0), (0.25, 0.5)}
    assert any("do not run from edge to edge were left out: 1" in note.text for note in found.notes)


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({"vertices_coords": [[0, 0]]}, "vertices_coords"),
        ({"edges_vertices": [[0, 1], [1, 2], [2, 99]]}, "edges_vertices"),
        ({"edges_assignment": ["B"]}, "edges_assignment: expected 9"),
        ({"vertices_coords": [[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0], *[[0, 0, 0]] * 4]}, "is folded"),
    ],
)
def test_what_is_wrong_with_a_crease_pattern_is_said(fields: dict[str, Any], told: str) -> None:
    with pytest.raises(ImportedFileError, match="FOLD file") as refused:
        import_file("a.fold", creases(**fields))
    assert told in str(refused.value)


def test_a_crease_pattern_without_a_unit_is_asked_for_it() -> None:
    with pytest.raises(UnitsNeededError) as asked:
        import_file("a.fold", creases(frame_unit="unit"))
    assert asked.value.sizes["m"] == pytest.approx((0.5, 0.5))
    assert sides(import_file("a.fold", creases(frame_unit="unit"), units="cm", scale=100.0)) == [0.5, 0.5]


def test_a_garment_and_its_folds_come_back_from_the_crease_pattern_that_is_exported() -> None:
    towel = load_garment("hand-towel")
    written = json.dumps(fold_format(towel, solve(drawing_of(towel)).cloths)).encode()
    found = import_file("towel.fold", written).garment
    assert np.ptp(np.array(found.outline), axis=0) == pytest.approx(np.ptp(np.array(towel.outline), axis=0))
    assert len(found.folds) == len(towel.folds)
