"""The space that a robot takes while it waits."""

from functools import lru_cache

import numpy as np

from app.ui.robot_model import Pose3, load_robot_model
from app.ui.rotation import product, rotated, to_matrix
from planner.geometry.pose import FloatArray
from planner.robots.card import RobotCard


@lru_cache(maxsize=8)
def waiting_box(card: RobotCard, torso_m: float) -> FloatArray:
    """Return the lowest and the highest corner of the box around a robot at home, shape (2, 3), base frame, m.

    Args:
        card: the robot.
        torso_m: how far its lift is raised (m).
    """
    joints = card.joint_values(torso_m, [np.array(arm.home) for arm in card.arms], [0.0] * len(card.arms))
    places: dict[str, Pose3] = {"": Pose3()}
    corners = []
    for link in load_robot_model(card.urdf_path, card.package_dir):
        here = link.pose_at(joints.get(link.joint or "", 0.0))
        place = places[link.node] = _placed(places[link.node.rpartition("/")[0]], here)
        for visual in link.visuals:
            shape = _placed(place, visual.pose)
            points = visual.vertices @ to_matrix(shape.wxyz).T + np.array(shape.position)
            corners += [points.min(axis=0), points.max(axis=0)]
    return np.array([np.min(corners, axis=0), np.max(corners, axis=0)])


def _placed(outer: Pose3, inner: Pose3) -> Pose3:
    x, y, z = (a + b for a, b in zip(outer.position, rotated(outer.wxyz, inner.position), strict=True))
    return Pose3((x, y, z), product(outer.wxyz, inner.wxyz))
