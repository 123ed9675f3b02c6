"""Read the outline of what lies on the table from a picture, in metres."""

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np

from app.rehearsal.camera.calibration import Calibration
from app.rehearsal.vision.background import BORDER
from app.rehearsal.vision.picture import Image, Picture
from app.rehearsal.vision.scale_said import LengthSaid, MarkerSaid, ScaleSaid, SheetSaid
from app.rehearsal.vision.segment import (
    LEAST_AGREEMENT,
    MOST_AT_BORDER,
    MOST_SHARE,
    Mask,
    Segmented,
    nothing_stands_out,
    segment,
    segment_cut_out,
)
from app.rehearsal.vision.sheet import find_marker, find_sheets, like_best
from app.rehearsal.vision.table_plane import Focal, Plane
from app.rehearsal.vision.vision_errors import NothingToldError, ScaleNeededError
from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.region import Region
from planner.message import Message

_LEAST_CONTRAST = 3.0
"""The least strength of the edge round the cloth (of 255)."""

_WORST_SIZE_ERROR = 0.08

_TABLES_MAX = 3
"""How often the search goes on inside of what has the sheet within it, such as a table top or a carpet."""

_RIM = 0.015
"""Width of the rim of a table top that is left out: its edge, blurred (as a share of the top's size)."""

_WHICH_SHEET = Message.plain("the sheet may be A4 or Letter, and was taken for A4: say which")


@dataclass(frozen=True, slots=True, eq=False)
class OnTable:
    """An outline seen.

    Attributes:
        contour: points along it, in order, shape (n, 2), m, in `frame`.
        frame: "sheet", "marker", "picture" or "table": where the origin is. That of a picture is its middle; x runs
            right, y up.
        scale_from: "a4", "letter", "marker", "length" or "camera".
        seen: how it was found in the picture.
        size_error: by which share its size may be wrong; None where it was not taken from the picture.
        doubt: why it may be wrong; None where there is no reason.
        up_rad: the direction in `frame` that counts as up: that of the picture, for a sheet or marker lies any way
            round; of a calibrated camera, whose frame is the table's, y.
    """

    contour: FloatArray
    frame: str
    scale_from: str
    seen: Segmented
    size_error: float | None
    doubt: Message | None
    up_rad: float = math.pi / 2


def outline_on_table(picture: Picture, said: ScaleSaid | None) -> OnTable:
    """Return the outline of the cloth in a picture.

    Args:
        picture: the picture.
        said: what gives the scale; None to look for a sheet of A4 or Letter.

    Raises:
        NothingToldError: there is no cloth to be seen, or not what was said to give the scale.
        ScaleNeededError: nothing was said, and there is no sheet.
    """
    if isinstance(said, Calibration):
        return _by_camera(picture.image, said)
    image, alpha = picture.image, picture.alpha
    if isinstance(said, LengthSaid):
        seen = segment(image) if alpha is None else segment_cut_out(alpha)
        contour = _by_length(seen.contour, said, image.shape)
        return OnTable(contour, "picture", "length", seen, None, why_in_doubt(seen, None))
    planes, is_either = _planes(image, said, picture.focal)
    for plane in planes:
        sheet = plane.covers(image.shape)
        seen = _beside(image, plane, sheet) if alpha is None else segment_cut_out(alpha, sheet)
        if plane.is_above(seen.contour):
            error = plane.size_error(seen.contour)
            frame = "marker" if isinstance(said, MarkerSaid) else "sheet"
            doubt = why_in_doubt(seen, error) or (_WHICH_SHEET if is_either else None)
            contour = plane.on_table(seen.contour)
            return OnTable(contour, frame, plane.by, seen, error, doubt, plane.up_rad(seen.contour.mean(axis=0)))
    raise NothingToldError(Message.plain("the sheet or marker found cannot lie on the table that the cloth lies on"))


def _by_camera(image: Image, calibration: Calibration) -> OnTable:
    straight, camera = calibration.view(image)
    seen = segment(straight)
    contour = camera.on_plane(seen.contour)
    if not np.isfinite(contour).all():
        raise NothingToldError(Message.plain("the camera of the calibration sees more than the table there"))
    error = 2.0 * calibration.error_px / float(np.ptp(seen.contour, axis=0).max())
    return OnTable(contour, "table", "camera", seen, error, why_in_doubt(seen, error))


def _beside(image: Image, plane: Plane, sheet: BoolArray) -> Segmented:
    """Return the cloth that lies beside a sheet; a region with the sheet inside is a table top, and is searched again.

    Raises:
        NothingToldError: nothing stands out but what has the sheet within it.
    """
    outside, table = sheet, None
    for _ in range(_TABLES_MAX):
        try:
            seen = segment(image, outside, table, most_share=1.0)
        except NothingToldError:
            if table is None:
                raise
            break
        if not _holds(seen.contour, plane.corners.mean(axis=0)):
            if cv2.contourArea(seen.contour.astype(np.float32)) > MOST_SHARE * sheet.size:
                raise nothing_stands_out()
            return seen if table is None else _at_edge(seen, outside & ~sheet)
        top = np.zeros(sheet.shape, np.uint8)
        cv2.fillPoly(top, [seen.contour.round().astype(np.int32)], 1)
        top = _narrowed(top, _RIM * math.sqrt(top.sum()))
        table = (top > 0) & (_narrowed(top, BORDER * math.sqrt(top.sum())) == 0) & ~sheet
        outside = sheet | (top == 0)
    text = "all that stands out has the sheet or marker within it: lay the sheet beside the garment, not onto it"
    raise NothingToldError(Message("sheet_within_cloth", text))


def _at_edge(seen: Segmented, beyond: BoolArray) -> Segmented:
    """Return what was seen on a table top, cut off where it reaches the top's edge."""
    near = cv2.dilate(beyond.astype(np.uint8), np.ones((9, 9), np.uint8)) > 0
    columns, rows = np.clip(seen.contour.round().astype(np.int64), 0, np.array(beyond.shape[::-1]) - 1).T
    return replace(seen, at_border=max(seen.at_border, float(near[rows, columns].mean())))


def _narrowed(mask: Mask, margin: float) -> Mask:
    """Return a mask without its rim of some width (pixels); beyond the picture there is none."""
    return np.asarray(cv2.erode(mask, np.ones((3, 3), np.uint8), iterations=max(1, round(margin))), np.uint8)


def _holds(contour: FloatArray, point: FloatArray) -> bool:
    """Return whether a point is within an outline."""
    x, y = point.tolist()
    return cv2.pointPolygonTest(contour.astype(np.float32), (x, y), False) > 0


def why_in_doubt(seen: Segmented, size_error: float | None) -> Message | None:
    """Return why an outline may be wrong; None if nothing speaks against it."""
    if seen.cloths > 1:
        text = f"there are {seen.cloths} pieces of cloth in the picture, and the largest was taken: leave only one"
        return Message("several_cloths", text, {"cloths": seen.cloths})
    if seen.stripes > 1:
        text = (
            f"{seen.stripes} pieces were taken for one cloth with stripes of the table's colour; such a stripe at its "
            "end is not seen"
        )
        return Message("striped_cloth", text, {"pieces": seen.stripes})
    if seen.at_border > MOST_AT_BORDER:
        text = f"the cloth is cut off: {seen.at_border:.0%} of its outline is at the picture's border"
        return Message("cut_off", text, {"share": seen.at_border})
    if seen.agreement < LEAST_AGREEMENT:
        text = f"two ways to find the cloth agree on {seen.agreement:.0%} only, less than {LEAST_AGREEMENT:.0%}"
        return Message("ways_disagree", text, {"agreement": seen.agreement, "least": LEAST_AGREEMENT})
    if seen.contrast < _LEAST_CONTRAST:
        text = f"the cloth hardly stands out from the table: its edge has a strength of {seen.contrast:.1f} of 255"
        return Message("faint_edge", text, {"contrast": seen.contrast})
    if size_error is not None and size_error > _WORST_SIZE_ERROR:
        text = f"its size may be wrong by {size_error:.0%}: the sheet or marker is small or seen at a slant"
        return Message("size_uncertain", text, {"share": size_error})
    return None


def _planes(image: Image, said: ScaleSaid | None, focal: Focal) -> tuple[tuple[Plane, ...], bool]:
    """Return the planes that the picture may show, the likeliest first, and whether the sheet may be A4 or Letter."""
    if isinstance(said, MarkerSaid):
        marker = find_marker(image, said.side_m, focal)
        if marker is None:
            raise NothingToldError(Message.plain("there is no ArUco or AprilTag marker in the picture"))
        return (marker,), False
    names = (said.name,) if isinstance(said, SheetSaid) else ("a4", "letter")
    sheets = find_sheets(image, names, focal)
    if not sheets and said is None:
        raise ScaleNeededError
    if not sheets:
        raise NothingToldError(Message.plain(f"there is no sheet of {names[0]} paper to be seen in the picture"))
    alike = sorted(like_best(sheets), key=lambda plane: plane.by)  # A4 where both fit: most of the world has it
    return (*alike, *(sheet for sheet in sheets if all(sheet is not one for one in alike))), len(alike) > 1


def _by_length(pixels: FloatArray, said: LengthSaid, shape: tuple[int, ...]) -> FloatArray:
    """Return pixels as metres by a length of the figure; the origin in the picture's middle, y up."""
    extent = np.ptp(pixels, axis=0)
    hull = Region.polygon(pixels).hull
    longest = float(np.sqrt(((hull[:, None] - hull) ** 2).sum(axis=2).max()))
    spans = {"longest": longest, "width": float(extent[0]), "height": float(extent[1])}
    height, width = shape[:2]
    upright = (pixels - np.array([width / 2.0, height / 2.0])) * np.array([1.0, -1.0])
    return np.asarray(upright * said.length_m / spans[said.across])
