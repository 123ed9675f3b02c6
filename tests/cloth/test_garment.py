"""Garments from JSON: defaults, round trips, and refusals of everything else."""

import copy
import math
from collections.abc import Callable
from typing import Any

import pytest

from planner.cloth.garment import DrawnFold, Garment
from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.errors import FieldError, GarmentError

Json = dict[str, Any]

LEAST: Json = {"name": "towel", "outline": [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]]}
FOLD: Json = {"name": "half", "kind": "blue", "start": [0.4, 0.1], "end": [0.0, 0.1]}
FULL: Json = {
    **LEAST,
    "title": "A towel",
    "areal_density_kg_m2": 0.3,
    "thickness_m": 0.003,
    "folds": [{**FOLD, "grip_radius_m": 0.05}],
    "grip_radius_m": 0.1,
    "placement": {"x_m": 0.1, "y_m": -0.2, "yaw_rad": 1.0},
}


def refusal(change: Callable[[Json], None]) -> tuple[str, str]:
    data = copy.deepcopy(FULL)
    change(data)
    with pytest.raises(GarmentError) as caught:
        Garment.from_dict(data)
    return caught.value.field, caught.value.message


def test_what_is_left_out_has_its_default() -> None:
    towel = Garment.from_dict(LEAST)
    assert towel.title == "towel"
    assert (towel.areal_density_kg_m2, towel.thickness_m) == (0.2, 0.001)
    assert towel.grip_radius_m == 0.127
    assert towel.folds == ()


def test_without_a_placement_the_bounding_box_lies_in_the_middle_with_its_top_away() -> None:
    placement = Garment.from_dict(LEAST).placement
    assert placement.yaw_rad == -math.pi / 2
    # At -90 degrees the garment's (x, y) goes to (y, -x): its middle (0.2, 0.15) to (0.15, -0.2).
    assert (placement.x_m, placement.y_m) == pytest.approx((-0.15, 0.2))


def test_a_fold_without_a_radius_has_the_garments() -> None:
    data = {**FULL, "folds": [FOLD, {**FOLD, "grip_radius_m": 0.05}]}
    assert [fold.grip_radius_m for fold in Garment.from_dict(data).folds] == [0.1, 0.05]


def test_a_garment_as_json_is_read_back_the_same() -> None:
    towel = Garment.from_dict(FULL)
    assert towel.to_dict() == FULL
    assert Garment.from_dict(towel.to_dict()) == towel


@pytest.mark.parametrize("name", shipped_garment_names())
def test_a_shipped_garment_is_read_back_the_same(name: str) -> None:
    garment = load_garment(name)
    assert Garment.from_dict(garment.to_dict()) == garment


def test_whole_numbers_are_numbers() -> None:
    towel = Garment.from_dict({"name": "towel", "outline": [[0, 0], [1, 0], [1, 1]]})
    assert towel.outline == ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))


def test_an_empty_title_is_kept() -> None:
    assert Garment.from_dict({**LEAST, "title": ""}).title == ""


def put(path: str, value: object) -> Callable[[Json], None]:
    """Return a change that puts a value at a path such as ``folds.0.start``."""

    def change(data: Json) -> None:
        node: Any = data
        *way, last = (int(key) if key.isdigit() else key for key in path.split("."))
        for key in way:
            node = node[key]
        node[last] = value

    return change


@pytest.mark.parametrize(
    ("path", "value", "field", "words"),
    [
        ("colour", "red", "colour", "not a known field"),
        ("folds.0.colour", "red", "folds[0].colour", "not a known field"),
        ("placement.z_m", 0.0, "placement.z_m", "not a known field"),
        ("name", "Towel", "name", "does not match"),
        ("name", "-towel", "name", "does not match"),
        ("name", "", "name", "does not match"),
        ("name", "x" * 64, "name", "does not match"),
        ("name", "towel\n", "name", "does not match"),
        ("name", 7, "name", "string"),
        ("title", "x" * 201, "title", "201 characters"),
        ("outline", "square", "outline", "list"),
        ("outline", [], "outline", "has 0 points"),
        ("outline.1", [0.4], "outline[1]", "at least 2"),
        ("outline.1", [0.4, 0.0, 0.0], "outline[1]", "at most 2"),
        ("outline.1.0", "0.4", "outline[1][0]", "number"),
        ("outline.1.0", True, "outline[1][0]", "True"),
        ("outline.1.0", math.nan, "outline[1][0]", "finite"),
        ("outline.1.0", math.inf, "outline[1][0]", ""),
        ("outline.1.0", 10.5, "outline[1][0]", "10.5"),
        ("outline.1.0", None, "outline[1][0]", "None"),
        ("areal_density_kg_m2", 0.0, "areal_density_kg_m2", "greater than 0"),
        ("areal_density_kg_m2", -1.0, "areal_density_kg_m2", "greater than 0"),
        ("areal_density_kg_m2", "0.2", "areal_density_kg_m2", "number"),
        ("thickness_m", 0.00009, "thickness_m", "greater than or equal to 0.0001, not 9e-05"),
        ("thickness_m", 0.021, "thickness_m", "less than or equal to 0.02, not 0.021"),
        ("thickness_m", "0.001", "thickness_m", "number"),
        ("grip_radius_m", 0.0, "grip_radius_m", "greater than 0"),
        ("grip_radius_m", 11.0, "grip_radius_m", "11"),
        ("folds", {}, "folds", "list"),
        ("folds.0.kind", "green", "folds[0].kind", "expected one of blue, red, turn; got 'green'"),
        ("folds.0.kind", "red", "folds[0].kind", "the first fold cannot be red"),
        ("folds.0.name", "x" * 201, "folds[0].name", "201 characters"),
        ("folds.0.start", [0.0, 0.1], "folds[0].end", "0.000 mm"),
        ("folds.0.start", [0.0005, 0.1], "folds[0].end", "0.500 mm"),
        ("folds.0.start", [0.0], "folds[0].start", "at least 2"),
        ("folds.0.end", [20.0, 0.1], "folds[0].end[0]", "20"),
        ("folds.0.grip_radius_m", 0.0, "folds[0].grip_radius_m", "greater than 0"),
        ("placement.yaw_rad", "north", "placement.yaw_rad", "number"),
        ("placement.x_m", -10.5, "placement.x_m", "-10.5"),
        ("placement", 3, "placement", ""),
        ("placement.x_m", True, "placement.x_m", "number"),
        ("placement.x_m", "0.5", "placement.x_m", "number"),
        ("placement.x_m", math.nan, "placement.x_m", "finite"),
    ],
)
def test_what_is_no_garment_is_refused_by_field_and_number(path: str, value: object, field: str, words: str) -> None:
    found_field, message = refusal(put(path, value))
    assert found_field == field
    assert words in message


@pytest.mark.parametrize("field", ["name", "outline"])
def test_what_must_be_there_is_missed(field: str) -> None:
    assert refusal(lambda data: data.pop(field)) == (field, "is missing")


@pytest.mark.parametrize("field", ["name", "kind", "start", "end"])
def test_what_a_fold_must_have_is_missed(field: str) -> None:
    assert refusal(lambda data: data["folds"][0].pop(field)) == (f"folds[0].{field}", "is missing")


def test_sixty_four_folds_are_taken_and_one_more_is_refused() -> None:
    assert len(Garment.from_dict({**LEAST, "folds": [FOLD] * 64}).folds) == 64
    assert refusal(put("folds", [FOLD] * 65)) == ("folds", "there are 65 folds, more than 64")


def test_values_built_directly_are_held_to_the_same() -> None:
    with pytest.raises(GarmentError, match="kind"):
        DrawnFold("half", "green", (0.0, 0.0), (1.0, 0.0))
    with pytest.raises(GarmentError, match="grip_radius_m"):
        DrawnFold("half", "blue", (0.0, 0.0), (1.0, 0.0), math.nan)


def test_an_error_seen_from_further_out_has_the_longer_path() -> None:
    error = FieldError("[3]", "is odd").within("outline").within("garment")
    assert error.field == "garment.outline[3]"
    assert str(error) == "garment.outline[3]: is odd"
    assert FieldError("", "is odd").within("garment").field == "garment"
