"""Noise models for rehearsals: the errors of robot, cloth and camera in a laboratory.

The paper gives no figures for its errors, only their kinds (section 9): bases that undershoot and stop at an angle,
grasps that miss, cloth that is not quite where it should be. The numbers here are therefore assumptions,
each with its reason; none was measured, and a laboratory should put in its own.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Noise:
    """Errors of robot, cloth and camera; each a standard deviation unless it says otherwise.

    Attributes:
        undershoot: the fraction of a drag by which the base stops short, uniform from 0 to this.
        base_m: the base's position after it has driven (m).
        base_rad: its heading (rad).
        arm_m: a tool's position, each axis in the plane (m); in a step in which a hand closes the same all the way.
        miss: the probability that fingers close beside cloth that is there.
        placement_m: where the garment lies at the start (m).
        placement_rad: how it is turned at the start (rad).
        camera_m: how far the camera is from where it is believed to be, each axis in the plane, all run long (m).
        friction: the relative error of the friction coefficient.
    """

    undershoot: float = 0.0
    base_m: float = 0.0
    base_rad: float = 0.0
    arm_m: float = 0.0
    miss: float = 0.0
    placement_m: float = 0.0
    placement_rad: float = 0.0
    camera_m: float = 0.0
    friction: float = 0.0


NOISE = {
    "none": Noise(),
    "real": Noise(
        # Base: the paper names undershoot as its main failure. ROS 1's local planners stop within .1 m and .05 rad of a
        # goal (the defaults of xy_goal_tolerance and yaw_goal_tolerance in their configuration readers), Nav2's within
        # .25 m and .25 rad (SimpleGoalChecker); docking at a table is assumed ten and five times as good as ROS 1.
        undershoot=0.1,
        base_m=0.01,
        base_rad=0.01,
        # Arm: some millimetres at the fingertips, assumed for a calibrated arm. A mobile manipulator led by its camera
        # alone came within about a centimetre once calibrated (Limoyo and others, arXiv:1803.06406).
        arm_m=0.003,
        # Grasps: the paper tries up to eight other points after a miss; about one grasp in twenty is assumed.
        miss=0.05,
        # Placement: laid by hand along a mark.
        placement_m=0.01,
        placement_rad=0.02,
        # Camera: its calibration, assumed; a pixel of the default camera over the default table is 2.75 mm.
        camera_m=0.003,
        # Friction: assumed for fabrics on one surface.
        friction=0.15,
    ),
}
"""The noise of a rehearsal by its name."""
