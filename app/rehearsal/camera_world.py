"""A simulated world seen by a camera: renders what it holds, the robot's own arms among it."""

import numpy as np

from app.rehearsal.camera.look import PLAIN
from app.rehearsal.camera.mounted import camera_of, overhead
from app.rehearsal.camera.picture import ClothSeen, picture
from app.rehearsal.camera.posture import Posture
from app.rehearsal.camera.robot_shape import robot_shape
from app.rehearsal.world import Observation, Performed, StepMotion, Truth, World
from planner.robots.load_robot import load_robot, robot_card_file
from planner.task.task import Task


class CameraWorld:
    """A world seen by the camera of the robot's card, or by one over the table if the card names none."""

    def __init__(self, world: World, task: Task, posture: Posture, seed: int) -> None:
        """Take a world that knows where its cloth is.

        Args:
            world: the world.
            task: robot and table.
            posture: how the robot stands at first.
            seed: of textures, light and noise.
        """
        self._world, self._posture, self._seed = world, posture, seed
        self._table = task.scene.table
        self._shape = robot_shape(load_robot(task.robot).card, -self._table.height_m)
        self._given = robot_card_file(task.robot).camera or overhead(self._table)
        self._moment = 0

    def observe(self) -> Observation:
        """Return the picture that the camera takes now, red, green, blue, and the camera."""
        truth = self._world.truth()
        if truth is None:
            return self._world.observe()
        self._moment += 1
        camera = camera_of(self._given, self._shape, self._posture)
        cloth = ClothSeen(truth.pattern, truth.positions, truth.triangles)
        parts = self._shape.parts(self._posture)
        image = picture(camera, self._table, cloth, parts, PLAIN, self._seed, self._moment)
        return Observation(np.ascontiguousarray(image[..., ::-1]), camera)

    def perform(self, motion: StepMotion) -> Performed:
        """Perform a step, after which the robot stands as the step ends."""
        answer = self._world.perform(motion)
        self._posture = motion.ends or self._posture
        return answer

    def truth(self) -> Truth | None:
        """Return where the cloth really is."""
        return self._world.truth()
