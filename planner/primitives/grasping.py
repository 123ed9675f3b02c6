"""Assign arms to grips, and find the directions from which they may approach."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations, permutations
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from planner.cloth.grips import Cover, best_covers, firm_covers
from planner.geometry.pose import BoolArray, FloatArray, Point2, wrapped_angle
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import EDGE_RAD, LENGTH_M, SORTING_M
from planner.geometry.traced import TRACED_M
from planner.primitives.context import Context
from planner.primitives.state import Held
from planner.task.world_state import Holding

_PREFERRED_PITCH_RAD = math.radians(30.0)
"""The downward pitch of the most natural approach (rad)."""

_ASKEW_RAD = 0.01
"""By how much an approach may be outside the cone (rad): so far a corner may be askew that is meant to be square. Its
bisector is 45 degrees off its sides, so that headings lie just on the edge of a cone of 75 degrees."""

_DISCOMFORT_DIGITS = 3
"""Decimals to which discomforts are compared (rad): the bisector at a corner is known no better."""


def nearest_pair_m(points: Sequence[Point2] | FloatArray) -> float:
    """Return the distance of the two nearest points, shape (n, 2), m; infinite for fewer than two."""
    return min((math.dist(a, b) for a, b in combinations(points, 2)), default=math.inf)


def assignments(context: Context, station: int, points: FloatArray) -> Iterator[tuple[int, ...]]:
    """Yield the ways to assign grips to arms: an arm further left takes a grip further left.

    Args:
        context: the planning context.
        station: where the robot stands.
        points: the grips in the table frame, shape (n, 2), m.

    Yields:
        For each grip the number of its arm. Where two grips are equally far left, to twice what an outline may be
            beside its shape, both assignments are yielded.
    """
    lateral = context.station_pose(station).to_inner(points)[:, 1]
    for arms in permutations(range(len(context.reach.arm_names)), len(points)):
        is_ordered = all(
            lateral[i] >= lateral[j] - _ABREAST_M
            for i in range(len(points))
            for j in range(len(points))
            if arms[i] < arms[j]
        )
        if is_ordered:
            yield arms


_ABREAST_M = 2.0 * TRACED_M
"""The distance by which one of two grips is further left than the other at least (m)."""

_FINER = 10
"""The number of steps of the finer grid on which places are sorted in one of the grid."""


def hand_keys(context: Context, station: int, arms: Sequence[int], tools: FloatArray) -> list[tuple[int, ...]]:
    """Return the keys that order hands by where they begin and end, whatever the frame of the drawing.

    Right arms are mirrored to the left, so a mirror image of the task tries its hands in the same order.

    Args:
        context: the planning context.
        station: where the robot stands.
        arms: the hands' arms.
        tools: their tool points in the table frame, shape (hands, n, 3), m.
    """
    ends = context.in_base(station, tools[:, [0, -1]].reshape(-1, 3)).reshape(-1, 2, 3)
    ends[..., 1] *= np.array([side_of(context, arm) for arm in arms])[:, None]
    places = ends.reshape(len(arms), -1) / SORTING_M
    # A grip nearly straight ahead is as far for both arms; the finer grid tells the two apart, and mirror images alike.
    steps = np.round(np.concatenate([places, _FINER * places], axis=1)).astype(np.int64)
    return [tuple(key) for key in steps.tolist()]


def side_of(context: Context, arm: int) -> float:
    """Return the side of the robot that an arm is on: 1 left, -1 right."""
    return context.kept(sides)[arm]


def sides(context: Context) -> tuple[float, ...]:
    """Return the side of the robot that each arm is on, see `side_of`."""
    return tuple(math.copysign(1.0, y) for _, y, _ in context.reach.shoulders)


def holdings(taken: Mapping[int, Point2], vertices: Sequence[Point2], arm_names: Sequence[str]) -> tuple[Holding, ...]:
    """Return what each arm holds, from the leftmost to the rightmost, each vertex with the grip nearest to it.

    Args:
        taken: the grip of each arm, garment frame (m).
        vertices: the points that must be held, garment frame (m).
        arm_names: the names of all arms.
    """
    nearest = [min(taken, key=lambda arm: (math.dist(taken[arm], vertex), arm)) for vertex in vertices]
    return tuple(
        Holding(arm_names[arm], taken[arm], tuple(v for v, by in zip(vertices, nearest, strict=True) if by == arm))
        for arm in sorted(taken)
    )


class Taking(Protocol):
    """A choice of grips for arms."""

    @property
    def taken(self) -> dict[int, Point2]:
        """The point that each arm holds, garment frame (m)."""
        ...


T = TypeVar("T", bound=Taking)


def by_nearness(one: T, others: Iterable[T]) -> list[T]:
    """Return the others sorted by how far their hands are from those of `one`; those with other arms last."""

    def away_m(other: T) -> float:
        if other.taken.keys() != one.taken.keys():
            return math.inf
        return max(math.dist(point, other.taken[arm]) for arm, point in one.taken.items())

    return sorted(others, key=away_m)


def approaches_from_outside(
    context: Context, done: int, heading_in_base: float, grip: Point2, arm: int
) -> NDArray[np.int64]:
    """Return the approaches that pinch the cloth from outside, best first; of equals those across the body first.

    Args:
        context: the planning context.
        done: the folds finished, as a bit mask.
        heading_in_base: direction of the garment's x axis in the base frame (rad).
        grip: a point of the stack, garment frame (m).
        arm: the arm that takes it.
    """
    return context.kept(_Pinches).of(context, done, heading_in_base, grip, side_of(context, arm))


def like_approach(context: Context, approaches: NDArray[np.int64], one: int, count: int) -> NDArray[np.int64]:
    """Return the `count` approaches that turn the hand least from `one`, in their given order."""
    wanted = context.reach.approaches[one]
    found = [context.reach.approaches[approach] for approach in approaches]
    off = [
        abs(wrapped_angle(each.heading_rad - wanted.heading_rad)) + abs(each.pitch_rad - wanted.pitch_rad)
        for each in found
    ]
    return np.asarray(approaches[np.sort(np.argsort(off, kind="stable")[:count])])


class _Pinches:
    """The directions from which cloth may be pinched, kept because the same grips are queried again and again."""

    def __init__(self, _: Context) -> None:
        # The context keeps this, so that it must not keep the context: a cycle stays long after a search.
        self._headings: dict[tuple[int, Point2], float | None] = {}
        self._known: dict[tuple[int, float, Point2, float], NDArray[np.int64]] = {}

    def of(self, context: Context, done: int, heading_in_base: float, grip: Point2, side: float) -> NDArray[np.int64]:
        key = (done, heading_in_base, grip, side)
        if key not in self._known:
            inward = self._inward_heading(context, done, grip)
            heading = None if inward is None else heading_in_base + inward
            self._known[key] = _from_outside(context, heading, side)
        return self._known[key]

    def _inward_heading(self, context: Context, done: int, grip: Point2) -> float | None:
        """Return the direction into the cloth, garment frame (rad); None for a grip that is not at its edge."""
        if (done, grip) not in self._headings:
            inward = context.sequence.cloth(done).silhouette.inward_bisector(grip)
            self._headings[done, grip] = None if inward is None else math.atan2(inward[1], inward[0])
        return self._headings[done, grip]


def _from_outside(context: Context, heading: float | None, side: float) -> NDArray[np.int64]:
    """Return the approaches within the cone about a heading, base frame, best first.

    Without a heading, only the vertical approaches count.
    """
    discomfort, off = _discomfort(context, heading)
    cone, (_, _, is_vertical) = context.scene.approach_cone_rad, context.kept(_Directions).all
    is_within = np.full(len(off), cone >= math.pi - EDGE_RAD)
    if heading is not None:
        is_within |= off <= cone + _ASKEW_RAD
    return _by_comfort(context, discomfort, np.flatnonzero(is_within | is_vertical), side)


def all_approaches(context: Context) -> tuple[NDArray[np.int64], ...]:
    """Return every approach, for each arm the best first: a grip already held may be held from any direction."""
    discomfort, _ = _discomfort(context, None)
    every = np.arange(len(discomfort))
    return tuple(
        _by_comfort(context, discomfort, every, side_of(context, arm)) for arm in range(len(context.reach.arm_names))
    )


def _by_comfort(
    context: Context, discomfort: FloatArray, approaches: NDArray[np.int64], side: float
) -> NDArray[np.int64]:
    """Return approaches by rising discomfort; of equals first the flat ones, then those that point across the body."""
    headings, pitches, _ = context.kept(_Directions).all
    across = side * headings[approaches]
    return np.asarray(approaches[np.lexsort((across, pitches[approaches], discomfort[approaches]))])


def _discomfort(context: Context, heading: float | None) -> tuple[FloatArray, FloatArray]:
    """Return each approach's deviation from the natural one, and from the heading (rad).

    The natural approach points straight into the cloth, 30 degrees down.
    """
    headings, pitches, is_vertical = context.kept(_Directions).all
    off = np.abs(np.remainder(headings - (heading or 0.0) + math.pi, math.tau) - math.pi)
    turn = np.zeros(len(off)) if heading is None else np.where(is_vertical, 0.0, off)
    return np.round(turn + np.abs(pitches - _PREFERRED_PITCH_RAD), _DISCOMFORT_DIGITS), off


class _Directions:
    """The approaches' directions as arrays.

    Attributes:
        all: headings and pitches (rad), and whether each points straight down, shape (approaches,) each.
    """

    def __init__(self, context: Context) -> None:
        found = context.reach.approaches
        self.all: tuple[FloatArray, FloatArray, BoolArray] = (
            np.array([approach.heading_rad for approach in found]),
            np.array([approach.pitch_rad for approach in found]),
            np.array([approach.is_vertical for approach in found]),
        )


def held_covers(context: Context, fold: int, held: tuple[Held, ...]) -> tuple[tuple[Held, ...], ...]:
    """Return the sets of grips already held that hold all that a fold needs, the firm first; empty if none does.

    Where hands hold firmly, a red fold has those that hold it best: nothing else can be taken. Only hands on the
    moving part count: on the fold line, or on cloth that stays, a hand lifts nothing.
    """
    return context.kept(_HeldCovers).of(fold, held)


class _HeldCovers:
    """The sets of grips already held that suffice for a fold; many states share them, so they are kept.

    Grips that are equal on the grid share an answer though their points differ by a rounding error. So an answer holds
    the grips' numbers, not their points.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._known: dict[tuple[object, ...], tuple[tuple[int, ...], ...]] = {}

    def of(self, fold: int, held: tuple[Held, ...]) -> tuple[tuple[Held, ...], ...]:
        key = (fold, *(h.key for h in held))
        if key not in self._known:
            number = {h.point: i for i, h in enumerate(held)}
            covers = self._search(fold, held)
            self._known[key] = tuple(tuple(number[point] for point in cover) for cover in covers)
        return tuple(tuple(held[i] for i in numbers) for numbers in self._known[key])

    def _search(self, fold: int, held: tuple[Held, ...]) -> tuple[Cover, ...]:
        context = self._context
        arms = len(context.reach.arm_names)
        known = context.sequence.covers(fold, context.scene.support_angle_rad, arms)
        points = lifted_points(context, fold, held)
        drawn = context.sequence.folds[fold]
        candidates, must = np.array(points).reshape(-1, 2), np.array(known.vertices)
        if context.is_firm and not drawn.is_red:
            return best_covers(candidates, must, known.firm_m, len(held))
        firm = firm_covers(candidates, must, drawn.grip_radius_m, len(held))
        covers = best_covers(candidates, must, drawn.grip_radius_m, len(held))
        return firm if context.is_firm or firm == covers else (*firm, *covers)


def lifted_points(context: Context, fold: int, held: tuple[Held, ...]) -> list[Point2]:
    """Return the grips held that lie on the part that a fold moves, garment frame (m)."""
    line, moving = context.sequence.folds[fold].line, context.sequence.moving(fold)
    return [h.point for h in held if _is_lifted(h.point, moving, line)]


def _is_lifted(point: Point2, moving: Region, line: Segment) -> bool:
    """Return whether a point of the cloth lies on the moving part, off the fold line."""
    is_on_part = moving.contains(point) or moving.boundary_distance(point) <= LENGTH_M
    return is_on_part and float(line.distances(np.array([point]))[0]) > LENGTH_M
