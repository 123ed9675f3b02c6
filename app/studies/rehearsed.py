"""Rehearsals of a study: each plan is performed in simulated physics, with the noise of its cell."""

from collections.abc import Mapping
from dataclasses import dataclass
from statistics import mean
from typing import Any

from app.rehearsal.noise import NOISE
from app.rehearsal.rehearse import RUNS_MAX, RehearsalOptions, rehearse, require_physics
from app.rehearsal.result import success_bounds
from app.studies.axis import Axis
from app.studies.fields import StudyError, require_known, text, truth, whole
from planner.errors import RequestError
from planner.task.plan import Plan

NOISE_AXIS = "rehearsal.noise"
"""The name of the axis."""

RUNS, RUNS_HELD = "runs", "runs_held"
REHEARSAL_COLUMNS: Mapping[str, type] = {
    "rehearsal_seed": int,
    RUNS: int,
    RUNS_HELD: int,
    "success_low": float,
    "success_high": float,
    "final_iou": float,
}
"""The columns of a row in a study with rehearsals."""

_SEED_MAX = 2**31 - 1


@dataclass(frozen=True, slots=True)
class StudyRehearsal:
    """How a study's plans are rehearsed; the noise is an axis.

    Attributes:
        runs: how often each plan is performed.
        seed: the seed of each cell's first run; each run after it has the next.
        feedback: whether the robot looks before each step and corrects it.
    """

    runs: int = 1
    seed: int = 0
    feedback: bool = True

    def options(self, noise: str) -> RehearsalOptions:
        """Return the options of a cell's rehearsal, in the process that plans it."""
        return RehearsalOptions(self.runs, self.seed, noise, self.feedback, workers=1)


def read_rehearsal(given: Mapping[str, Any]) -> tuple[StudyRehearsal, Axis]:
    """Return how plans are rehearsed, and the axis of noise, of a study's table ``rehearsal``; raise `StudyError`."""
    require_known("rehearsal", given, ("noise", "runs", "seed", "feedback"))
    noise = given.get("noise", ["none"])
    names = noise if isinstance(noise, list) else [noise]
    for number, name in enumerate(names):
        if text(f"rehearsal.noise[{number}]", name) not in NOISE:
            raise StudyError(f"rehearsal.noise[{number}]", f"expected one of {', '.join(NOISE)}; got {name!r}")
    try:
        require_physics()
    except RequestError as error:
        raise StudyError("rehearsal", error.says or error.message) from None
    found = StudyRehearsal(
        whole("rehearsal.runs", given.get("runs", 1), 1, RUNS_MAX),
        whole("rehearsal.seed", given.get("seed", 0), 0, _SEED_MAX),
        truth("rehearsal.feedback", given.get("feedback", True)),
    )
    return found, Axis(NOISE_AXIS, tuple(names), is_ordered=False)


def rehearsed(plan: Plan, options: RehearsalOptions) -> dict[str, Any]:
    """Return the columns of a solved plan that is performed; the same options give the same columns."""
    result = rehearse(plan, options)
    low, high = success_bounds(result.held, len(result.runs))
    outlines = [run.steps[-1].iou for run in result.runs if run.steps]
    return {
        "rehearsal_seed": options.seed,
        RUNS: len(result.runs),
        RUNS_HELD: result.held,
        "success_low": low,
        "success_high": high,
        "final_iou": mean(outlines) if outlines else None,
    }
