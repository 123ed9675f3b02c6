"""Every joint of the shipped plans stays within the soft limits of the PR2's safety controllers, all the time."""

from importlib.metadata import distribution
from xml.etree import ElementTree

import numpy as np

from planner.geometry.keyframes import values_at
from tests.replay.hands import URDF
from tests.replay.planned import each_solvable, shipped_plan

STEP_S = 0.01
ROUNDING = 1e-6


def soft_limits() -> dict[str, tuple[float, float]]:
    """Return the soft limits of the joints that have them, as the URDF's text says."""
    root = ElementTree.parse(str(distribution("example-robot-data").locate_file(URDF))).getroot()
    found = {joint.get("name", ""): joint.find("safety_controller") for joint in root.iterfind("joint")}
    return {
        name: (float(own.attrib["soft_lower_limit"]), float(own.attrib["soft_upper_limit"]))
        for name, own in found.items()
        if own is not None and "soft_lower_limit" in own.attrib
    }


@each_solvable
def test_all_joints_stay_within_the_soft_limits_all_the_time(name: str) -> None:
    path, limits = shipped_plan(name).trajectory, soft_limits()
    assert path is not None and len({*path.arms.names} & {*limits}) == 10
    times_s = np.array(path.arms.times_s)
    rows = values_at(times_s, path.arms.rows, path.arms.rates, np.arange(times_s[0], times_s[-1], STEP_S))
    for joint, column in zip(path.arms.names, np.concatenate([rows, path.arms.rows]).T, strict=True):
        if joint in limits:
            low, high = limits[joint]
            assert low - ROUNDING <= column.min() and column.max() <= high + ROUNDING, joint
    low_m, high_m = limits["torso_lift_joint"]
    assert low_m <= path.torso_m <= high_m
