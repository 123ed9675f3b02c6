"""A world with errors of robot and camera: motions end a little elsewhere or fail, and arms are not quite in place."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.rehearsal.camera.posture import Posture
from app.rehearsal.judge import carry, slide_of
from app.rehearsal.noise import Noise
from app.rehearsal.world import REACH, GripMotion, Observation, Performed, StepMotion, Truth, World, way_done
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Pose2
from planner.robots.load_robot import load_robot
from planner.task.task import Task


class NoisyWorld:
    """A world that is seen and acted on with errors.

    The robot believes that its base is where it should be. What it sees it places in the frame of its base (an overhead
    camera sees the base too), so a correction by what is seen takes off the base's error. Where a drag has stopped
    short, hands that hold on go on from there; once they are free, the base is driven to where it should be.
    """

    def __init__(self, world: World, noise: Noise, seed: int, task: Task) -> None:
        """Take a world, the noise, its seed, and the task: the robot, and where its base stands at first."""
        self._world, self._noise, self._robot = world, noise, task.robot
        self._rng, self._idle_rng = np.random.default_rng(seed), np.random.default_rng([seed, 1])
        self._calibrated = Isometry.rotation(0.0, *self._rng.normal(0.0, noise.camera_m, 2).tolist())
        self._error = self._driven(task.start.base.pose)
        self._short = Isometry()
        self._arm_errors: dict[str, FloatArray] = {}
        self._reached: dict[str, FloatArray] = {}

    def observe(self) -> Observation:
        """Return what is seen, with camera and outline as seen from where the robot believes to be."""
        seen, believed = self._world.observe(), self._calibrated.after(self._short.after(self._error).inverse)
        camera = None if seen.camera is None else seen.camera.carried(believed)
        outline = None if seen.outline is None else believed.apply(seen.outline)
        return replace(seen, camera=camera, outline=outline)

    def perform(self, motion: StepMotion) -> Performed:
        """Perform a step from where the base really is; a hand may miss its grip, and a drag may stop short."""
        if motion.base is not None:
            self._error = self._driven(motion.base)
        missed = {grip.arm for grip in motion.grips if grip.closes and self._rng.random() < self._noise.miss}
        if missed and motion.needs_all:
            return Performed({grip.arm: grip.arm not in missed for grip in motion.grips})
        made = tuple(grip for grip in motion.grips if grip.arm not in missed)
        if all(grip.closes for grip in made):
            self._short = Isometry()
        short = self._rng.uniform(0.0, self._noise.undershoot) if motion.is_pulled else 0.0
        found = tuple(self._off(grip, short) for grip in made)
        if made and motion.is_drag:
            planned = np.array([grip.points[-1][:2] for grip in made])
            stopped = [np.subtract(grip.points[-1][:2], self._arm_errors[grip.arm]) for grip in found]
            self._short = slide_of(self._error.apply(planned), np.array(stopped)).isometry
        if all(grip.opens for grip in made):
            self._short = Isometry()
        beside = self._drawn_errors() | {grip.arm: self._arm_errors[grip.arm] for grip in made}
        self._reached = beside if motion.kind == REACH else {} if made else self._reached
        answer = self._world.perform(replace(motion, grips=found, ends=self._really(motion.ends, beside)))
        return Performed({**answer.has_cloth, **dict.fromkeys(missed, False)})

    def truth(self) -> Truth | None:
        """Return where the cloth really is."""
        return self._world.truth()

    def _driven(self, base: Pose2) -> Isometry:
        """Return the error with which the base arrives: from where the robot believes to be to where it is."""
        x, y = self._rng.normal(0.0, self._noise.base_m, 2).tolist()
        return carry(
            base, Pose2(base.x_m + x, base.y_m + y, base.yaw_rad + self._rng.normal(0.0, self._noise.base_rad))
        )

    def _drawn_errors(self) -> dict[str, FloatArray]:
        """Return random errors of the positions of all tools, by arm, for motions without cloth, table frame (m)."""
        return {arm.name: self._idle_rng.normal(0.0, self._noise.arm_m, 2) for arm in load_robot(self._robot).card.arms}

    def _really(self, ends: Posture | None, beside: Mapping[str, FloatArray]) -> Posture | None:
        """Return the robot's true posture for the one that it believes to have, given the errors of its tools (m)."""
        if ends is None:
            return None
        error = self._short.after(self._error)
        x, y = error.apply_point((ends.base.x_m, ends.base.y_m))
        stands = replace(ends, base=Pose2(x, y, ends.base.yaw_rad + math.atan2(error.c, error.a)))
        return deflected(self._robot, stands, beside)

    def _off(self, grip: GripMotion, short: float) -> GripMotion:
        """Return the motion that a hand really makes; one that holds on goes on from where it is."""
        points = np.array(grip.points)
        done = way_done(points)[:, None]
        points[:, :2] = points[0, :2] + (1.0 - short) * (points[:, :2] - points[0, :2])
        after = self._rng.normal(0.0, self._noise.arm_m, 2)
        after = self._reached.get(grip.arm, after) if grip.closes else after
        before = after if grip.closes else self._arm_errors.get(grip.arm, after)
        self._arm_errors[grip.arm] = after
        points[:, :2] = self._short.apply(self._error.apply(points[:, :2])) + (1.0 - done) * before + done * after
        return grip.along(points)


_TURN_RAD = 1e-4
"""The turn of a joint by which its effect on the tool is measured (rad)."""

_WEAK = 0.05
"""Directions in which joints move a tool less than this share of the best one are ignored."""


def deflected(robot_name: str, posture: Posture, beside: Mapping[str, FloatArray]) -> Posture:
    """Return a posture with the smallest changes of the joints that move the tools by offsets (m).

    Args:
        robot_name: the name of the robot.
        posture: how it believes to stand.
        beside: how far the tools of its arms are beside their places, table frame, shape (2,), m, by the arms' names.
    """
    robot = load_robot(robot_name)
    cos, sin = np.cos(posture.base.yaw_rad), np.sin(posture.base.yaw_rad)
    joints = dict(posture.joints)
    torso_m = joints.get(robot.card.lift_joint or "", 0.0)
    for number, arm in enumerate(robot.card.arms):
        if arm.name not in beside:
            continue
        x, y = beside[arm.name]
        now = np.array([joints[name] for name in arm.joint_names])
        places = robot.tool_places(number, np.vstack([now, now + _TURN_RAD * np.eye(len(now))]), torso_m)
        slopes = (places[1:] - places[0]).T / _TURN_RAD
        errors = np.linalg.pinv(slopes, rcond=_WEAK) @ np.array([cos * x + sin * y, cos * y - sin * x, 0.0])
        joints |= dict(zip(arm.joint_names, (now + errors).tolist(), strict=True))
    return replace(posture, joints=joints)
