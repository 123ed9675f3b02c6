"""Pleat's own answers to whether the left arm takes a pose: the kernel in batches, and the memory in front of it."""

from collections.abc import Callable

import numpy as np

from bench.pin_arm import TORSO_M
from bench.reach_method import Answering, Joints, Method
from bench.reach_queries import Queries
from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.reach_query import ReachQuery
from planner.robots.pr2.arm import read_arm
from planner.robots.pr2.description import read_model
from planner.robots.pr2.kernel import reachable_batch
from planner.robots.pr2.mirrored_arm import MirroredArm
from planner.robots.pr2.reach import APPROACHES, Pr2Reach

BATCHES = (1, 10, 100, 1000)


def our_methods() -> tuple[Method, ...]:
    """Return the kernel in batches, and for pinches the planner's memory in front of it."""
    return (
        *(Method(in_batches(size), _in_batches(size)) for size in BATCHES),
        Method(f"pinches, batches of {BATCHES[-1]}", _in_batches(BATCHES[-1]), is_of_pinches=True),
        Method("memory, asked first", _asked_first, is_of_pinches=True, is_repeatable=False),
        Method("memory, asked again", _asked_again, is_of_pinches=True),
    )


def in_batches(size: int) -> str:
    """Return the name of the method that answers batches of a size."""
    return f"Pleat, batches of {size}"


def _in_batches(size: int) -> Callable[[Queries], Answering]:
    shape = read_arm(read_model())
    shoulder = MirroredArm(shape, is_mirrored=False).shoulder(TORSO_M)

    def prepare(queries: Queries) -> Answering:
        points, axes, count = queries.points - shoulder, queries.axes, len(queries)

        def answer() -> Callable[[], Joints]:
            starts = range(0, count, size)
            parts = [reachable_batch(shape, points[i : i + size], axes[i : i + size]) for i in starts]
            return lambda: _joints(queries, np.concatenate(parts))

        return answer

    return prepare


def _asked_first(queries: Queries) -> Answering:
    """Query the planner's memory, empty at first, approach by approach; comfort radius 0, no body in the way."""
    reach = Pr2Reach(("left",), (MirroredArm(read_arm(read_model()), is_mirrored=False),), TORSO_M, 0.0)
    groups = [np.flatnonzero(queries.approaches == approach) for approach in range(len(APPROACHES))]
    asked = [(queries.points[group], np.array([number])) for number, group in enumerate(groups)]

    def answer() -> Callable[[], Joints]:
        parts = [reach.from_anywhere(ReachQuery(0, points, approach))[0] for points, approach in asked]
        answers = np.zeros(len(queries), dtype=bool)
        answers[np.concatenate(groups)] = np.concatenate(parts)
        return lambda: _joints(queries, answers)

    return answer


def _asked_again(queries: Queries) -> Answering:
    """Query the memory again after the same queries."""
    answer = _asked_first(queries)
    answer()
    return answer


def _joints(queries: Queries, answers: BoolArray) -> Joints:
    """Return the cheapest of the joints that Pleat samples for its answers; nan where it says yes and finds none."""
    arm = MirroredArm(read_arm(read_model()), is_mirrored=False)
    found: list[FloatArray | None] = []
    for point, rotation, answer in zip(queries.points, queries.rotations, answers, strict=True):
        (joints,), (costs,) = arm.samples(point[None], rotation[None], TORSO_M, -np.inf)
        best = joints[costs.argmin()] if np.isfinite(costs).any() else np.full(7, np.nan)
        found.append(best if answer else None)
    return found
