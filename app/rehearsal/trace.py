"""The trace of a run: the cloth as it was simulated over the time of the plan, as it was planned, and the pictures.

Positions are kept to a tenth of a millimetre, and a run has no more of them than `_NUMBERS_MAX`: a trace is for people
to look at, and many are kept.
"""

import io
import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.rehearsal.judge import GAP_M, silhouette
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.world import Truth
from planner.geometry.pose import FloatArray
from planner.task.plan import Plan, PlanStep
from planner.task.world_state import WorldState

UNIT_M = 1e-4
"""The unit in which positions are kept as whole numbers (m)."""

_NUMBERS_MAX = 2_000_000
"""The most coordinates of all frames of a run, two bytes each; longer runs keep evenly spaced frames."""

Frames = NDArray[np.int16]


@dataclass(frozen=True, slots=True, eq=False)
class ClothAfter:
    """The cloth after a step that was judged.

    Attributes:
        of_plan: the index of the step in the plan as it was at first (see `counterpart`).
        positions: where the points of the cloth are, table frame, shape (n, 3), m.
    """

    of_plan: int
    positions: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class StepTrace:
    """The cloth after a step of the plan, as simulated and as planned.

    Attributes:
        of_plan: the index of the step in the plan as it was at first.
        found: where the points of the cloth are, table frame, shape (n, 3), in units of `UNIT_M`.
        planned: where the plan has them, likewise.
        outlines: the rings of the silhouettes, seen from above, table frame (m): "found" and "planned".
    """

    of_plan: int
    found: Frames
    planned: Frames
    outlines: dict[str, list[list[list[float]]]]


@dataclass(frozen=True, slots=True, eq=False)
class RunTrace:
    """The trace of a run.

    Attributes:
        triangles: the triangles between the points of the cloth, shape (m, 3).
        times_s: the times of the frames along the plan as it was at first, rising (s).
        frames: where the points are then, shape (k, n, 3), in units of `UNIT_M`.
        steps: the steps of the plan that were judged.
        pictures: what was looked at, as JSON.
    """

    triangles: NDArray[np.int32]
    times_s: FloatArray
    frames: Frames
    steps: tuple[StepTrace, ...]
    pictures: list[dict[str, Any]]

    def at(self, t_s: float) -> FloatArray:
        """Return where the points of the cloth are at a time of the plan (s), shape (n, 3), m.

        Between two frames they move evenly; before the first and after the last nothing moves.
        """
        after = int(np.searchsorted(self.times_s, t_s, side="right"))
        first, last = max(after - 1, 0), min(after, len(self.times_s) - 1)
        span_s = self.times_s[last] - self.times_s[first]
        share = 0.0 if span_s <= 0.0 else (t_s - self.times_s[first]) / span_s
        a, b = self.frames[first].astype(np.float64), self.frames[last].astype(np.float64)
        return np.asarray(UNIT_M * (a + min(max(share, 0.0), 1.0) * (b - a)))

    def packed(self) -> bytes:
        """Return the trace as bytes, which `unpacked` reads."""
        described = {
            "pictures": self.pictures,
            "of_plan": [step.of_plan for step in self.steps],
            "outlines": [step.outlines for step in self.steps],
        }
        empty = np.empty((0, *self.frames.shape[1:]), np.int16)
        file = io.BytesIO()
        np.savez_compressed(
            file,
            triangles=self.triangles,
            times_s=self.times_s,
            frames=self.frames,
            found=np.array([step.found for step in self.steps], np.int16) if self.steps else empty,
            planned=np.array([step.planned for step in self.steps], np.int16) if self.steps else empty,
            told=np.frombuffer(json.dumps(described).encode(), np.uint8),
        )
        return file.getvalue()

    @staticmethod
    def unpacked(content: bytes) -> "RunTrace":
        """Return the trace that was packed."""
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            described = json.loads(file["told"].tobytes())
            parts = zip(described["of_plan"], file["found"], file["planned"], described["outlines"], strict=True)
            steps = tuple(StepTrace(*part) for part in parts)
            return RunTrace(file["triangles"], file["times_s"], file["frames"], steps, described["pictures"])


def counterpart(plan: Plan, step: PlanStep) -> int | None:
    """Return the index of the step of a plan that leaves the cloth folded as another step does; None if none does.

    Args:
        plan: the plan as it was at first.
        step: a step of it, or of one that was planned again on the way: then only folds are compared.
    """
    own = next((number for number, one in enumerate(plan.steps) if one is step), None)
    if own is not None or step.fold is None:
        return own
    alike = (
        number for number, one in enumerate(plan.steps) if one.fold is not None and one.after.done == step.after.done
    )
    return next(alike, None)


def looked_before(plan: Plan, world: WorldState) -> int | None:
    """Return the index of the step of a plan before which a look was taken; None if there is none.

    Args:
        plan: the plan as it was at first.
        world: the world as planned at the look; after the rest was planned again only its folds are compared.
    """
    own = [number for number, step in enumerate(plan.steps) if step.before == world]
    alike = [number for number, step in enumerate(plan.steps) if step.grips and step.before.done == world.done]
    return next(iter(own or alike), None)


def traced(
    plan: Plan,
    truth: Truth,
    film: list[tuple[float, Frames]],
    cloths: tuple[ClothAfter, ...],
    pictures: list[dict[str, Any]],
) -> RunTrace:
    """Return the trace of a run.

    Args:
        plan: the plan as it was at first.
        truth: the cloth at the end.
        film: where its points were, in units of `UNIT_M`, by the time of the plan (s).
        cloths: the cloth after the steps that were judged.
        pictures: what was looked at, as JSON.
    """
    steps = tuple(_step_trace(plan, truth, cloth) for cloth in cloths)
    ends = [(plan.steps[step.of_plan].end_s, step.found) for step in steps]
    frames = _thinned(_rising(film, ends))
    times_s = np.array([t_s for t_s, _ in frames])
    return RunTrace(
        truth.triangles.astype(np.int32), times_s, np.array([frame for _, frame in frames]), steps, pictures
    )


def rounded(positions: FloatArray) -> Frames:
    """Return positions (m) in units of `UNIT_M`; what lies further than 3.27 m from the table's middle stays there."""
    limit = np.iinfo(np.int16).max
    return np.clip(np.round(positions / UNIT_M), -limit, limit).astype(np.int16)


def _step_trace(plan: Plan, truth: Truth, cloth: ClothAfter) -> StepTrace:
    after, table = plan.steps[cloth.of_plan].after, plan.scene.table
    planned = planned_positions(plan.sequence, truth.pattern, after.done, after.placement, table, GAP_M)
    outlines = {
        name: [np.round(ring, 4).tolist() for ring in silhouette(points[:, :2], truth.triangles).rings]
        for name, points in (("found", cloth.positions), ("planned", planned))
    }
    return StepTrace(cloth.of_plan, rounded(cloth.positions), rounded(planned), outlines)


def _rising(film: list[tuple[float, Frames]], ends: list[tuple[float, Frames]]) -> list[tuple[float, Frames]]:
    """Return frames and the ends of steps by their time; of two at one time the end, or the later one."""
    by_time = dict(sorted(film, key=lambda one: one[0]))
    return sorted((by_time | dict(ends)).items())


def _thinned(frames: list[tuple[float, Frames]]) -> list[tuple[float, Frames]]:
    """Return the first frame, the last, and as many between as may be kept."""
    most = max(2, _NUMBERS_MAX // frames[0][1].size) if frames else 0
    if len(frames) <= most:
        return frames
    return [frames[number] for number in np.unique(np.linspace(0, len(frames) - 1, most).round().astype(int))]
