"""Rehearse a plan: perform it in simulated worlds, several side by side in workers, and count how often it holds."""

import os
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, wait
from dataclasses import dataclass, field, replace
from functools import partial
from time import process_time

import numpy as np

from app.distribution import require
from app.rehearsal.judge import Gate
from app.rehearsal.noise import NOISE, Noise
from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.result import RehearsalResult, Run
from app.worker.process import Caller
from app.worker.stop import StoppedError
from app.worker.workers import Team
from planner.deadline import ShouldStop
from planner.errors import RequestError, UnsolvedPlanError
from planner.geometry.pose import Pose2
from planner.task.plan import Plan
from planner.task.task import Task

RUNS_MAX = 1000
_LOOK_S = 0.2
"""The interval at which a rehearsal looks for progress (s)."""


@dataclass(frozen=True, slots=True)
class RehearsalOptions:
    """The options of a rehearsal.

    Attributes:
        runs: how often.
        seed: the seed of the first run; each run after it has the next.
        noise: the name of the noise, one of `NOISE`.
        feedback: whether the robot looks before each step and corrects it.
        resolution: how finely the world is simulated; None as finely as suits the garment's size.
        gate: what counts as held.
        workers: processes at most; None for two, or one on a machine with one core.
        traced: the number of the first runs of which a trace is kept.
    """

    runs: int = 1
    seed: int = 0
    noise: str = "none"
    feedback: bool = True
    resolution: Resolution | None = None
    gate: Gate = field(default_factory=Gate)
    workers: int | None = None
    traced: int = 0

    def __post_init__(self) -> None:
        """Check the fields; raises `RequestError`."""
        if not 1 <= self.runs <= RUNS_MAX:
            raise RequestError("runs", f"{self.runs} is not between 1 and {RUNS_MAX}")
        if not 0 <= self.seed < 2**31:
            raise RequestError("seed", f"{self.seed} is not between 0 and {2**31 - 1}")
        if self.noise not in NOISE:
            raise RequestError("noise", f"expected one of {', '.join(NOISE)}; got {self.noise!r}")


def require_physics() -> None:
    """Raise a `RequestError` that says what to install, unless rehearsals can be made here."""
    require("mujoco", "cv2")


def rehearse(
    plan: Plan,
    options: RehearsalOptions,
    progress: Callable[[float], None] = lambda _: None,
) -> RehearsalResult:
    """Perform a plan in simulated worlds, and judge each step; the same options give the same result.

    Args:
        plan: a solved plan.
        options: how often, and in what worlds.
        progress: called with the fraction that is done, as it rises.

    Raises:
        UnsolvedPlanError: the plan has no steps to rehearse.
        RequestError: MuJoCo or OpenCV is not installed.
    """
    if plan.trajectory is None:
        raise UnsolvedPlanError(plan.status)
    require_physics()
    seeds = range(options.seed, options.seed + options.runs)
    workers = min(options.runs, options.workers or min(2, os.cpu_count() or 1))
    if workers > 1:
        return RehearsalResult(_side_by_side(plan, options, seeds, workers, progress))
    runs: list[Run] = []
    for seed in seeds:
        runs.append(one_run(plan, options, seed, _share(progress, len(runs), options.runs)))
    return RehearsalResult(tuple(runs))


def one_run(
    plan: Plan,
    options: RehearsalOptions,
    seed: int,
    progress: Callable[[float], None],
    should_stop: ShouldStop = lambda: False,
) -> Run:
    """Perform a plan once; raise `StoppedError` once it should stop."""
    # Here: they need MuJoCo and the whole planner, which a server that only passes rehearsals on does not load.
    from app.rehearsal.camera_world import CameraWorld
    from app.rehearsal.filmed_world import FilmedWorld, Tick
    from app.rehearsal.noisy_world import NoisyWorld
    from app.rehearsal.perform import Performance, Performer
    from app.rehearsal.physics.physics_world import PhysicsWorld
    from app.rehearsal.step_motions import posture_at
    from app.rehearsal.trace import looked_before, traced
    from app.rehearsal.world import WITHDRAW, StepMotion
    from planner.plans import make_plan

    began, noise = process_time(), NOISE[options.noise]
    placement, fabric = _laid_out(plan, noise, seed)
    resolution = options.resolution or Resolution.of(plan.garment.pattern.area)

    def begun(film: Tick) -> PhysicsWorld:
        def tick() -> None:
            if should_stop():
                raise StoppedError
            film()

        return PhysicsWorld(plan.task, fabric, resolution, seed, placement, tick)

    def planned_again(task: Task) -> Plan:
        world.end()
        again = make_plan(task, should_stop=should_stop)
        if should_stop():
            raise StoppedError
        return again

    rising = _rising(progress)
    world = FilmedWorld(plan, begun, rising)
    assert plan.trajectory is not None
    begins = posture_at(plan.trajectory, 0.0)
    camera = CameraWorld(world, plan.task, begins, seed)
    seen = camera if noise == Noise() else NoisyWorld(camera, noise, seed, plan.task)
    seen.perform(StepMotion(0, WITHDRAW, 0.0, ends=begins))  # it stands beside where it believes to
    performer = Performer(plan, seen, options.gate, planned_again if options.feedback else None, rising)
    try:
        found = performer.performed()
    except FloatingPointError as error:
        found = Performance((), (), str(error))
    trace = None
    if seed - options.seed < options.traced:
        looks = [{**one.to_dict(), "of_plan": looked_before(plan, one.before)} for one in found.pictures]
        trace = traced(plan, world.truth(), world.frames, found.cloths, looks)
    took_s = process_time() - began
    return Run(seed, found.steps, found.decisions, found.reason, world.elapsed_s, took_s, found.pictures, trace)


def _laid_out(plan: Plan, noise: Noise, seed: int) -> tuple[Pose2, Fabric]:
    """Return where a run finds the cloth, table frame, and its fabric, both with errors drawn by the seed."""
    lies = plan.task.start.placement
    x, y, turn, slip = np.random.default_rng(seed).normal(size=4).tolist()
    placement = lies.moved(noise.placement_m * x, noise.placement_m * y)
    placement = replace(placement, yaw_rad=lies.yaw_rad + noise.placement_rad * turn)
    friction = plan.scene.friction * max(0.0, 1.0 + noise.friction * slip)
    garment = plan.garment
    return placement, Fabric(garment.areal_density_kg_m2, friction=friction, thickness_m=garment.thickness_m)


def _rising(progress: Callable[[float], None]) -> Callable[[float], None]:
    """Return a function that passes on only progress beyond that before: a step that is tried again goes back."""
    most = 0.0

    def rise(share: float) -> None:
        nonlocal most
        if share > most:
            most = share
            progress(share)

    return rise


def _share(progress: Callable[[float], None], before: int, runs: int) -> Callable[[float], None]:
    """Return a function that takes a run's progress and tells that of all runs, `before` of which are done."""
    return lambda fraction: progress((before + fraction) / runs)


def _run(caller: Caller, plan: Plan, options: RehearsalOptions, seed: int) -> Run:
    """Perform a plan once, in a worker."""
    return one_run(plan, options, seed, caller.tell, caller.should_stop)


def _side_by_side(
    plan: Plan,
    options: RehearsalOptions,
    seeds: range,
    workers: int,
    progress: Callable[[float], None],
) -> tuple[Run, ...]:
    shares = [0.0] * len(seeds)
    with Team(workers) as team:
        runs = [
            team.start(team.run, _run, team.stop, partial(shares.__setitem__, number), plan, options, seed)
            for number, seed in enumerate(seeds)
        ]
        left = set(runs)
        while left:
            ended, left = wait(left, _LOOK_S, FIRST_COMPLETED)
            progress(sum(shares) / len(seeds))
            for one in ended:
                one.result()
        return tuple(one.result() for one in runs)
