"""Find the cloth in a picture of a table of unknown colour and texture.

Two ways that know little of each other: where the picture is unlike its border (a threshold), and GrabCut, which finds
the cut along edges between the colours within and without. How far they agree says how sure the outline is. It is then
drawn to the strongest edge near it, so that a soft shadow beside the cloth does not count as cloth.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from app.rehearsal.vision.background import border_of, unlikeness
from app.rehearsal.vision.picture import Image
from app.rehearsal.vision.pieces import Pieces, pieces_of
from app.rehearsal.vision.snap import snapped
from app.rehearsal.vision.vision_errors import NothingToldError
from planner.geometry.pose import BoolArray, FloatArray
from planner.message import Message

Mask = NDArray[np.uint8]

WORKED_WIDTH = 640
"""The longer side of the picture in which cloth is looked for (pixels)."""

LEAST_SHARE, MOST_SHARE = 0.004, 0.85
"""Range of the share of a picture that cloth may cover."""

MOST_AT_BORDER = 0.02
"""The share of the outline at the picture's border above which the cloth counts as cut off."""

LEAST_AGREEMENT = 0.80
"""The overlap of both segmentations (0..1) below which neither is trusted."""

_STANDS_OUT = 2.2
_ROUNDS = 4


@dataclass(frozen=True, slots=True, eq=False)
class Segmented:
    """The cloth's outline in a picture.

    Attributes:
        contour: points along the outline, a pixel or two apart, shape (n, 2), pixels; clockwise as seen.
        agreement: the overlap of the two ways to find it: what both cover of what at least one does.
        contrast: how strong the edge along it is (of 255), the median.
        at_border: the share of the outline at the picture's border.
        cloths: the number of cloths in the picture; the outline is that of the largest.
        stripes: the number of pieces of this cloth, with stripes of the table's colour between them.
    """

    contour: FloatArray
    agreement: float
    contrast: float
    at_border: float
    cloths: int = 1
    stripes: int = 1


def segment(
    image: Image,
    outside: BoolArray | None = None,
    table: BoolArray | None = None,
    *,
    is_known: bool = False,
    most_share: float = MOST_SHARE,
) -> Segmented:
    """Return the outline of the largest piece of cloth.

    Args:
        image: blue, green, red.
        outside: which pixels are known not to be cloth; None for none.
        table: which pixels show the table for all that is known; None for those at the picture's border.
        is_known: whether one cloth is known to lie there: then pieces are neither joined nor counted.
        most_share: the largest share of the picture that it may cover.

    Raises:
        NothingToldError: nothing stands out from the table.
    """
    share = min(1.0, WORKED_WIDTH / max(image.shape[:2]))
    small = np.asarray(cv2.resize(image, None, fx=share, fy=share, interpolation=cv2.INTER_AREA), np.uint8)
    other = np.zeros(image.shape[:2], bool) if outside is None else outside
    away = cv2.resize(other.astype(np.uint8), small.shape[1::-1], interpolation=cv2.INTER_NEAREST) > 0
    empty = border_of(small.shape)
    if table is not None:
        empty = cv2.resize(table.astype(np.uint8), small.shape[1::-1], interpolation=cv2.INTER_NEAREST) > 0
    stands_out = _by_threshold(small, away, empty)
    pieces = Pieces(1, 1, None) if is_known else pieces_of(_cleaned(stands_out, 90))
    first = _largest(stands_out, 90, pieces.bridge)
    second = _by_grab_cut(small, away | (empty & (first == 0)), first, stands_out, most_share)
    second = _largest(second, 200, pieces.bridge)
    both = _overlap(first, second)
    found = second if _is_possible(second, most_share) else first
    if not _is_possible(found, most_share):
        raise nothing_stands_out()
    outline = (_outline(found) + 0.5) / share - 0.5
    line, contrast = snapped(image, outline, reach=2.0 / share + 3.0)
    at_border = _at_border(line, image.shape, 2.5 / share)
    return Segmented(line, both, contrast, at_border, pieces.cloths, pieces.stripes)


def segment_cut_out(alpha: Image, outside: BoolArray | None = None) -> Segmented:
    """Return the outline of the largest piece of a picture whose background was made transparent.

    A cut-out that touches all four borders was trimmed to its size, and counts as whole.

    Args:
        alpha: how opaque the pixels are (of 255).
        outside: which pixels are known not to be cloth; None for none.

    Raises:
        NothingToldError: nothing is opaque.
    """
    opaque = np.asarray(alpha >= 128, np.uint8)
    if outside is not None:
        opaque[outside] = 0
    mask = _cleaned(opaque, 400)
    pieces = pieces_of(mask)
    found = _largest(opaque, 400, pieces.bridge)
    if not _is_possible(found, 1.0):
        raise nothing_stands_out()
    margin = 8
    wide = cv2.copyMakeBorder(alpha, margin, margin, margin, margin, cv2.BORDER_CONSTANT, value=(0,))
    line, contrast = snapped(np.dstack([np.asarray(wide, np.uint8)] * 3), _outline(found) + margin, reach=3.0)
    line = line - margin
    is_trimmed = all(edge.any() for edge in (alpha[0], alpha[-1], alpha[:, 0], alpha[:, -1]))
    at_border = 0.0 if is_trimmed else _at_border(line, alpha.shape, 2.0)
    return Segmented(line, 1.0, contrast, at_border, pieces.cloths, pieces.stripes)


def nothing_stands_out() -> NothingToldError:
    """Return the error of a picture in which no cloth is seen."""
    return NothingToldError(
        Message("no_cloth_seen", "nothing in the picture stands out from the table as a piece of cloth")
    )


def _at_border(line: FloatArray, shape: tuple[int, ...], edge: float) -> float:
    """Return the share of an outline that is nearer to a picture's border than `edge` (pixels)."""
    height, width = shape[:2]
    return float(((line < edge).any(axis=1) | (line[:, 0] > width - edge) | (line[:, 1] > height - edge)).mean())


def _by_threshold(image: Image, outside: BoolArray, table: BoolArray) -> Mask:
    """Return where the picture is unlike the table."""
    unlike = unlikeness(image, outside, table)
    unlike[outside] = 0.0
    capped = np.asarray(np.minimum(unlike * 12.0, 255.0), np.uint8)
    level, _ = cv2.threshold(capped, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
    return np.asarray(capped > max(min(level, 6.0 * 12.0), _STANDS_OUT * 12.0), np.uint8)


def _by_grab_cut(image: Image, outside: BoolArray, first: Mask, stands_out: Mask, most_share: float) -> Mask:
    """Return what GrabCut makes of a first guess; nothing where the guess is empty.

    What is deep within the guess counts as cloth for certain only where it stands out by itself: a slit does not.
    """
    if not _is_possible(first, most_share):
        return np.zeros_like(first)
    reach = max(3, round(0.03 * max(image.shape[:2])))
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
    inner = cv2.erode(first, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (reach, reach)))
    labels = np.full(first.shape, cv2.GC_BGD, np.uint8)
    labels[cv2.dilate(first, disc) > 0] = cv2.GC_PR_BGD
    labels[first > 0] = cv2.GC_PR_FGD
    labels[(inner > 0) & (stands_out > 0)] = cv2.GC_FGD
    labels[outside] = cv2.GC_BGD
    if not (labels == cv2.GC_FGD).any():
        labels[first > 0] = cv2.GC_FGD
    lab = np.asarray(cv2.cvtColor(cv2.GaussianBlur(image, (0, 0), 0.8), cv2.COLOR_BGR2Lab), np.uint8)
    cv2.setRNGSeed(7)
    cv2.grabCut(lab, labels, (0, 0, 1, 1), np.zeros((1, 65)), np.zeros((1, 65)), _ROUNDS, cv2.GC_INIT_WITH_MASK)
    return np.asarray((labels == cv2.GC_FGD) | (labels == cv2.GC_PR_FGD), np.uint8)


def _cleaned(mask: Mask, gaps: int, bridge: Mask | None = None) -> Mask:
    """Return a mask without threads, gaps under 1/`gaps` of its width closed, and those that a bridge spans."""
    size = max(mask.shape)
    near = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (max(3, size // gaps) | 1,) * 2)
    thread = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (max(3, size // 110) | 1,) * 2)
    opened = cv2.morphologyEx(cv2.morphologyEx(mask, cv2.MORPH_CLOSE, near), cv2.MORPH_OPEN, thread)
    return np.asarray(opened if bridge is None else cv2.morphologyEx(opened, cv2.MORPH_CLOSE, bridge), np.uint8)


def _largest(mask: Mask, gaps: int, bridge: Mask | None) -> Mask:
    """Return the largest piece of a mask without holes, cleaned."""
    contours, _ = cv2.findContours(_cleaned(mask, gaps, bridge), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    filled = np.zeros_like(mask)
    if contours:
        cv2.drawContours(filled, [max(contours, key=cv2.contourArea)], -1, 1, cv2.FILLED)
    return filled


def _overlap(one: Mask, other: Mask) -> float:
    union = int((one | other).sum())
    return int((one & other).sum()) / union if union else 0.0


def _is_possible(mask: Mask, most_share: float) -> bool:
    return LEAST_SHARE <= float(mask.mean()) <= most_share


def _outline(mask: Mask) -> FloatArray:
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    return np.asarray(max(contours, key=cv2.contourArea)[:, 0], np.float64)
