from collections import Counter
from typing import Any

import numpy as np
import pytest

from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from app.files.fold_format import fold_format
from planner import load_garment
from planner.cloth.garment import Garment
from planner.cloth.garment_files import shipped_garment_names
from tests.app.files.fold_checker import frames_of, require_valid, rings, signed_area
from tests.builders import fold, garment, rectangle_points


def written(cloth: Garment) -> dict[str, Any]:
    return fold_format(cloth, solve(drawing_of(cloth)).cloths)


def creases(frame: dict[str, Any]) -> Counter[str]:
    return Counter(frame["edges_assignment"])


@pytest.mark.parametrize("name", shipped_garment_names())
def test_every_shipped_garment_is_written_as_the_specification_has_it(name: str) -> None:
    cloth = load_garment(name)
    file = written(cloth)
    require_valid(file)
    assert len(file["file_frames"]) == len(cloth.folds)
    for frame in frames_of(file):
        assert all(len(str(number)) <= 14 for place in frame["vertices_coords"] for number in place), "noise is written"
        assert sum(abs(signed_area(ring)) for ring in rings(frame)) == pytest.approx(cloth.pattern.area, abs=1e-5)


def test_a_cloth_folded_in_half_has_one_valley_and_its_left_half_on_top() -> None:
    # A square of 0.4 m; what is left of the line from (0.2, 0) up to (0.2, 0.4), at x < 0.2, comes onto the rest.
    file = written(garment(rectangle_points(0.4, 0.4), fold((0.2, 0.0), (0.2, 0.4))))
    folded = frames_of(file)[1]
    assert creases(folded) == {"B": 6, "V": 1}
    (order,) = folded["faceOrders"]
    middles = [np.mean(ring, axis=0) for ring in rings(file)]
    left, right = (0, 1) if middles[0][0] < middles[1][0] else (1, 0)
    assert order == [left, right, 1]  # above it, where the normal of the part that shows its front points
    assert np.allclose(
        sorted(map(tuple, np.round(rings(folded)[left], 6))), [(0.2, 0), (0.2, 0.4), (0.4, 0), (0.4, 0.4)]
    )


def test_a_cloth_folded_in_quarters_has_three_valleys_and_one_mountain_at_its_middle() -> None:
    # Maekawa: at a vertex folded flat there are two more creases of one kind than of the other; here 3 and 1.
    file = written(garment(rectangle_points(0.4, 0.4), fold((0.2, 0.0), (0.2, 0.4)), fold((0.4, 0.2), (0.2, 0.2))))
    require_valid(file)
    assert creases(frames_of(file)[1]) == {"B": 8, "V": 2, "F": 2}
    assert creases(frames_of(file)[2]) == {"B": 8, "V": 3, "M": 1}
    assert creases(file) == {"B": 8, "V": 3, "M": 1}


def test_a_red_fold_turns_the_last_flap_alone() -> None:
    # The strip's left third comes over the middle, then a part of that flap goes back: its crease is a mountain,
    # for it lies on the back of the cloth, which there looks up.
    file = written(
        garment(
            rectangle_points(0.6, 0.3),
            fold((0.25, 0.0), (0.25, 0.3)),
            fold((0.4, 0.3), (0.4, 0.0), "red"),
        )
    )
    require_valid(file)
    assert creases(frames_of(file)[2]) == {"B": 8, "V": 1, "M": 1}


def test_the_frames_are_named_for_the_folds_and_lengths_are_metres() -> None:
    file = written(load_garment("t-shirt"))
    assert [frame["frame_title"] for frame in file["file_frames"]][:2] == ["1: left sleeve", "2: right sleeve"]
    assert {frame["frame_unit"] for frame in frames_of(file)} == {"m"}


def test_a_garment_without_folds_is_its_outline() -> None:
    file = written(garment(rectangle_points(0.4, 0.4)))
    require_valid(file)
    assert creases(file) == {"B": 4}
    assert file["file_frames"] == []


def test_the_checker_catches_a_crease_of_the_wrong_kind() -> None:
    file = written(garment(rectangle_points(0.4, 0.4), fold((0.2, 0.0), (0.2, 0.4))))
    frame = file["file_frames"][0]
    frame["edges_assignment"] = ["M" if kind == "V" else kind for kind in frame["edges_assignment"]]
    frame["edges_foldAngle"] = [-angle for angle in frame["edges_foldAngle"]]
    with pytest.raises(AssertionError):
        require_valid(file)


def test_the_checker_catches_a_face_that_was_stretched() -> None:
    file = written(garment(rectangle_points(0.4, 0.4), fold((0.2, 0.0), (0.2, 0.4))))
    file["file_frames"][0]["vertices_coords"][0][0] += 0.01
    with pytest.raises(AssertionError):
        require_valid(file)
