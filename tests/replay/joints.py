"""The joints of a trajectory, 50 times a second, and their limits."""

import numpy as np

from planner.geometry.table import Table
from planner.motion.timeline import Timeline
from tests.replay.hands import robot
from tests.replay.hulls import contacts

RATE_HZ = 50.0


def arm_joints(timeline: Timeline) -> tuple[list[str], np.ndarray, float]:
    """Return the arms' joints, 50 samples a second, shape (n, joints), and the time between two (s)."""
    count = int(np.ceil(timeline.duration_s * RATE_HZ))
    frames = [timeline.trajectory.joints_at(float(t)) for t in np.linspace(0.0, timeline.duration_s, count + 1)]
    names = [joint for joint in frames[0] if joint.split("_", 1)[1].endswith(("_joint",)) and joint[1] == "_"]
    arms = [joint for joint in names if not joint.split("_", 1)[1].startswith("gripper")]
    values = np.array([[frame[joint] for joint in arms] for frame in frames])
    return arms, values, timeline.duration_s / count


def speed_limits(joints: list[str]) -> np.ndarray:
    model, _ = robot()
    return np.array([model.velocityLimit[model.joints[model.getJointId(joint)].idx_v] for joint in joints])


def require_speeds(timeline: Timeline) -> None:
    """Require that no arm joint is faster than the URDF allows."""
    joints, values, step_s = arm_joints(timeline)
    speeds = np.abs(np.diff(values, axis=0)) / step_s
    over = speeds / speed_limits(joints)
    worst = np.unravel_index(over.argmax(), over.shape)
    assert over.max() <= 1.0 + 1e-6, f"{joints[worst[1]]} at {worst[0] * step_s:.2f} s: {over.max():.2f} of its speed"


def require_clear(timeline: Timeline, table: Table, every_s: float) -> None:
    """Require that nothing touches anything but the cloth."""
    for t in np.arange(0.4 * every_s, timeline.duration_s, every_s):
        base = timeline.base_at(float(t))
        found = contacts(timeline.trajectory.joints_at(float(t)), (base.x_m, base.y_m, base.yaw_rad), table)
        assert not found, f"at {t:.2f} s: {found}"
