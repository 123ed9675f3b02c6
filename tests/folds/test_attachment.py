"""The attachments of fold ends, on a towel of 0.4 x 0.3 m, and on random cloths."""

import math
import random

import numpy as np
import pytest

from planner.cloth.cloth_state import ClothState
from planner.cloth.outline import require_simple_outline
from planner.errors import FoldError, GarmentError
from planner.folds.attachment import OnCrease, OnEdge, OnVertex, Replay, attached, place_of
from planner.folds.fold_cloth import fold_cloth
from planner.geometry.chord import chords
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from tests.builders import rectangle_points, star

TOWEL = rectangle_points(0.4, 0.3)
# The near half goes up over y = 0.15 and lies on the far half.
HALF = Segment((0.4, 0.15), (0.0, 0.15))


def unfolded(outline: tuple[Point2, ...] = TOWEL) -> Replay:
    return Replay(outline, (ClothState.spread_out(Region.polygon(outline)),))


def folded(replay: Replay, line: Segment, kind: str = "blue") -> Replay:
    crease = replay.lines[-1] if kind == "red" else None
    return replay.then(line, fold_cloth(replay.cloths[-1], line, kind, crease).cloth)


def near(place: Point2) -> object:
    return pytest.approx(place, abs=1e-9)


def test_a_corner_is_taken_before_the_edges_that_meet_there() -> None:
    assert attached((0.0, 0.3), unfolded(), "blue") == OnVertex(3)


def test_a_place_on_an_edge_is_a_fraction_of_it() -> None:
    assert attached((0.4, 0.075), unfolded(), "blue") == OnEdge(1, pytest.approx(0.25))  # type: ignore[arg-type]


def test_the_inside_of_the_cloth_is_nothing_to_attach_to() -> None:
    assert attached((0.2, 0.2), unfolded(), "blue") is None


def test_of_edges_that_lie_on_each_other_the_one_that_was_not_moved_is_taken() -> None:
    """The near edge lies on the far one, which runs from (0.4, 0.3) to (0, 0.3)."""
    found = attached((0.1, 0.3), folded(unfolded(), HALF), "blue")
    assert found == OnEdge(2, pytest.approx(0.75))  # type: ignore[arg-type]


def test_a_place_on_a_crease_is_a_fraction_of_it_and_its_ends_come_before_edges() -> None:
    once = folded(unfolded(), HALF)
    assert attached((0.1, 0.15), once, "blue") == OnCrease(0, pytest.approx(0.75))  # type: ignore[arg-type]
    assert attached((0.4, 0.15), once, "blue") == OnCrease(0, 0.0)


def test_a_red_fold_sees_only_what_moved_last() -> None:
    """Of the edges at y = 0.3 the near one, laid there, is seen: it runs from (0, 0) to (0.4, 0)."""
    once = folded(unfolded(), HALF)
    assert attached((0.1, 0.3), once, "red") == OnEdge(0, pytest.approx(0.25))  # type: ignore[arg-type]
    assert place_of(OnEdge(2, 0.75), once, "red") is None


def test_a_crease_through_a_layer_that_was_carried_says_so() -> None:
    """The moved half, 0.15 to 0.3, is folded back at y = 0.25: that crease runs through a layer that fold 0 carried."""
    twice = folded(folded(unfolded(), HALF), Segment((0.0, 0.25), (0.4, 0.25)), "red")
    assert attached((0.1, 0.25), twice, "red") == OnCrease(1, pytest.approx(0.25), (0,))  # type: ignore[arg-type]
    assert place_of(OnCrease(1, 0.25, (0,)), twice, "red") == near((0.1, 0.25))


def test_what_it_is_attached_to_is_carried_by_folds() -> None:
    once = folded(unfolded(), HALF)
    assert place_of(OnVertex(0), once, "blue") == near((0.0, 0.3))
    assert place_of(OnEdge(1, 0.25), once, "blue") == near((0.4, 0.225))
    assert place_of(OnEdge(1, 0.75), once, "blue") == near((0.4, 0.225))
    sideways = folded(once, Segment((0.2, 0.15), (0.2, 0.3)))
    assert place_of(OnCrease(0, 0.75), sideways, "blue") == near((0.3, 0.15))


def test_a_corner_that_is_pulled_takes_what_is_attached_to_it_along_in_the_fold() -> None:
    """Corner 0 at (0, -0.02): over y = 0.15 it lands on (0, 0.32), and half the edge to corner 1 on (0.2, 0.31)."""
    pulled = folded(unfolded(((0.0, -0.02), *TOWEL[1:])), HALF)
    assert place_of(OnVertex(0), pulled, "blue") == near((0.0, 0.32))
    assert place_of(OnEdge(0, 0.5), pulled, "blue") == near((0.2, 0.31))


@pytest.mark.parametrize("missing", [OnVertex(4), OnEdge(4, 0.5), OnCrease(1, 0.5), OnCrease(0, 0.5, (0,))])
def test_what_is_not_there_has_no_place(missing: OnVertex | OnEdge | OnCrease) -> None:
    assert place_of(missing, folded(unfolded(), HALF), "blue") is None


@pytest.mark.parametrize("seed", range(12))
def test_a_place_on_the_boundary_is_where_its_attachment_is(seed: int) -> None:
    """Whatever the cloth, however folded: every place of the silhouette's boundary has one, and leads back to it."""
    rng = random.Random(seed)
    replay = unfolded(simple_star(rng))
    for _ in range(4):
        replay = randomly_folded(replay, rng)
        silhouette = replay.cloths[-1].silhouette
        feet = silhouette.nearest_boundary_points(np.array([[rng.uniform(-0.5, 0.5)] * 2 for _ in range(10)]))
        for x, y in [*feet, *silhouette.ring]:
            attachment = attached((float(x), float(y)), replay, "blue")
            if attachment is None:
                continue
            place = place_of(attachment, replay, "blue")
            assert place is not None and math.dist(place, (x, y)) < 2e-5
        found = [attached((float(x), float(y)), replay, "blue") for x, y in feet]
        assert sum(one is None for one in found) <= 1


def simple_star(rng: random.Random) -> tuple[Point2, ...]:
    while True:
        outline = star(rng, rng.randint(4, 9))
        try:
            require_simple_outline(outline)
        except GarmentError:
            continue
        return outline


def randomly_folded(replay: Replay, rng: random.Random) -> Replay:
    """Add one more legal fold along some chord."""
    for _ in range(50):
        turn, x, y = rng.uniform(0, math.tau), rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2)
        line = Segment((x, y), (x + math.cos(turn), y + math.sin(turn)))
        for chord in chords(replay.cloths[-1].silhouette, line):
            try:
                return folded(replay, chord)
            except FoldError:
                continue
    return replay
