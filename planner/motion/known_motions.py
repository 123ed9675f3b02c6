"""What is known of the motions of a task's steps, whatever the search tries: it is kept from plan to plan, by value.

A drawing is planned soon and then well, and a search tries tightened tasks too: they all ask about the same motions.
"""

from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TypeAlias

from planner.cloth.garment import Garment
from planner.geometry.pose import Pose2
from planner.motion.robot_port import RobotPort
from planner.motion.transfer_candidate import Candidate
from planner.task.scene import Scene

_TASKS_KEPT, _CANDIDATES_MAX, _GLANCES_MAX = 12, 48, 2048
"""Tasks of which the motions stay known, and the most candidates, some 40 kB each, and glances kept for each task."""

Key: TypeAlias = tuple[object, ...]
"""The key of the motions of some steps, see `motion_of`."""


@dataclass(frozen=True, slots=True, eq=False)
class KnownMotions:
    """What is known of the motions of one task. May be shared between threads.

    Attributes:
        can_be_there: whether the arms have free postures where the steps begin and end.
        candidates: the candidates that steps make, without the steps.
    """

    can_be_there: dict[Key, bool] = field(default_factory=dict)
    candidates: dict[Key, Candidate] = field(default_factory=dict)

    def keep_glance(self, key: Key, can_be_there: bool) -> None:
        """Keep whether the arms have free postures at the ends of steps; once there are many, forget all others."""
        if len(self.can_be_there) >= _GLANCES_MAX:
            self.can_be_there.clear()
        self.can_be_there[key] = can_be_there

    def keep_candidate(self, candidate: Candidate) -> None:
        """Keep a candidate; once there are many, forget all others."""
        if len(self.candidates) >= _CANDIDATES_MAX:
            self.candidates.clear()
        self.candidates[candidate.motion] = replace(candidate, steps=())


def motions_known(
    machine: RobotPort, garment: Garment, scene: Scene, placement: Pose2, comfort_m: float
) -> KnownMotions:
    """Return what is known of the motions of a task, told from others by all that they depend on.

    The approach cone is not among these: it says which ways there are, and not how they go. With another comfort radius
    the base may have to drive elsewhere meanwhile.
    """
    return _known(machine, garment, replace(scene, approach_cone_rad=0.0), placement, comfort_m)


@lru_cache(_TASKS_KEPT)
def _known(_machine: RobotPort, _garment: Garment, _scene: Scene, _placement: Pose2, _comfort_m: float) -> KnownMotions:
    return KnownMotions()


def forget_motions() -> None:
    """Forget what is known of all motions."""
    _known.cache_clear()
