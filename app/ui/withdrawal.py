"""Arms that go home once a plan is over, so that the packet is seen; this is shown, but not part of the plan.

They go straight, joint by joint, which raises the hands all the way. Arms of a robot that stands fast may meet on such
a way, as only the planner could tell: they stay.
"""

from dataclasses import replace

from planner.geometry.pose import wrapped_angle
from planner.motion.timeline import Sample
from planner.robots.card import RobotCard

LASTS_S = 1.4
"""How long they take (s)."""


def withdrawn(card: RobotCard, last: Sample, since_s: float) -> Sample:
    """Return the last sample of a plan with the arms on their way home, some time after its end (s)."""
    if card.is_fixed:
        return last
    share = min(since_s / LASTS_S, 1.0)
    eased = share * share * (3.0 - 2.0 * share)
    joints = dict(last.joints)
    for arm in card.arms:
        for name, home, is_endless in zip(arm.joint_names, arm.home, arm.is_continuous, strict=True):
            away = home - joints[name]
            joints[name] += eased * (wrapped_angle(away) if is_endless else away)
    return replace(last, joints=joints)
