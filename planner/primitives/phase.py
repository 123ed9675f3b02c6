"""What a primitive looks like while it happens: the one language between primitives and the timeline.

A primitive is cut into phases. In a phase the base goes straight from one pose to another (or turns
in place), each hand is free or follows points at an even pace in one orientation, and the cloth is
carried along, folded a part of the way, or lies still. The timeline turns phases into joint values and
cloth into surfaces without knowing which primitive they came from.
"""

from dataclasses import dataclass

from planner.geometry.pose import Approach, Point3, Pose2
from planner.task.cloth_motion import ClothMotion


@dataclass(frozen=True, slots=True)
class Hand:
    """What one hand does in a phase.

    Attributes:
        approach: the tool's orientation in the base frame, held through the phase.
        points: the tool's path in the table frame (m), one or more points, passed at an even pace.
        is_closed: whether the fingers hold cloth.
        is_reaching: the hand travels to the (only) point from wherever it is, by way of points
            above where it was and above where it goes.
        rolls_rad: how far the tool has rolled about its approach axis at each point, since the primitive began;
            empty: not at all.
    """

    approach: Approach
    points: tuple[Point3, ...]
    is_closed: bool
    is_reaching: bool = False
    rolls_rad: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Phase:
    """A stretch of time in which everything moves evenly.

    Attributes:
        duration_s: its length (s), not negative.
        base: the base's pose at the start and the end, table frame.
        hands: one entry for each arm from left to right; None: the hand is free and goes home.
        cloth: what the cloth does.
        motion: which of its primitive's arm motions it is a part of: such phases share their time as the joints
            need it; None: the base drives or nothing moves, and no part may be quicker than that.
    """

    duration_s: float
    base: tuple[Pose2, Pose2]
    hands: tuple[Hand | None, ...]
    cloth: ClothMotion
    motion: int | None = None
