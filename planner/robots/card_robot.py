"""A robot as its card and its URDF describe it, ready for planning."""

import threading
from collections.abc import Sequence
from itertools import accumulate
from typing import TypeAlias

import numpy as np

from planner.geometry.pose import FloatArray
from planner.robots.armed_robot import ArmedRobot
from planner.robots.collision.described_parts import described_parts
from planner.robots.collision.robot_parts import RobotParts
from planner.robots.comfort_reach import Memories, QueriedArms
from planner.robots.described_card import robot_card
from planner.robots.described_robot import DescribedRobot
from planner.robots.edge_grip import HandShape
from planner.robots.mapped_arm import ALL_ROUND, MappedArm, all_arms
from planner.robots.mapped_comfort import ARM_LABELS, MappedArms, mapped_arms, rooted
from planner.robots.mapped_reach import Heights, MappedReach
from planner.robots.reach_map import ReachMap
from planner.robots.reach_maps import Progress, covered_heights

_Mapped: TypeAlias = tuple[MappedArms, Heights, tuple[MappedArm, ...]]
"""Arms for the compiled queries, the heights that their maps cover, and each arm alone."""


class CardRobot(ArmedRobot):
    """A robot of a card."""

    def __init__(self, described: DescribedRobot) -> None:
        """Take the description; reach maps are read, or built in seconds, when they are first needed."""
        super().__init__(robot_card(described))
        self._described = described
        self._mapping = threading.Lock()
        self._mapped: _Mapped | None = None

    def _reach(
        self, torso_m: float, comfort_m: float, memories: Memories | None, *, minds_body: bool, minds_arms: bool
    ) -> MappedReach:
        """Return the reach; body and other arms are left to the joint paths, whether they are minded or not."""
        names = tuple(arm.name for arm in self.card.arms)
        ask = np.arange(1, len(ALL_ROUND) + 1)
        labels = tuple(ARM_LABELS * number + ask for number in range(len(names)))
        joints = tuple(arm.joint_names for arm in self.card.arms)
        lengths = tuple(arm.length_m for arm in self._arms)

        def covering(arm: int, seen: FloatArray) -> tuple[MappedArms, Heights]:
            self._arms[arm].cover(seen, torso_m)
            return self._seen(torso_m)

        numbers, heights = self._seen(torso_m)
        queried = QueriedArms(names, self._arms, numbers, ALL_ROUND, labels)
        return MappedReach(queried, heights, covering, joints, lengths, torso_m, comfort_m, memories)

    def _seen(self, torso_m: float) -> tuple[MappedArms, Heights]:
        """Return the arms for the compiled queries with the lift raised, and the heights that their maps cover."""
        queried, heights, each = self._prepared()
        return rooted(queried, [arm.shoulder(torso_m) for arm in each]), heights

    def forget_reach(self) -> None:
        """Drop the memories of where the arms reach and how, so that benchmarks measure their computation."""
        super().forget_reach()
        for arm in self._arms:
            arm.forget_samples()

    def compile_samples(self) -> None:
        """Compile what samples the joints of any mapped arm."""
        self._arms[0].compile_samples()

    def prepare(self, progress: Progress | None = None) -> tuple[MappedArm, ...]:
        """Return the arms with their reach maps, which are read or built at the first call.

        Args:
            progress: called with how far the maps are that must be built (0 to 1).
        """
        return self._prepared(progress)[2]

    def _prepared(self, progress: Progress | None = None) -> _Mapped:
        """Return the arms for the compiled queries, and each alone: they share their maps, some 20 MB an arm."""
        with self._mapping:
            if self._mapped is None:
                self._mapped = _sharing(all_arms(self._described, progress))
            elif any(arm.known.postures is not self._mapped[0].postures for arm in self._mapped[2]):
                self._mapped = _sharing(self._mapped[2])
            return self._mapped

    @property
    def _arms(self) -> tuple[MappedArm, ...]:
        return self.prepare()

    @property
    def _parts(self) -> RobotParts:
        return described_parts(self._described)

    def _hand_shape(self, arm: int) -> HandShape:
        chain = self._described.arms[arm].chain
        return HandShape.of(self._parts, arm, chain.tool_offset, chain.tool_rotation)


def _sharing(arms: tuple[MappedArm, ...]) -> _Mapped:
    """Return arms for the compiled queries, and the arms, which use parts of what these hold as their maps."""
    maps = [arm.known for arm in arms]
    queried = mapped_arms([arm.chain for arm in arms], maps)
    for arm, known, shared in zip(arms, maps, shared_maps(queried, maps), strict=True):
        arm.take(known, shared)
    return queried, tuple(covered_heights(known.grid) for known in maps), arms


def shared_maps(arms: MappedArms, maps: Sequence[ReachMap]) -> tuple[ReachMap, ...]:
    """Return the maps that arms were made of as parts of what these hold, so that the maps need not be kept as well."""
    counts = [len(known.starts) for known in maps]
    parts = zip(maps, counts, accumulate(counts), strict=True)
    return tuple(ReachMap(known.grid, arms.starts[end - count : end], arms.postures) for known, count, end in parts)
