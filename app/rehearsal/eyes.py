"""The robot's eyes: find the stack in an observation, and keep the picture with what was fitted to it."""

import base64
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

import numpy as np

from app.rehearsal.camera.look import coded
from app.rehearsal.camera.posture import Posture
from app.rehearsal.camera.robot_shape import RobotShape, hidden, robot_shape
from app.rehearsal.hand_eye import HandEye
from app.rehearsal.laid_edge import LaidEdge
from app.rehearsal.vision.first_edge import first_edges
from app.rehearsal.vision.fit_stack import fit_stack
from app.rehearsal.vision.look_at_stack import Looker, Sight
from app.rehearsal.vision.picture import Image
from app.rehearsal.vision.stack_fit import Expected
from app.rehearsal.world import Observation, StepMotion
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Point2, Pose2
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from planner.task.task import Task
from planner.task.world_state import WorldState

PICTURE_BYTES_MAX = 60_000
"""Largest size of a picture that is kept (bytes)."""

_BESIDE_ARM_PX = 4
"""The margin round its arms within which a robot expects to see them (pixels): base and camera are slightly off."""

_FOLDED, _DRIVEN = (0.003, 0.003), (0.01, 0.01)
"""How far a fold moves what it leaves on the table, and how far beside its place a base stops (m, rad).

Standard deviations. Folds were seen to move it by .6 mm and .0005 rad (five folds); the base is an assumption.
"""


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """A picture that was looked at.

    Attributes:
        step: how many steps had been made.
        is_clear: whether the arms had been withdrawn for it.
        size_px: its width and height.
        jpeg: the picture.
        sight: what was seen in it.
        before: the world as planned when it was taken.
    """

    step: int
    is_clear: bool
    size_px: tuple[int, int]
    jpeg: bytes
    sight: Sight
    before: WorldState

    @property
    def start(self) -> WorldState | None:
        """The world as seen, to plan from; None if it is not known where the stack lies."""
        fit = self.sight.fit
        return None if fit is None or self.sight.unknown else replace(self.before, placement=fit.placement)

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON, the picture in base 64."""
        return {
            "step": self.step,
            "is_clear": self.is_clear,
            "size_px": list(self.size_px),
            "jpeg": base64.b64encode(self.jpeg).decode(),
            "start": None if self.start is None else self.start.to_dict(),
            **self.sight.to_dict(),
        }


class Eyes:
    """Looks for the stack that should lie on the table, and learns from each picture where the camera is.

    Attributes:
        expected: where the stack is expected, from what was seen before the last step; None where that does not tell.
        has_camera: whether the world has shown a picture.
    """

    def __init__(self, task: Task) -> None:
        """Take the robot, which knows where its own arms are, and the table."""
        self._table = task.scene.table
        self.has_camera = False
        self._hand_eye = HandEye()
        self._looked: tuple[Image, Looker] | None = None
        self._last: Expected | None = None
        self.expected: Expected | None = None
        self._card: RobotCard = load_robot(task.robot).card
        self._torso_m = task.scene.torso_m

    def sight(
        self, seen: Observation, sequence: FoldSequence, folds: tuple[int, ...], near: Pose2, posture: Posture
    ) -> Sight | None:
        """Return where the stack lies; None if the observation has no picture and no outline.

        Args:
            seen: what the world shows.
            sequence: the garment's folds.
            folds: those done, in the order in which they were made.
            near: where it ought to lie; it is expected where it was seen last, if that tells.
            posture: how the robot stands.
        """
        if seen.outline is not None:
            fit = fit_stack(seen.outline, sequence.cloth(sum(1 << fold for fold in folds)), near)
            return Sight(fit, np.empty((0, 2)), np.empty((0, 2)), None if fit.others else fit.unknown)
        if seen.image is None or seen.camera is None:
            return None
        image, self.has_camera = np.ascontiguousarray(seen.image[..., ::-1]), True
        hands = self._shape.hands(posture)
        camera, parts = self._hand_eye.corrected(image, seen.camera, hands), list(chain.from_iterable(hands.values()))
        looker = Looker(camera, self._table, hidden(parts, camera, _BESIDE_ARM_PX))
        found = looker.look(image, sequence, folds, near, self.expected)
        self._looked = image, looker
        tells = found.is_estimate or self.expected is not None
        self._last = found.stack.expected if tells and found.stack is not None else self.expected
        return found

    def short_m(self, edge: LaidEdge) -> float | None:
        """Return how far short of its place an edge is in the picture looked at last (m); None if it is not seen."""
        if self._looked is None:
            return None
        image, looker = self._looked
        return edge.short_m(first_edges(image, looker.camera, looker.hidden, edge.starts, edge.ends, edge.height_m))

    def hands(self, seen: Observation, posture: Posture) -> dict[str, Point2]:
        """Return the offset of each hand that is seen from where it should be, by its arm's name, table frame (m)."""
        if seen.image is None or seen.camera is None:
            return {}
        image = np.ascontiguousarray(seen.image[..., ::-1])
        self._hand_eye.corrected(image, seen.camera, self._shape.hands(posture))
        return {arm: (float(x), float(y)) for arm, (x, y) in self._hand_eye.hands_m.items()}

    def after(self, motion: StepMotion) -> None:
        """Note a step that was made; unless it has moved the stack, the stack is expected where it was seen.

        What a fold leaves on the table hardly moves; a base that drives somewhere else comes with an error of its own.
        """
        known, self._last = self._last, None
        if known is not None and not motion.is_drag and all(grip.closes for grip in motion.grips):
            known = known.loosened(*_FOLDED) if motion.is_fold else known
            self._last = known.loosened(*_DRIVEN) if motion.base is not None else known
        self.expected = self._last

    @property
    def _shape(self) -> RobotShape:
        return robot_shape(self._card, -self._table.height_m)

    def withdrawn(self, posture: Posture) -> Posture:
        """Return how the robot stands with its arms at home."""
        return Posture(posture.base, self._card.home_values(self._torso_m))


def kept(step: int, before: WorldState, seen: Observation, sight: Sight, *, is_clear: bool) -> Picture | None:
    """Return the picture of an observation, as good as its largest size allows; None where it has none."""
    if seen.image is None:
        return None
    image = np.ascontiguousarray(seen.image[..., ::-1])
    jpeg = next((data for data in (coded(image, quality) for quality in (80, 60, 40, 20)) if _fits(data)), None)
    size_px = (image.shape[1], image.shape[0])
    return None if jpeg is None else Picture(step, is_clear, size_px, jpeg, sight, before)


def _fits(data: bytes) -> bool:
    return len(data) <= PICTURE_BYTES_MAX
