"""The moving parts of a plan as columns of numbers, in the order of `MotionLimits.names`, with derivatives by time."""

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.task.trajectory import Trajectory


def positions_at(path: Trajectory, times_s: FloatArray) -> FloatArray:
    """Return joints, grippers and base at times of a plan, shape (n, names): rad, m; the base's yaw without jumps."""
    rows = [
        (*path.arms.at(t), *(track.position_at(t) for track in path.grippers), *_pose(path, t))
        for t in times_s.tolist()
    ]
    found = np.array(rows)
    found[:, -1] = np.unwrap(found[:, -1])
    return found


def velocities_at(path: Trajectory, times_s: FloatArray) -> FloatArray:
    """Return their velocities just after some times, shape (n, names): rad/s, m/s."""
    rows = [
        (*path.arms.velocities_at(t), *(track.velocity_at(t) for track in path.grippers), *_velocity(path, t))
        for t in times_s.tolist()
    ]
    return np.array(rows)


def accelerations_at(path: Trajectory, times_s: FloatArray, end_s: float) -> FloatArray:
    """Return their accelerations just after some times, from `end_s` on just before that, shape (n, names).

    Accelerations jump where a step ends and the next begins.
    """
    rows = [
        (
            *path.arms.accelerations_at(t),
            *(track.acceleration_at(t) for track in path.grippers),
            *path.segment_at(t).base_acceleration_at(t),
        )
        for t in np.minimum(times_s, end_s - TIME_S).tolist()
    ]
    return np.array(rows)


def _pose(path: Trajectory, t_s: float) -> tuple[float, float, float]:
    pose = path.segment_at(t_s).base_at(t_s)
    return pose.x_m, pose.y_m, pose.yaw_rad


def _velocity(path: Trajectory, t_s: float) -> FloatArray:
    return path.segment_at(t_s).base_velocity_at(t_s)
