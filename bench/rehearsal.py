"""Every garment's plan performed in simulated physics: which steps hold, as it is and corrected by what is seen.

One row for each garment, noise and feedback: steps and runs that held, the first step lost, overlap and mean error
after the last step, bounds of the rate of success, how fast it was. Several garments are rehearsed side by side in
processes; CPU time is that of the rehearsal alone. `HELD_OUT` are garments that no setting of simulation, planner or
feedback was chosen by: `python -m bench --only held-out` rehearses each twice with noise and feedback.
"""

from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from statistics import mean
from typing import Any

from app.rehearsal.rehearse import RehearsalOptions, rehearse
from app.rehearsal.result import RehearsalResult
from bench.paper import TABLE_1
from bench.report import ABSENT, Report, Row, seconds
from planner import Plan, Task, load_garment, make_plan

LETTER = "letter-towel"
"""A towel of two folds, blue and red, which no other benchmark plans."""

GARMENTS = (*TABLE_1, LETTER)
HELD_OUT_IN = Path(__file__).with_name("held_out")
HELD_OUT = ("apron", "bib", "pennant", "pillowcase", "shorts", "tabard")
"""Garments that no setting was chosen by."""

HELD_OUT_RUNS = 2
PROCESSES = 2
REAL_RUNS = 20
"""Runs with errors of robot, cloth and camera; without errors all runs are alike but for the mesh."""

COLUMNS = (
    "",
    "noise",
    "sees",
    "steps",
    "lost at",
    "overlap",
    "mean [mm]",
    "runs",
    "95 %",
    "x real",
    "CPU [s]",
)


@dataclass(frozen=True, slots=True)
class Rehearsed:
    """The rehearsals of a plan under one noise, with or without feedback.

    Attributes:
        garment: the garment's name.
        noise: the noise's name.
        feedback: whether the robot looked before each step.
        result: what came out; no runs where there is no plan.
    """

    garment: str
    noise: str
    feedback: bool
    result: RehearsalResult


def rehearsal(asked: Sequence[str], repetitions: int) -> Report:
    """Rehearse the garments asked for; measured once, without noise and without feedback alone."""
    named = [name for name in GARMENTS if name in asked] or GARMENTS
    with ProcessPoolExecutor(PROCESSES, get_context("spawn"), max_tasks_per_child=1) as pool:
        found = list(pool.map(rehearsed, named, [repetitions > 1] * len(named)))
    rows = [row_of(one) for garment in found for one in garment if one.result.runs]
    return Report("rehearsal", "Plans performed in simulated physics", COLUMNS, tuple(rows), 1)


def held_out(_: Sequence[str], __: int) -> Report:
    """Rehearse the garments that no setting was chosen by, with noise and feedback, and count all their runs."""
    with ProcessPoolExecutor(PROCESSES, get_context("spawn"), max_tasks_per_child=1) as pool:
        found = list(pool.map(rehearsed_held_out, HELD_OUT))
    runs = tuple(run for one in found for run in one.result.runs)
    everything = Rehearsed("all", "real", True, RehearsalResult(runs))
    rows = [row_of(one) for one in (*found, everything) if one.result.runs]
    return Report("held-out", "Garments that no setting was chosen by, in simulated physics", COLUMNS, tuple(rows), 1)


def rehearsed_held_out(garment: str) -> Rehearsed:
    """Plan and rehearse one garment of `HELD_OUT`."""
    plan = make_plan(Task.of(load_garment(HELD_OUT_IN / f"{garment}.json")))
    return _rehearsed(garment, plan, "real", True, HELD_OUT_RUNS)


def rehearsed(garment: str, is_whole: bool) -> list[Rehearsed]:
    """Plan a garment, and rehearse it without noise and, if all is asked for, with feedback and with noise."""
    plan = make_plan(Task.of(load_garment(garment)))
    kinds = [("none", False), ("none", True), ("real", False), ("real", True)][: 4 if is_whole else 1]
    return [
        _rehearsed(garment, plan, noise, feedback, 1 if noise == "none" else REAL_RUNS) for noise, feedback in kinds
    ]


def _rehearsed(garment: str, plan: Plan, noise: str, feedback: bool, runs: int) -> Rehearsed:
    options = RehearsalOptions(runs, noise=noise, feedback=feedback, workers=1)
    return Rehearsed(garment, noise, feedback, rehearse(plan, options) if plan.is_solved else RehearsalResult(()))


def row_of(one: Rehearsed) -> Row:
    """Return the row of some rehearsals."""
    runs = one.result.runs
    steps = [step for run in runs for step in run.steps]
    last = [run.steps[-1] for run in runs if run.steps]
    lost = next((str(step.step) for step in runs[0].steps if not step.held), runs[0].reason and "stopped")
    told: dict[str, Any] = {
        "garment": one.garment,
        "noise": one.noise,
        "feedback": one.feedback,
        "steps_held": sum(step.held for step in steps),
        "steps": len(steps),
        "last_iou": mean(step.iou for step in last) if last else None,
        "last_mean_mm": mean(step.mean_mm for step in last) if last else None,
        "cpu_s": sum(run.cpu_s for run in runs),
        "real_time": sum(run.simulated_s for run in runs) / max(sum(run.cpu_s for run in runs), 1e-9),
        **one.result.to_dict(),
    }
    line = (
        one.garment,
        one.noise,
        "on" if one.feedback else "off",
        f"{told['steps_held']} of {told['steps']}",
        lost or ABSENT,
        f"{told['last_iou']:.3f}" if last else ABSENT,
        f"{told['last_mean_mm']:.1f}" if last else ABSENT,
        f"{told['held']} of {told['of']}",
        f"{told['success_low']:.0%} to {told['success_high']:.0%}",
        f"{told['real_time']:.2f}",
        seconds(told["cpu_s"]),
    )
    return Row((line,), told)
