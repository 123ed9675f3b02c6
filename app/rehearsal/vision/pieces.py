"""Tell whether pieces that stand out from the table are one striped cloth, several garments, or one and odds and ends.

A stripe of the table's colour cuts a cloth into pieces that lie side by side: narrow ones, and each faces its neighbour
along most of its length. Garments beside each other come near at a corner, or are wider. What is said of two narrow
cloths laid exactly along each other is therefore a guess, and reported as one.
"""

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray

Mask = NDArray[np.uint8]

_LEAST_SHARE, _LEAST_OF_LARGEST = 0.0008, 0.02
"""Least share of the picture, and of the largest piece, that a piece has; less is dirt."""

_PIECES_MAX = 40

_CLOTH_SHARE = 0.15
"""Least share of the largest cloth that another one covers; less may be a hand or a tape measure."""

_FACING, _GAP_SHARE = 0.6, 0.25
"""The least share of the shorter stripe that faces the other, and the widest gap as a share of the longer one."""

_NARROW, _BIT = 0.45, 0.1
"""A stripe is at most so wide for its length, or a bit of such a share of the largest piece (a stripe across a sleeve).
"""


@dataclass(frozen=True, slots=True, eq=False)
class Pieces:
    """The pieces of a picture.

    Attributes:
        cloths: the number of cloths.
        stripes: the number of pieces of the largest cloth.
        bridge: the line, as a structuring element, that closes the gaps between them; None for one piece.
    """

    cloths: int
    stripes: int
    bridge: Mask | None


@dataclass(frozen=True, slots=True, eq=False)
class _Piece:
    """A piece: its outline, area, length and width, and the direction of its length (rad), pixels."""

    points: FloatArray
    area: float
    length: float
    width: float
    angle_rad: float
    away: NDArray[np.float32]

    @staticmethod
    def of(contour: NDArray[np.int32], shape: tuple[int, ...]) -> "_Piece":
        filled = np.ones(shape, np.uint8)
        cv2.drawContours(filled, [contour], -1, 0, cv2.FILLED)
        away = cv2.distanceTransform(filled, cv2.DIST_L2, 5)
        corners = cv2.boxPoints(cv2.minAreaRect(contour))
        sides = sorted((corners[k + 1] - corners[k] for k in (0, 1)), key=lambda side: float(np.hypot(*side)))
        x, y = sides[1]
        width, length = (float(np.hypot(*side)) + 1.0 for side in sides)
        points = contour[:, 0].astype(np.float64)
        return _Piece(points, float(cv2.contourArea(contour)), length, width, math.atan2(y, x), np.asarray(away))

    def distances(self, other: "_Piece") -> FloatArray:
        """Return how far this piece's outline is from another piece, shape (n,)."""
        columns, rows = self.points.astype(np.int64).T
        return np.asarray(other.away[rows, columns], np.float64)


def pieces_of(mask: Mask) -> Pieces:
    """Return which pieces of a mask belong together."""
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    largest = max((cv2.contourArea(contour) for contour in contours), default=0.0)
    least = max(_LEAST_SHARE * mask.size, _LEAST_OF_LARGEST * largest)
    kept = sorted((one for one in contours if cv2.contourArea(one) >= least), key=cv2.contourArea, reverse=True)
    pieces = [_Piece.of(np.asarray(contour, np.int32), mask.shape) for contour in kept[:_PIECES_MAX]]
    if len(pieces) < 2:
        return Pieces(len(pieces), len(pieces), None)
    gaps = {
        (i, j): gap
        for j in range(len(pieces))
        for i in range(j)
        if (gap := _gap(pieces[i], pieces[j], largest)) is not None
    }
    groups = _groups(len(pieces), list(gaps))
    areas = [sum(pieces[k].area for k in group) for group in groups]
    cloth = groups[int(np.argmax(areas))]
    cloths = sum(area >= _CLOTH_SHARE * max(areas) for area in areas)
    if len(cloth) < 2:
        return Pieces(cloths, 1, None)
    widest = max(gap for (i, _), gap in gaps.items() if i in cloth)
    return Pieces(cloths, len(cloth), _bridge(_across([pieces[k] for k in cloth]), 1.5 * widest + 5.0))


def _gap(one: _Piece, other: _Piece, largest: float) -> float | None:
    """Return the gap between two pieces that are stripes of one cloth (pixels); None where they are not."""
    thin = min(one, other, key=lambda piece: piece.width)
    if thin.width > _NARROW * thin.length and thin.area > _BIT * largest:
        return None
    short = min(one, other, key=lambda piece: piece.length)
    distances = short.distances(other if short is one else one)
    gap = float(np.percentile(distances, 5))
    if gap > _GAP_SHARE * max(one.length, other.length):
        return None
    facing = int((distances <= 1.4 * gap + 3.0).sum())
    return gap if facing >= _FACING * short.length else None


def _groups(count: int, pairs: list[tuple[int, int]]) -> list[set[int]]:
    """Return the sets of numbers below `count` that pairs connect."""
    groups = [{k} for k in range(count)]
    for i, j in pairs:
        met = [group for group in groups if i in group or j in group]
        groups = [group for group in groups if group not in met] + [set().union(*met)]
    return groups


def _across(pieces: list[_Piece]) -> float:
    """Return the direction across stripes (rad), those that are long for their width counting most."""
    weights = [piece.length * (piece.length / piece.width - 1.0) for piece in pieces]
    doubled = sum(weight * np.exp(2j * piece.angle_rad) for piece, weight in zip(pieces, weights, strict=True))
    return float(np.angle(doubled)) / 2.0 + math.pi / 2.0


def _bridge(angle_rad: float, length: float) -> Mask:
    """Return a line of some length (pixels) as a structuring element."""
    half = math.ceil(length / 2.0)
    line = np.zeros((2 * half + 1, 2 * half + 1), np.uint8)
    end = (round(half * math.cos(angle_rad)), round(half * math.sin(angle_rad)))
    cv2.line(line, (half - end[0], half - end[1]), (half + end[0], half + end[1]), 1)
    return line
