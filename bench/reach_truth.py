"""The true reachability of poses for the left arm: slow and dense, independent of the planner's kernel.

With the shoulder's pan locked the other six joints follow in closed form, for each branch of the elbow. So the pan is
sampled finely, and refined round the best samples five times over. A "yes" comes with joints, which pinocchio checks; a
"no" means that none of the sampled pans serves.

How far a pose is from the boundary of the reach is found by moving the tool, its rotation kept, in the directions of
the faces and the corners of a cube, further and further until the answer is no.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from bench.pin_arm import TORSO_M, pin_arm
from bench.reach_queries import Queries
from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.pr2.arm import Sector, read_arm
from planner.robots.pr2.description import read_model

SAMPLES = 721
"""Number of pans tried at first, evenly over the joint's range."""

PEAKS, ZOOMED, ZOOMS = 6, 33, 5
"""Number of best samples refined, of new samples between the neighbours of each, and of rounds."""

AT_ONCE = 256
"""Poses in a batch, so that its arrays fit into the processor's cache."""

OUTSIDE = -10.0
"""Slack (rad) where the closed form has no solution at all; it decreases further away from a solution."""

NEAREST_M, FURTHEST_M, FINER = 5e-4, 1.1, 8
"""Range of the moves that may take a pose out of reach, and number of steps in which the last stretch is searched."""

_CORNERS = np.array(list(product((-1.0, 1.0), repeat=3))) / np.sqrt(3.0)
DIRECTIONS = np.vstack((np.eye(3), -np.eye(3), _CORNERS))


@dataclass(frozen=True, slots=True)
class Truth:
    """The true answers for poses.

    Attributes:
        answers: which poses are within reach, shape (n,).
        joints: for those within reach joints that take the pose (rad), shape (n, 7).
    """

    answers: BoolArray
    joints: FloatArray


class DenseReach:
    """The left arm, sampled."""

    def __init__(self) -> None:
        """Read lengths and limits."""
        self._shape = read_arm(read_model())
        self._shoulder = np.array([self._shape.shoulder_x, self._shape.shoulder_y, self._shape.shoulder_z + TORSO_M])

    def truth(self, queries: Queries) -> Truth:
        """Return which poses are within reach, and joints for them."""
        answers, joints = np.zeros(len(queries), dtype=bool), np.full((len(queries), 7), np.nan)
        for start in range(0, len(queries), AT_ONCE):
            part = slice(start, start + AT_ONCE)
            points, rotations = queries.points[part], queries.rotations[part]
            slack, pans, branches = self._best(self._wrists(points, rotations), rotations[:, :, 0])
            answers[part] = slack >= 0.0
            joints[part] = self._joints(self._wrists(points, rotations), rotations, pans, branches)
        return Truth(answers, joints)

    def can_reach(self, points: FloatArray, rotations: FloatArray) -> BoolArray:
        """Return which poses are within reach, shape (n,)."""
        nothing = np.zeros(len(points))
        return self.truth(Queries(points, rotations, nothing.astype(bool), nothing)).answers

    def _wrists(self, points: FloatArray, rotations: FloatArray) -> FloatArray:
        return np.asarray(points - self._shape.tool * rotations[:, :, 0] - self._shoulder)

    def _best(self, wrists: FloatArray, axes: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the largest slack of each pose, and its pan and branch (1 or -1)."""
        limits, count = self._shape.pan, len(wrists)
        step = (limits.high - limits.low) / (SAMPLES - 1)
        grid = np.broadcast_to(np.linspace(limits.low, limits.high, SAMPLES), (count, SAMPLES))
        best, best_pan, best_branch = np.full(count, -np.inf), np.zeros(count), np.ones(count)
        for branch in (1.0, -1.0):
            slack, pans = _peaks(self._slack(wrists, axes, grid, branch), grid)
            half = step
            for _ in range(ZOOMS):
                near = pans[:, :, None] + half * np.linspace(-1.0, 1.0, ZOOMED)
                near = np.clip(near, limits.low, limits.high).reshape(count, -1)
                found = self._slack(wrists, axes, near, branch).reshape(count, PEAKS, ZOOMED)
                at = found.argmax(axis=2)[:, :, None]
                slack = np.take_along_axis(found, at, axis=2)[:, :, 0]
                pans = np.take_along_axis(near.reshape(found.shape), at, axis=2)[:, :, 0]
                half *= 2.0 / (ZOOMED - 1)
            top = slack.argmax(axis=1)[:, None]
            most = np.take_along_axis(slack, top, axis=1)[:, 0]
            is_better = most > best
            best = np.where(is_better, most, best)
            best_pan = np.where(is_better, np.take_along_axis(pans, top, axis=1)[:, 0], best_pan)
            best_branch = np.where(is_better, branch, best_branch)
        return best, best_pan, best_branch

    def _slack(self, wrists: FloatArray, axes: FloatArray, pans: FloatArray, branch: float) -> FloatArray:
        """Return the least slack of lift, roll, elbow and wrist flex (rad) at each pose's pans, shape (n, m)."""
        shape = self._shape
        (u, v, w), ahead = self._panned(wrists, pans), self._turned(axes, pans)
        cos_elbow = (u * u + v * v + w * w - shape.upper**2 - shape.fore**2) / (2.0 * shape.upper * shape.fore)
        elbow = -np.arccos(np.clip(cos_elbow, -1.0, 1.0))
        side = shape.fore * np.sin(elbow)
        with np.errstate(divide="ignore", invalid="ignore"):
            sin_roll = np.where(side == 0.0, 0.0, v / side)
        inner = np.arcsin(np.clip(sin_roll, -1.0, 1.0))
        roll = inner if branch > 0.0 else np.pi - inner
        a, b = shape.upper + shape.fore * np.cos(elbow), -side * np.cos(roll)
        lift = np.arctan2(b, a) - np.arctan2(w, u)
        along = (u - shape.upper * np.cos(lift)) * ahead[0] + v * ahead[1] + (w + shape.upper * np.sin(lift)) * ahead[2]
        flex = -np.arccos(np.clip(along / shape.fore, -1.0, 1.0))
        slack = _slack_within(shape.lift, lift)
        for limits, angle in ((shape.roll, roll), (shape.elbow, elbow), (shape.wrist, flex)):
            slack = np.minimum(slack, _slack_within(limits, angle))
        # No roll has a sine beyond 1, and no elbow a cosine. Both excesses form one smooth condition, so that refining
        # leads to solutions.
        outside = (v / shape.fore) ** 2 + cos_elbow**2 - 1.0
        return np.where(outside > 0.0, OUTSIDE - outside, slack)

    def _panned(self, wrists: FloatArray, pans: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return wrists as seen from the lift axis at each pan, three arrays of shape (n, m)."""
        x, y, z = self._turned(wrists, pans)
        return x - self._shape.offset, y, z

    def _turned(self, vectors: FloatArray, pans: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        x, y, z = (vectors[:, i, None] for i in range(3))
        cos, sin = np.cos(pans), np.sin(pans)
        return cos * x + sin * y, cos * y - sin * x, np.broadcast_to(z, pans.shape)

    def _joints(self, wrists: FloatArray, rotations: FloatArray, pans: FloatArray, branches: FloatArray) -> FloatArray:
        """Return the seven joints at each pose's pan and branch, shape (n, 7); undefined where there are none."""
        shape = self._shape
        u, v, w = (part[:, 0] for part in self._panned(wrists, pans[:, None]))
        cos_elbow = (u * u + v * v + w * w - shape.upper**2 - shape.fore**2) / (2.0 * shape.upper * shape.fore)
        elbow = -np.arccos(np.clip(cos_elbow, -1.0, 1.0))
        side = shape.fore * np.sin(elbow)
        with np.errstate(divide="ignore", invalid="ignore"):
            inner = np.arcsin(np.clip(np.where(side == 0.0, 0.0, v / side), -1.0, 1.0))
        roll = np.where(branches > 0.0, inner, np.pi - inner)
        lift = np.arctan2(-side * np.cos(roll), shape.upper + shape.fore * np.cos(elbow)) - np.arctan2(w, u)
        held = _about(2, pans) @ _about(1, lift) @ _about(0, roll) @ _about(1, elbow)
        hand = np.swapaxes(held, 1, 2) @ rotations
        forearm = np.arctan2(-hand[:, 1, 0], hand[:, 2, 0])
        flex = -np.arctan2(np.hypot(hand[:, 1, 0], hand[:, 2, 0]), hand[:, 0, 0])
        last = np.arctan2(-hand[:, 0, 1], -hand[:, 0, 2])
        joints = np.stack((pans, lift, roll, elbow, forearm, flex, last), axis=1)
        for index, limits in ((1, shape.lift), (2, shape.roll)):
            joints[:, index] = _turned_into(limits, joints[:, index])
        return joints


def is_proved(truth: Truth, queries: Queries, within: float) -> BoolArray:
    """Return which "yes" answers pinocchio confirms, shape (n,): legal joints, and the tool within a tolerance."""
    proved = np.zeros(len(queries), dtype=bool)
    for i in np.flatnonzero(truth.answers):
        proved[i] = pin_arm().residual(truth.joints[i], queries.points[i], queries.rotations[i]) <= within
    return proved


def _peaks(slack: FloatArray, pans: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the best samples that are no worse than their neighbours, and their pans, shapes (n, PEAKS)."""
    walled = np.pad(slack, ((0, 0), (1, 1)), constant_values=-np.inf)
    is_peak = (slack >= walled[:, :-2]) & (slack >= walled[:, 2:])
    best = np.argpartition(np.where(is_peak, -slack, np.inf), PEAKS, axis=1)[:, :PEAKS]
    return np.take_along_axis(slack, best, axis=1), np.take_along_axis(pans, best, axis=1)


def _slack_within(limits: Sector, angle: FloatArray) -> FloatArray:
    """Return how far angles are from the nearer of two limits, whole turns aside; negative outside (rad)."""
    middle, half = 0.5 * (limits.low + limits.high), 0.5 * (limits.high - limits.low)
    off = np.mod(angle - middle + np.pi, 2.0 * np.pi) - np.pi
    return np.asarray(half - np.abs(off))


def _turned_into(limits: Sector, angle: FloatArray) -> FloatArray:
    """Return angles with whole turns added so that they are nearest to the middle of two limits."""
    middle = 0.5 * (limits.low + limits.high)
    return np.asarray(middle + np.mod(angle - middle + np.pi, 2.0 * np.pi) - np.pi)


def _about(axis: int, angles: FloatArray) -> FloatArray:
    """Return rotations about an axis of the frame, shape (n, 3, 3)."""
    cos, sin = np.cos(angles), np.sin(angles)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turned = np.zeros((len(angles), 3, 3))
    turned[:, axis, axis] = 1.0
    turned[:, i, i] = turned[:, j, j] = cos
    turned[:, i, j], turned[:, j, i] = -sin, sin
    return turned


def distance_m(dense: DenseReach, point: FloatArray, rotation: FloatArray) -> float:
    """Return the shortest of the moves tried that takes a pose out of reach (m); inf if none does."""
    doubling = NEAREST_M * 2.0 ** np.arange(np.ceil(np.log2(FURTHEST_M / NEAREST_M)) + 1)
    coarse = _first_out(dense, point, rotation, doubling)
    if coarse == len(doubling):
        return np.inf
    last = doubling[coarse - 1] if coarse else 0.0
    fine = np.linspace(last, doubling[coarse], FINER + 1)[1:]
    return float(fine[_first_out(dense, point, rotation, fine)])


def _first_out(dense: DenseReach, point: FloatArray, rotation: FloatArray, lengths: FloatArray) -> int:
    """Return the index of the first length at which some direction leads out of reach; their number if none does."""
    points = (point + lengths[:, None, None] * DIRECTIONS).reshape(-1, 3)
    rotations = np.broadcast_to(rotation, (len(points), 3, 3))
    is_out = ~dense.can_reach(points, rotations).reshape(len(lengths), -1).all(axis=1)
    return int(np.argmax(is_out)) if is_out.any() else len(lengths)
