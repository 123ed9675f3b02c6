"""What is different in each demonstration: where the cloth lies, the cloth itself, colours, light and cameras."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from app.rehearsal.camera.look import Look, random_look
from app.rehearsal.camera.mounted import overhead, wrists
from app.rehearsal.camera.robot_shape import robot_shape
from app.rehearsal.physics.fabric import Fabric
from planner.robots.card_parts import CameraFile
from planner.robots.load_robot import load_robot, robot_card_file
from planner.task.task import Task

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
    """The world of one demonstration.

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
