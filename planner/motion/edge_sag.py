"""Whether fingers under cloth stay out of the table between the waypoints of a transfer, where joints sag a little.

Fingers side by side are well above the table while they hold cloth; the lower one of a hand at an edge has some tenths
of a millimetre.
"""

import numpy as np

from planner.geometry.keyframes import values_at
from planner.geometry.tolerance import TIME_S
from planner.motion.opened_collisions import OpenedCollisions
from planner.motion.transfer_path import TransferPath
from planner.motion.transfer_timing import TransferTiming
from planner.robots.joint_layout import JointLayout

_SHARES = np.array([0.25, 0.5, 0.75])
"""Where between two waypoints hands are tested."""


def is_clear_between(
    transfer_path: TransferPath, timing: TransferTiming, layout: JointLayout, collisions: OpenedCollisions
) -> bool:
    """Return whether arms whose hands hold edges touch neither body nor table between the waypoints of a transfer."""
    arms = [arm for arm, hold in enumerate(transfer_path.lines.holds) if hold.is_narrow]
    if not arms:
        return True
    gaps = np.diff(timing.times_s)
    starts = np.flatnonzero(gaps > TIME_S)
    times = (timing.times_s[starts, None] + gaps[starts, None] * _SHARES).ravel()
    rows = transfer_path.first + timing.waypoints
    joints = values_at(timing.times_s, transfer_path.joints[rows], timing.velocities, times)
    bases = np.column_stack([np.interp(times, timing.times_s, column) for column in transfer_path.bases[rows].T])
    return all(
        collisions.of(transfer_path.lines.holds[arm], is_open=False)
        .arm_free(arm, bases, joints[:, layout.spans[arm]])
        .all()
        for arm in arms
    )
