"""Cloth held by two fingers: what is between them moves with the hand, and what hangs from them turns as it is folded.

A mesh has no vertex just where fingers close. So the nearest vertices are held, which are up to an edge of a triangle
beside them: there the cloth is not in the hand. It lies on one side of the fingers before a fold and on the other side
after it, and held rigidly it would be put down beyond its place by twice as much. Layers whose edges do not
reach the fingers' tip, or have no vertex there, would be pulled that far. A hand that rolls with the cloth turns what
is between its fingers too; round the fingers of one that does not, and that points along its way, the cloth turns over
at their ends.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from planner.geometry.pose import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class HeldCloth:
    """The vertices that a hand holds.

    Attributes:
        vertices: their numbers.
        between: from the fingers' tip to the points of the cloth that are between them, shape (n, 3), m.
        beside: from these points to the vertices, shape (n, 3), m.
        hangs: whether it hung beside the table when the fingers closed, or where it was turned over last.
    """

    vertices: tuple[int, ...]
    between: FloatArray
    beside: FloatArray
    hangs: bool = False

    @staticmethod
    def of(
        pinched: Mapping[int, FloatArray], positions: FloatArray, tip: FloatArray, *, hangs: bool = False
    ) -> "HeldCloth":
        """Return the cloth between fingers that have just closed.

        Args:
            pinched: the point of the cloth between the fingers for each vertex, shape (3,), m.
            positions: all vertices, table frame, shape (n, 3), m.
            tip: where the fingers have closed, shape (3,), m.
            hangs: whether the cloth hangs there.
        """
        vertices = tuple(sorted(pinched))
        points = np.array([pinched[vertex] for vertex in vertices])
        return HeldCloth(vertices, points - tip, positions[list(vertices)] - points, hangs)

    def pressed(self, thickness_m: float, share: float = 1.0) -> "HeldCloth":
        """Return the cloth after the fingers have pressed its layers together, wholly or by a share.

        A loop between them is closed: held open it would be laid down open too, a ridge as high as it is.

        Args:
            thickness_m: the thickness of a layer (m).
            share: how much of it is done, from 0 to 1.
        """
        heights = (self.between + self.beside)[:, 2]
        open_m = max(float(np.ptp(heights)), thickness_m)
        pressed_m = self.stack_m(thickness_m) - thickness_m
        scale = np.array([1.0, 1.0, 1.0 - share * (1.0 - min(1.0, pressed_m / open_m))])
        lift = np.array([0.0, 0.0, float(heights.min()) * (1.0 - scale[2])])
        return replace(self, between=self.between * scale + lift, beside=self.beside * scale)

    def stack_m(self, thickness_m: float) -> float:
        """Return the height of its layers when they lie on one another, for the thickness of one (m)."""
        heights = np.sort((self.between + self.beside)[:, 2])
        return thickness_m * (1 + int((np.diff(heights) > thickness_m / 2.0).sum()))

    def turned_round(self, way: FloatArray, ahead_m: float, cloth_rad: float) -> "HeldCloth":
        """Return the cloth in a hand that does not roll, once what is beyond its finger ends has turned over.

        Args:
            way: the direction in which the hand is going, horizontal, of length 1, shape (2,).
            ahead_m: how far its fingers reach that way (m).
            cloth_rad: how far the cloth has turned over (rad): half a turn in a fold.
        """
        vertices = self.between + self.beside
        beyond_m = np.maximum(vertices[:, :2] @ way - ahead_m, 0.0)
        beyond = np.column_stack([beyond_m[:, None] * way, np.zeros(len(beyond_m))])
        return replace(self, beside=self.beside + _turned(beyond, way, cloth_rad) - beyond)

    def turned(self, way: FloatArray, hand_rad: float, cloth_rad: float) -> "HeldCloth":
        """Return the cloth after the hand and the cloth that hangs from it have turned over.

        Args:
            way: the direction in which the hand is going, horizontal, of length 1, shape (2,).
            hand_rad: how far the hand has rolled that way (rad).
            cloth_rad: how far the cloth has turned over (rad): half a turn in a fold.
        """
        between, beside = _turned(self.between, way, hand_rad), _turned(self.beside, way, cloth_rad)
        return replace(self, between=between, beside=beside)

    def raised(self, height_m: float) -> "HeldCloth":
        """Return the cloth held higher by a height (m)."""
        return replace(self, between=self.between + np.array([0.0, 0.0, height_m]))

    def at(self, tip: FloatArray) -> dict[int, FloatArray]:
        """Return each vertex's place for a place of the fingers' tip, shape (3,), m."""
        return dict(zip(self.vertices, tip + self.between + self.beside, strict=True))

    @property
    def lowest_m(self) -> float:
        """The height of the lowest vertex over the fingers' tip (m)."""
        return float((self.between + self.beside)[:, 2].min())


def _turned(vectors: FloatArray, way: FloatArray, angle_rad: float) -> FloatArray:
    """Return vectors turned over, shape (n, 3): what points ahead along the way goes down, and then back."""
    ahead, up = vectors[:, :2] @ way, vectors[:, 2]
    cos, sin = np.cos(angle_rad), np.sin(angle_rad)
    shift = ahead * (cos - 1.0) + up * sin
    return np.column_stack([vectors[:, :2] + shift[:, None] * way, up * cos - ahead * sin])
