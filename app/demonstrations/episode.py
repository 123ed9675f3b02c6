"""One demonstration: a world made by a seed, a plan for it, performed in simulated physics and filmed."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from app.files.lerobot_dataset import Episode, Pictures, frame_times_s, picture_stats
from app.rehearsal.camera.look import Look, coded, random_look
from app.rehearsal.camera.mounted import camera_of, overhead, wrists
from app.rehearsal.camera.picture import ClothSeen, picture
from app.rehearsal.camera.robot_shape import robot_shape
from app.rehearsal.filmed_world import FilmedWorld
from app.rehearsal.judge import Gate
from app.rehearsal.perform import Performer
from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.physics_world import PhysicsWorld
from app.rehearsal.step_motions import posture_at
from app.rehearsal.trace import RunTrace, traced
from app.worker.stop import StoppedError
from planner.deadline import ShouldStop
from planner.geometry.pose import FloatArray
from planner.plans import make_plan
from planner.robots.card_parts import CameraFile
from planner.robots.load_robot import load_robot, robot_card_file
from planner.task.plan import Plan
from planner.task.task import Task

_QUALITY = 90
_COLOURS_EVERY = 15
"""Every so many frames are looked at for the statistics of colours."""

PLACE_M, TURN_RAD = 0.03, 0.1
"""Cloth lies up to so far from where the task has it, along each axis (m), and is turned by so much (rad)."""

_DENSITY, _FRICTION, _BENDING_M = (0.7, 1.4), (0.85, 1.15), (0.013, 0.023)
"""The shares of the garment's density and of the scene's friction, and bending lengths (m)."""

_CAMERA_M, _CAMERA_RAD = 0.03, 0.02
_WRIST_M, _WRIST_RAD = 0.005, 0.03
_WIDTH_PX = 320
"""The width of pictures; it is even, and so is their height, as videos need it."""

_WRIST_PX = (160, 120)


@dataclass(frozen=True, slots=True)
class Variation:
    """The world of one demonstration: where the cloth lies, the cloth itself, colours, light and cameras.

    Attributes:
        task: the task, the cloth where it lies.
        fabric: the cloth.
        cameras: what looks at it: ``table``, and for each arm ``ARM_wrist``.
        look: colours and light.
    """

    task: Task
    fabric: Fabric
    cameras: Mapping[str, CameraFile]
    look: Look

    @staticmethod
    def of(task: Task, seed: int, *, has_wrists: bool = True) -> "Variation":
        """Return the world that a seed makes of a task, with cameras on wrists or without."""
        rng = np.random.default_rng(seed)
        x_m, y_m, turn = rng.uniform(-1.0, 1.0, 3).tolist()
        lies = task.start.placement.moved(PLACE_M * x_m, PLACE_M * y_m)
        moved = task.at(replace(lies, yaw_rad=lies.yaw_rad + TURN_RAD * turn))
        density, friction, bending = (float(rng.uniform(*ends)) for ends in (_DENSITY, _FRICTION, _BENDING_M))
        fabric = Fabric(
            density * task.garment.areal_density_kg_m2,
            friction=friction * task.scene.friction,
            bending_length_m=bending,
            thickness_m=task.garment.thickness_m,
        )
        file, card = robot_card_file(task.robot), load_robot(task.robot).card
        given = file.camera or overhead(task.scene.table)
        height_px = 2 * math.ceil(_WIDTH_PX * given.height_px / given.width_px / 2.0)
        table = _moved(replace(given, width_px=_WIDTH_PX, height_px=height_px), rng, _CAMERA_M, _CAMERA_RAD)
        look = random_look(rng)
        if not has_wrists:
            return Variation(moved, fabric, {"table": table}, look)
        shape = robot_shape(card, -task.scene.table.height_m)
        on_wrists = wrists(file, shape, card.home_values(task.scene.torso_m), _WRIST_PX)
        cameras = {f"{arm}_wrist": _moved(one, rng, _WRIST_M, _WRIST_RAD) for arm, one in on_wrists.items()}
        return Variation(moved, fabric, {"table": table, **cameras}, look)


def _moved(given: CameraFile, rng: np.random.Generator, most_m: float, most_rad: float) -> CameraFile:
    """Return a camera moved along each axis, and turned about each, by up to so much."""
    off_m, off_rad = most_m * rng.uniform(-1.0, 1.0, 3), most_rad * rng.uniform(-1.0, 1.0, 3)
    return replace(
        given,
        x_m=given.x_m + float(off_m[0]),
        y_m=given.y_m + float(off_m[1]),
        z_m=given.z_m + float(off_m[2]),
        roll_rad=given.roll_rad + float(off_rad[0]),
        pitch_rad=given.pitch_rad + float(off_rad[1]),
        yaw_rad=given.yaw_rad + float(off_rad[2]),
    )


def demonstration(
    task: Task,
    seed: int,
    should_stop: ShouldStop,
    resolution: Resolution | None = None,
    *,
    has_wrists: bool = True,
) -> Episode | None:
    """Return the demonstration of a task with a seed; None if there is no plan, or a step does not hold.

    The robot does exactly what the plan says, so its joints are the plan's; nothing is corrected.

    Raises:
        StoppedError: it was stopped.
    """
    varied = Variation.of(task, seed, has_wrists=has_wrists)
    plan = make_plan(varied.task, should_stop=should_stop)
    if should_stop():
        raise StoppedError
    if not plan.is_solved:
        return None
    trace, pattern = _performed(plan, varied, seed, should_stop, resolution)
    return None if trace is None else _filmed(plan, varied, seed, trace, pattern)


def _performed(
    plan: Plan, varied: Variation, seed: int, should_stop: ShouldStop, resolution: Resolution | None
) -> tuple[RunTrace | None, np.ndarray]:
    """Return the cloth along the plan, None where a step does not hold, and its points in the pattern."""

    def begun(film: Callable[[], None]) -> PhysicsWorld:
        def tick() -> None:
            if should_stop():
                raise StoppedError
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
