"""Reachability of poses: Pleat's kernel and its peers, given the same queries in one run.

Every turn has poses of its own and all methods answer them one after another, so that a slow moment of the machine
affects all; the slow methods answer only the first few. Ratios are of CPU times. The true answers come from dense
sampling (see `bench.reach_truth`).
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from statistics import median
from time import perf_counter, process_time
from typing import Any

import numpy as np

from bench.measurement import BenchmarkError, Ratio
from bench.pin_arm import pin_arm
from bench.reach_method import Joints, Method
from bench.reach_ours import in_batches, our_methods
from bench.reach_peers import peer_methods
from bench.reach_queries import Queries, any_poses, pinches
from bench.reach_truth import DenseReach, distance_m, is_proved
from bench.report import ABSENT, Report, Row
from planner.geometry.pose import BoolArray

COLUMNS = ("method", "poses", "CPU [us]", "wall [us]", "times ours", "recall", "false", "worst miss [mm]")
BASELINE = in_batches(100)

FALSE_M = 1e-6
"""Deviation of the tool from its pose beyond which joints are no answer (m, or of a unit vector)."""

PROVED_M = 1e-9
"""Largest deviation of the tool from a pose that counts as proved within reach (m)."""

PASSES = 5
"""Number of passes over a turn of a method that is not slow; the median counts."""


@dataclass(frozen=True, slots=True)
class Effort:
    """The number of turns, of poses in each, and of those that the slow methods answer."""

    turns: int
    poses: int = 2000
    slow: int = 100


@dataclass(frozen=True, slots=True)
class _Turn:
    """A method's times (s) and answers in one turn."""

    queries: Queries
    truth: BoolArray
    cpu_s: float
    wall_s: float
    joints: Joints

    @property
    def says_yes(self) -> BoolArray:
        return np.array([joints is not None for joints in self.joints], dtype=bool)

    @property
    def is_false(self) -> BoolArray:
        """The "yes" answers whose joints miss the pose, or that have none."""
        poses = zip(self.joints, self.queries.points, self.queries.rotations, strict=True)
        return np.array([j is not None and not pin_arm().residual(j, p, r) <= FALSE_M for j, p, r in poses], dtype=bool)


def reach(_: Sequence[str], repetitions: int) -> Report:
    """Measure the left arm of a PR2, without any garment; a single turn has fewer poses."""
    return reach_of(Effort(repetitions) if repetitions > 1 else Effort(1, 1000, 20))


def reach_of(effort: Effort) -> Report:
    """Return the table with the given effort."""
    dense = DenseReach()
    poses = any_poses(effort.turns * effort.poses)
    asked = {False: poses, True: pinches(poses)}
    truths = {kind: _truth(dense, queries) for kind, queries in asked.items()}
    methods = {method.name: method for method in our_methods()} | peer_methods()
    turns: dict[str, list[_Turn]] = {name: [] for name in methods}
    for turn in range(effort.turns):
        for name, method in methods.items():
            if method is not None:
                start, count = turn * effort.poses, effort.slow if method.is_slow else effort.poses
                queries = asked[method.is_of_pinches].part(start, start + count)
                turns[name].append(_timed(method, queries, truths[method.is_of_pinches][start : start + count]))
    rows = tuple(_row(name, turns[name], turns[BASELINE], dense) for name in methods)
    return Report(
        "reach", "Reach of a PR2's left arm: the same poses side by side, time for one", COLUMNS, rows, effort.turns
    )


def _truth(dense: DenseReach, queries: Queries) -> BoolArray:
    """Return which poses are within reach; raise `BenchmarkError` where the dense sampling is certainly wrong."""
    truth = dense.truth(queries)
    proved = is_proved(truth, queries, PROVED_M)
    if not np.array_equal(proved, truth.answers):
        raise BenchmarkError("the dense sampling names joints that do not take the pose")
    if np.any(queries.is_sure & ~proved):
        raise BenchmarkError("the dense sampling does not find a pose that is certainly within reach")
    return proved


def _timed(method: Method, queries: Queries, truth: BoolArray) -> _Turn:
    passes = 1 if method.is_slow or not method.is_repeatable else PASSES
    cpu_s, wall_s = [], []
    for _ in range(passes):
        answer = method.prepare(queries)
        wall, cpu = perf_counter(), process_time()
        joints = answer()
        cpu_s.append(process_time() - cpu)
        wall_s.append(perf_counter() - wall)
    return _Turn(queries, truth, median(cpu_s), median(wall_s), joints())


def _row(name: str, turns: Sequence[_Turn], baseline: Sequence[_Turn], dense: DenseReach) -> Row:
    if not turns:
        return Row(((name, "not installed", *[ABSENT] * (len(COLUMNS) - 2)),), {"method": name, "is_installed": False})
    truth = np.concatenate([turn.truth for turn in turns])
    says_yes = np.concatenate([turn.says_yes for turn in turns])
    per_pose = [turn.cpu_s / len(turn.queries) for turn in turns]
    longer = Ratio.of(per_pose, [turn.cpu_s / len(turn.queries) for turn in baseline])
    misses_m = [
        distance_m(dense, turn.queries.points[i], turn.queries.rotations[i])
        for turn in turns
        for i in np.flatnonzero(turn.truth & ~turn.says_yes)
    ]
    data: dict[str, Any] = {
        "method": name,
        "is_installed": True,
        "queries": len(truth),
        "within_reach": int(truth.sum()),
        "cpu_us": 1e6 * median(per_pose),
        "wall_us": 1e6 * median(turn.wall_s / len(turn.queries) for turn in turns),
        "cpu_ratio": asdict(longer),
        "recall": float((truth & says_yes).sum() / truth.sum()),
        "misses": len(misses_m),
        "false_positives": sum(int(turn.is_false.sum()) for turn in turns),
        "beyond_truth": int((says_yes & ~truth).sum()),
        "furthest_miss_mm": 1e3 * max(misses_m, default=0.0),
    }
    line = (
        name,
        str(data["queries"]),
        _figures(data["cpu_us"]),
        _figures(data["wall_us"]),
        _figures(longer.median),
        f"{data['recall']:.4f}",
        str(data["false_positives"]),
        f"{data['furthest_miss_mm']:.1f}",
    )
    return Row((line,), data)


def _figures(value: float) -> str:
    """Return a number with two decimals, or with none where they would say nothing."""
    return f"{value:.2f}" if value < 100.0 else f"{value:.0f}"
