"""One demonstration: a world made by a seed, a plan for it, performed in simulated physics and filmed."""

from collections.abc import Callable

import numpy as np

from app.demonstrations.variation import Variation
from app.files.lerobot_dataset import Episode, Pictures, frame_times_s, picture_stats
from app.rehearsal.camera.look import coded
from app.rehearsal.camera.mounted import camera_of
from app.rehearsal.camera.picture import ClothSeen, picture
from app.rehearsal.camera.robot_shape import robot_shape
from app.rehearsal.filmed_world import FilmedWorld
from app.rehearsal.judge import Gate
from app.rehearsal.perform import Performer
from app.rehearsal.physics.fabric import Resolution
from app.rehearsal.physics.physics_world import PhysicsWorld
from app.rehearsal.step_motions import posture_at
from app.rehearsal.trace import RunTrace, traced
from planner.geometry.pose import FloatArray
from planner.plans import make_plan
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan
from planner.task.task import Task

_QUALITY = 90
_COLOURS_EVERY = 15
"""Every so many frames are looked at for the statistics of colours."""


class StopError(Exception):
    """The demonstration is not wanted any more."""


def demonstration(
    task: Task,
    seed: int,
    should_stop: Callable[[], bool],
    resolution: Resolution | None = None,
    *,
    has_wrists: bool = True,
) -> Episode | None:
    """Return the demonstration that a seed makes of a task; None where there is no plan, or a step does not hold.

    The robot does exactly what the plan says, so its joints are the plan's; nothing is corrected.

    Raises:
        StopError: it was stopped.
    """
    varied = Variation.of(task, seed, has_wrists=has_wrists)
    plan = make_plan(varied.task, should_stop=should_stop)
    if should_stop():
        raise StopError
    if not plan.is_solved:
        return None
    trace, pattern = _performed(plan, varied, seed, should_stop, resolution)
    return None if trace is None else _filmed(plan, varied, seed, trace, pattern)


def _performed(
    plan: Plan, varied: Variation, seed: int, should_stop: Callable[[], bool], resolution: Resolution | None
) -> tuple[RunTrace | None, np.ndarray]:
    """Return the cloth along the plan, None where a step does not hold, and its points in the pattern."""

    def begun(film: Callable[[], None]) -> PhysicsWorld:
        def tick() -> None:
            if should_stop():
                raise StopError
            film()

        fine = resolution or Resolution.of(plan.garment.pattern.area)
        return PhysicsWorld(plan.task, varied.fabric, fine, seed, None, tick)

    world = FilmedWorld(plan, begun)
    pattern = world.truth().pattern
    try:
        found = Performer(plan, world, Gate()).performed()
    except FloatingPointError:
        return None, pattern
    if found.reason or not all(step.held for step in found.steps):
        return None, pattern
    return traced(plan, world.truth(), world.frames, found.cloths, []), pattern


def _filmed(plan: Plan, varied: Variation, seed: int, trace: RunTrace, pattern: np.ndarray) -> Episode:
    card, table, path = load_robot(plan.task.robot).card, plan.scene.table, plan.trajectory
    assert path is not None
    shape = robot_shape(card, -table.height_m)
    jpegs = {name: list[bytes]() for name in varied.cameras}
    colours = {name: list[FloatArray]() for name in varied.cameras}
    for number, t_s in enumerate(frame_times_s(plan).tolist()):
        posture = posture_at(path, min(t_s, path.duration_s))
        cloth = ClothSeen(pattern, trace.at(t_s), trace.triangles.astype(np.int64))
        parts = shape.parts(posture)
        for name, given in varied.cameras.items():
            image = picture(camera_of(given, shape, posture), table, cloth, parts, varied.look, seed, number)
            jpegs[name].append(coded(image, _QUALITY))
            if number % _COLOURS_EVERY == 0:
                colours[name].append(image[::4, ::4, ::-1].reshape(-1, 3) / 255.0)
    pictures = {
        name: Pictures(
            tuple(jpegs[name]),
            (given.width_px, given.height_px),
            picture_stats(np.vstack(colours[name]), len(jpegs[name])),
        )
        for name, given in varied.cameras.items()
    }
    return Episode.of(plan, card, pictures)
