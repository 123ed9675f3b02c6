"""The shipped garments as files: fields, outlines, placements. Nothing here uses the planner."""

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest
from shapely import LineString, Point, Polygon, box
from shapely.affinity import rotate, translate

FILES = sorted((Path(__file__).parent.parent / "garments").glob("*.json"))

FIELDS = {"name", "title", "outline", "areal_density_kg_m2", "folds", "grip_radius_m", "placement"}
FOLD_FIELDS = {"name", "kind", "start", "end", "grip_radius_m"}

# Folds of each garment in Table 1 of the paper.
FOLD_COUNTS = {
    "t-shirt": 5,
    "jeans": 2,
    "shirt": 7,
    "tie": 3,
    "scarf": 2,
    "vest": 2,
    "skirt": 3,
    "big-towel": 3,
    "hand-towel": 3,
}
# Lying so far to one side (m), a tie and a scarf are in reach, and jeans are folded without a drag.
ASIDE_M = {"tie": 0.1, "tie-halved": 0.2, "scarf": 0.2, "scarf-halved": 0.2, "jeans": -0.1}
# These reach almost from edge to edge, so they lie nearer to it.
LONG = ("tie", "tie-halved", "scarf", "scarf-halved")
# These lie otherwise than with their top away from the front: the waist at the front, or sideways.
TURNED_RAD = {"jeans": math.pi / 2, "t-shirt": 0.0, "vest": 0.0}

TABLE = box(-0.80, -0.49, 0.80, 0.49)
SNAP_M = 0.005

each_garment = pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)


def read(path: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return content


def outline_on_table(garment: dict[str, Any]) -> Polygon:
    """Return the outline in the table frame: turned about the garment's origin, then moved to the placement."""
    placed = garment["placement"]
    turned = rotate(Polygon(garment["outline"]), placed["yaw_rad"], origin=(0, 0), use_radians=True)
    return translate(turned, placed["x_m"], placed["y_m"])


def silhouettes(garment: dict[str, Any]) -> list[Polygon]:
    """Return the silhouette before each blue fold, by half-planes: for folds right across the cloth."""
    silhouette = Polygon(garment["outline"])
    seen = []
    for fold in garment["folds"]:
        seen.append(silhouette)
        left = left_side(fold)
        flap = mirrored(silhouette.intersection(left), fold)
        silhouette = silhouette.difference(left).union(flap.buffer(1e-7))
    return seen


def left_side(fold: dict[str, Any]) -> Polygon:
    (ax, ay), (bx, by) = fold["start"], fold["end"]
    length = math.dist(fold["start"], fold["end"])
    ux, uy = 5 * (bx - ax) / length, 5 * (by - ay) / length
    near, far = (ax - ux, ay - uy), (bx + ux, by + uy)
    return Polygon([near, far, (far[0] - uy, far[1] + ux), (near[0] - uy, near[1] + ux)])


def mirrored(shape: Polygon, fold: dict[str, Any]) -> Polygon:
    (ax, ay), (bx, by) = fold["start"], fold["end"]
    angle = math.degrees(math.atan2(by - ay, bx - ax))
    level = rotate(translate(shape, -ax, -ay), -angle, origin=(0, 0))
    flipped = Polygon([(x, -y) for x, y in level.exterior.coords])
    return translate(rotate(flipped, angle, origin=(0, 0)), ax, ay)


def test_the_nine_garments_are_shipped_with_as_many_folds_as_in_the_paper() -> None:
    counts = {path.stem: len(read(path)["folds"]) for path in FILES}
    assert {name: counts.get(name) for name in FOLD_COUNTS} == FOLD_COUNTS


@each_garment
def test_a_garment_file_has_the_fields_of_the_contract_and_no_others(path: Path) -> None:
    garment = read(path)
    assert set(garment) - {"thickness_m"} == FIELDS
    assert set(garment["placement"]) == {"x_m", "y_m", "yaw_rad"}
    for fold in garment["folds"]:
        assert set(fold) == FOLD_FIELDS, fold["name"]


@each_garment
def test_a_garment_is_named_like_its_file(path: Path) -> None:
    garment = read(path)
    assert garment["name"] == path.stem
    assert re.fullmatch(r"[a-z0-9][a-z0-9-]{0,62}", garment["name"])
    assert 0 < len(garment["title"]) <= 200


@each_garment
def test_an_outline_is_a_simple_polygon_with_edges_of_at_least_a_millimetre(path: Path) -> None:
    outline = read(path)["outline"]
    assert 3 <= len(outline) <= 400
    assert outline[0] != outline[-1], "the first point is not repeated"
    assert Polygon(outline).is_valid
    assert Polygon(outline).area >= 1e-4
    edges = zip(outline, outline[1:] + outline[:1], strict=True)
    assert min(math.dist(a, b) for a, b in edges) >= 1e-3


@each_garment
def test_folds_have_names_colours_and_lengths(path: Path) -> None:
    folds = read(path)["folds"]
    assert len({fold["name"] for fold in folds}) == len(folds)
    for fold in folds:
        assert 0 < len(fold["name"]) <= 200
        assert fold["kind"] in ("blue", "red")
        assert math.dist(fold["start"], fold["end"]) >= 1e-3
    assert folds[0]["kind"] == "blue", "a red fold needs one before it"


@each_garment
def test_the_first_fold_runs_across_the_outline_from_edge_to_edge(path: Path) -> None:
    garment = read(path)
    cloth, fold = Polygon(garment["outline"]), garment["folds"][0]
    assert max(cloth.exterior.distance(Point(fold[end])) for end in ("start", "end")) <= SNAP_M
    assert cloth.buffer(SNAP_M).contains(LineString([fold["start"], fold["end"]]))


@pytest.mark.parametrize(
    "name", ["tie", "scarf", "skirt", "vest", "big-towel", "hand-towel", "tie-halved", "scarf-halved"]
)
def test_folds_right_across_the_cloth_end_on_the_silhouette_of_their_turn(name: str) -> None:
    garment = read(FILES[0].with_name(f"{name}.json"))
    for fold, silhouette in zip(garment["folds"], silhouettes(garment), strict=True):
        gaps = [silhouette.exterior.distance(Point(fold[end])) for end in ("start", "end")]
        assert max(gaps) <= SNAP_M, fold["name"]
        assert left_side(fold).intersection(silhouette).area > 1e-5, f"{fold['name']} moves nothing"


@each_garment
def test_a_garment_lies_on_the_table_with_its_near_edge_at_the_front(path: Path) -> None:
    garment = read(path)
    cloth = outline_on_table(garment)
    assert TABLE.contains(cloth)
    near, right, _, left = cloth.bounds
    assert near == pytest.approx(-0.80 + (0.03 if garment["name"] in LONG else 0.05))
    assert (right + left) / 2 == pytest.approx(ASIDE_M.get(garment["name"], 0.0), abs=1e-9)


@each_garment
def test_a_garment_is_turned_with_its_top_away_from_the_front_unless_it_folds_better_otherwise(path: Path) -> None:
    garment = read(path)
    expected = TURNED_RAD.get(garment["name"], -math.pi / 2)
    assert garment["placement"]["yaw_rad"] == pytest.approx(expected)


def test_the_red_fold_turns_back_a_part_of_the_flap_that_stays_clear_of_its_crease() -> None:
    blue, red = read(FILES[0].with_name("letter-towel.json"))["folds"]
    # The near half, y < 0.25, lands on 0.25..0.50. Red moves y > 0.39 of it back to 0.28..0.39.
    cloth = box(0, 0, 0.40, 0.50)
    flap = mirrored(cloth.intersection(left_side(blue)), blue)
    assert flap.equals_exact(box(0, 0.25, 0.40, 0.50), 1e-9, normalize=True)
    moving = flap.intersection(left_side(red))
    assert moving.bounds == pytest.approx((0, 0.39, 0.40, 0.50))
    assert mirrored(moving, red).bounds == pytest.approx((0, 0.28, 0.40, 0.39))
    assert moving.distance(LineString([blue["start"], blue["end"]])) > 0.1
