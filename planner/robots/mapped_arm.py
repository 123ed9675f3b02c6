"""An arm of any robot: the tool poses within its reach, and the joints for them."""

import math
import threading
from collections import OrderedDict
from collections.abc import Callable
from threading import Lock

import numpy as np

from planner.geometry.pose import Approach, BoolArray, FloatArray
from planner.robots.chain import length_of, tool_poses
from planner.robots.described_robot import DescribedArm, DescribedRobot
from planner.robots.hand_roll import gives_roll
from planner.robots.newton import followed
from planner.robots.posture_samples import axis_samples, gives_roll_alone, posture_samples, rolled_samples, unrolled
from planner.robots.reach_map import ReachMap, reachable_poses
from planner.robots.reach_maps import Progress, covered_heights, covering, reach_map

_POSES_KEPT = 4096
"""Poses whose samples are kept, those queried last: some ten MB."""

_Key = tuple[bytes, bytes, float]
_Samples = tuple[FloatArray, FloatArray]

Sampled = Callable[[FloatArray, FloatArray, float], _Samples]
"""The samples at poses: from points (k, 3), rotations (k, 3, 3) and the floor, joints (k, m, n) and costs (k, m).

A pose's samples do not depend on the other poses; its costs are infinite after its last sample.
"""


class SampleMemory:
    """The samples of the poses queried last. May be shared between threads."""

    def __init__(self, sampled: Sampled) -> None:
        """Take what samples poses, and start with nothing known."""
        self._sampled = sampled
        self._known: OrderedDict[_Key, _Samples] = OrderedDict()
        self._lock = Lock()

    def forget(self) -> None:
        """Drop all samples, so that benchmarks measure their computation."""
        with self._lock:
            self._known.clear()

    def samples(self, points: FloatArray, rotations: FloatArray, floor: float) -> _Samples:
        """Return what the sampling function returns; it is called only for poses that are not known."""
        keys = [(point.tobytes(), rotation.tobytes(), floor) for point, rotation in zip(points, rotations, strict=True)]
        with self._lock:
            found = {key: self._known[key] for key in keys if key in self._known}
        new = {key: number for number, key in enumerate(keys) if key not in found}
        if new:
            numbers = list(new.values())
            joints, costs = self._sampled(points[numbers], rotations[numbers], floor)
            taken = np.isfinite(costs).sum(axis=1)
            own = zip(new, joints, costs, taken, strict=True)
            found |= {key: (some[:count].copy(), each[:count].copy()) for key, some, each, count in own}
        self._keep(found)
        return _together([found[key] for key in keys])

    def _keep(self, found: dict[_Key, _Samples]) -> None:
        with self._lock:
            self._known |= found
            for key in found:
                self._known.move_to_end(key)
            while len(self._known) > _POSES_KEPT:
                self._known.popitem(last=False)


def _together(each: list[_Samples]) -> _Samples:
    most = max([1, *(len(costs) for _, costs in each)])
    joints, costs = np.zeros((len(each), most, each[0][0].shape[1])), np.full((len(each), most), np.inf)
    for number, (some, own) in enumerate(each):
        joints[number, : len(own)], costs[number, : len(own)] = some, own
    return joints, costs


_PITCHES_DEG = (15, 30, 45, 60, 75)
_HEADINGS_DEG = range(0, 360, 30)

ALL_ROUND = (
    *(Approach(math.radians(heading), math.radians(pitch)) for pitch in _PITCHES_DEG for heading in _HEADINGS_DEG),
    Approach(0.0, math.pi / 2),
)
"""Directions from which a gripper may pinch, all round: fixed arms may stand on opposite sides of a table."""

_BELOW_M, _ABOVE_M = 0.1, 0.8
"""The heights below and above the table's top that a map covers from the first; layers are added when queried (m)."""

_WIDE_RAD = 2 * math.tau - 0.01
"""A joint with this range may wind up along a chain: wherever it began, some whole turns bring it within its limits."""

_STRIDE_MAX, _LENGTH_OF_STRIDE_M = 3, 0.25
"""Most poses of a path from link to link of a chain, and the length of an arm for each (m): nearer to its shoulder
joints turn farther for a centimetre.
"""


class MappedArm:
    """An arm with the reach map. Its answers do not change, so all users may share one instance.

    The map grows by layers when something above or below it is queried, which changes no answer.

    Poses are of the tool, x along the approach axis, in the base frame (m). How high the lift is raised is given with
    each question.

    Attributes:
        chain: its joints and its tool, seen from its root.
        known: the reach map as far as it has grown.
        periods: a whole turn for each joint that a chain may wind up, 0 for the others (rad), shape (joints,).
    """

    def __init__(self, arm: DescribedArm, known: ReachMap) -> None:
        self.chain = arm.chain
        self._root = arm.root
        self._is_endless = arm.is_endless
        self.known = known
        is_wide = arm.chain.turns & (arm.chain.high - arm.chain.low >= _WIDE_RAD)
        self.periods: FloatArray = np.where(arm.is_endless | is_wide, math.tau, 0.0)
        self._gives_roll_alone = gives_roll_alone(arm.chain)
        self._building = threading.Lock()
        self._memory = SampleMemory(self._sampled)

    def take(self, known: ReachMap, same: ReachMap) -> None:
        """Use the same map at another place in memory, unless it has grown since."""
        with self._building:
            if self.known is known:
                self.known = same

    def cover(self, points: FloatArray, torso_m: float) -> None:
        """Have the map cover points that are seen from the root (m), shape (..., 3): builds layers, in seconds each.

        What is below the floor needs no map.
        """
        if not points.size:
            return
        floor_m = -float(self.shoulder(torso_m)[2])
        lowest_m, highest_m = max(float(points[..., 2].min()), floor_m), float(points[..., 2].max())
        low_m, high_m = covered_heights(self.known.grid)
        if lowest_m < low_m or highest_m > high_m:
            with self._building:
                self.known = covering(self.chain, self.known, (lowest_m, highest_m))

    def _sampled(self, points: FloatArray, rotations: FloatArray, floor: float) -> tuple[FloatArray, FloatArray]:
        """Return samples of the joints at poses seen from the root, those of the axis where the last joint rolls it."""
        sampled = axis_samples if self._gives_roll_alone else posture_samples
        found: tuple[FloatArray, FloatArray] = sampled(self.chain, self.known, self.periods, points, rotations, floor)
        return found

    @property
    def length_m(self) -> float:
        """Its largest reach from its root (m)."""
        return length_of(self.chain)

    @property
    def stride(self) -> int:
        """Poses of a path from one link of a chain to the next."""
        return min(max(int(self.length_m / _LENGTH_OF_STRIDE_M), 1), _STRIDE_MAX)

    @property
    def size_mb(self) -> float:
        """The memory that the map takes (MB)."""
        return (self.known.starts.nbytes + self.known.postures.nbytes) / 1e6

    def mirrored_places(self, places: FloatArray) -> FloatArray:
        """Return points of the base frame as the arm sees them: as they are; a new array."""
        return np.array(places, dtype=float, order="C")

    def can_reach(self, positions: FloatArray, rotations: FloatArray, torso_m: float = 0.0) -> BoolArray:
        """Return which tool poses, shapes (n, 3) and (n, 3, 3), the arm can take within its limits; shape (n,).

        Where the roll is free, or the arm has too few joints for it, only the approach counts.
        """
        return self.joints(positions, rotations, torso_m)[0]

    def joints(
        self, positions: FloatArray, rotations: FloatArray, torso_m: float = 0.0
    ) -> tuple[BoolArray, FloatArray]:
        """Return which tool poses the arm can take, see `can_reach`, and joints for each, shape (n, joints)."""
        points = np.ascontiguousarray(positions - self.shoulder(torso_m))
        self.cover(points, torso_m)
        return reachable_poses(self.chain, self.known, points, np.ascontiguousarray(rotations))

    def tool_poses(self, joints: FloatArray, torso_m: float = 0.0) -> tuple[FloatArray, FloatArray]:
        """Return the tool's positions, shape (n, 3), and rotations, shape (n, 3, 3), at rows of joints."""
        points, rotations = tool_poses(self.chain, np.ascontiguousarray(joints))
        return points + self.shoulder(torso_m), rotations

    def tool_pose(self, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
        """Return the tool's position, shape (3,), and rotation, shape (3, 3), at some joints."""
        positions, rotations = self.tool_poses(joints[None], torso_m)
        return positions[0], rotations[0]

    def tool_places(self, joints: FloatArray, torso_m: float) -> FloatArray:
        """Return the tool's positions at rows of joints, shape (n, 3)."""
        return self.tool_poses(joints, torso_m)[0]

    def samples(
        self, positions: FloatArray, rotations: FloatArray, torso_m: float, floor_m: float
    ) -> tuple[FloatArray, FloatArray]:
        """Return samples of the joints at each tool pose, shape (n, m, joints), and their costs; see `PathArm`."""
        shoulder = self.shoulder(torso_m)
        points, axes = np.ascontiguousarray(positions - shoulder), np.array(rotations, order="C")
        floor = floor_m - float(shoulder[2])
        self.cover(points, torso_m)
        if not self._gives_roll_alone:
            return self._memory.samples(points, axes, floor)
        of_axes = self._memory.samples(points, unrolled(axes), floor)
        found: tuple[FloatArray, FloatArray] = rolled_samples(self.chain, self.periods, axes, *of_axes)
        return found

    def compile_samples(self) -> None:
        """Compile what samples the joints of any mapped arm, whether or not its last joint gives the roll alone."""
        gives_roll(self.chain)
        points, axes = np.zeros((1, 3)), np.eye(3)[None]
        posture_samples(self.chain, self.known, self.periods, points, axes, 0.0)
        of_axes = axis_samples(self.chain, self.known, self.periods, points, unrolled(axes), 0.0)
        rolled_samples(self.chain, self.periods, axes, *of_axes)

    def forget_samples(self) -> None:
        """Drop the samples that searches have left, so that benchmarks measure their computation."""
        self._memory.forget()

    def along(
        self, positions: FloatArray, rotations: FloatArray, torso_m: float, guides: FloatArray
    ) -> tuple[FloatArray, BoolArray]:
        """Return joints near to guides at each tool pose, shape (n, joints), and whether they exist; see `PathArm`."""
        points, axes = np.ascontiguousarray(positions - self.shoulder(torso_m)), np.ascontiguousarray(rotations)
        return followed(self.chain, self._is_endless, points, axes, np.ascontiguousarray(guides))

    def unwound(self, chain: FloatArray) -> FloatArray:
        """Return a chain of samples, shape (n, joints), with the joints that have periods wound up.

        Those that have limits come as near to the middle of their range as whole turns bring them: a chain that winds
        up farther than the range leaves it.
        """
        joints = chain.copy()
        for k in np.flatnonzero(self.periods):
            joints[:, k] = np.unwrap(joints[:, k])
            if not self._is_endless[k]:
                off = joints[:, k].min() + joints[:, k].max() - self.chain.low[k] - self.chain.high[k]
                joints[:, k] -= math.tau * np.round(0.5 * off / math.tau)
        return joints

    def shoulder(self, torso_m: float) -> FloatArray:
        """Return where its root is in the base frame with the lift raised (m), shape (3,)."""
        shoulder: FloatArray = self._root + np.array([0.0, 0.0, torso_m])
        return shoulder


def mapped_arm(robot: DescribedRobot, number: int, progress: Progress | None = None) -> MappedArm:
    """Return an arm of a robot with its map, which is read from the user's cache or built (in seconds).

    Args:
        robot: the robot.
        number: the arm's index.
        progress: called with how far a map is that must be built.
    """
    arm = robot.arms[number]
    return MappedArm(arm, reach_map(arm.chain, ALL_ROUND, heights(robot, arm), progress))


def all_arms(robot: DescribedRobot, progress: Progress | None = None) -> tuple[MappedArm, ...]:
    """Return all arms of a robot with their maps, see `mapped_arm`; `progress` is called with the share of all."""
    count = len(robot.arms)
    return tuple(mapped_arm(robot, number, _part(progress, number, count)) for number in range(count))


def _part(progress: Progress | None, number: int, count: int) -> Progress | None:
    """Return the progress callback of one arm among several."""
    return None if progress is None else lambda share: progress((number + share) / count)


def heights(robot: DescribedRobot, arm: DescribedArm) -> tuple[float, float]:
    """Return the lowest and the highest point that an arm mostly needs, seen from its root (m)."""
    table_m = robot.card.scene.table.height_m - float(arm.root[2])
    low, high = robot.lift_limits_m
    return table_m - high - _BELOW_M, table_m - low + _ABOVE_M
