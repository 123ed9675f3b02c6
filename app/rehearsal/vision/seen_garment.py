"""A garment seen in a picture: its outline, its placement, and the confidence in both."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from app.files.sketch_garment import plain_name
from app.rehearsal.camera.calibration import Calibration
from app.rehearsal.vision.like import Like, liken
from app.rehearsal.vision.on_table import OnTable, outline_on_table
from app.rehearsal.vision.picture import read_picture
from app.rehearsal.vision.scale_said import read_scale
from app.rehearsal.vision.stack_fit import unknown_json
from app.rehearsal.vision.straighten import Straightened, find_mirror, near_m, size_m, straighten, symmetric
from app.rehearsal.vision.vision_errors import NothingToldError
from planner.cloth.garment import Garment
from planner.errors import GarmentError
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from planner.message import Message


@dataclass(frozen=True, slots=True)
class Sure:
    """The confidence in a garment that was seen.

    Attributes:
        share: the share of the outline's points within `within_m` of the garment's outline.
        within_m: how near that is (m).
        agreement: the overlap of two ways to find the cloth that know little of each other.
        size_error: by which share the size may be wrong, at about 95 of 100; None where a length was typed.
        unknown: why the garment may be wrong; None where there is no reason.
    """

    share: float
    within_m: float
    agreement: float
    size_error: float | None
    unknown: Message | None

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON; ``value`` is the product of share and agreement."""
        return {
            "value": self.share * self.agreement,
            "share_within": self.share,
            "within_m": self.within_m,
            "agreement": self.agreement,
            "size_error": self.size_error,
            **unknown_json(self.unknown),
        }


@dataclass(frozen=True, slots=True)
class Seen:
    """A garment seen.

    Attributes:
        garment: the garment, upright in its own frame.
        placement: the garment frame where it lies in `frame`.
        frame: "sheet", "marker", "picture" or "table"; see `OnTable.frame`.
        scale_from: what gave the scale.
        sure: how sure it is.
        notes: remarks on how it was read.
    """

    garment: Garment
    placement: Pose2
    frame: str
    scale_from: str
    sure: Sure
    notes: tuple[Message, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON."""
        return {
            "garment": self.garment.to_dict(),
            "placement": self.placement.to_dict(),
            "frame": self.frame,
            "scale_from": self.scale_from,
            "sure": self.sure.to_dict(),
            "notes": [note.text for note in self.notes],
        }


def see(data: bytes, name: str, scale: str | Calibration | None, like: Like | None = None) -> Seen:
    """Return the garment that a picture shows.

    Args:
        data: a PNG or JPEG.
        name: the garment's title.
        scale: what gives the scale, as `read_scale` takes it, or a calibrated camera; None to look for a sheet
            of paper.
        like: what the garment is like: its measures are fitted, and its folds brought along; None to take the outline
            as it is seen.

    Raises:
        PictureError: the file is no picture that can be read, or the scale is not one.
        NothingToldError: there is nothing to be read from it.
        ScaleNeededError: nothing says how large it is.
    """
    said = read_scale(scale) if isinstance(scale, str) else scale
    seen = outline_on_table(read_picture(data), said)
    return drawn(seen, name) if like is None else _likened(seen, name, like)


def drawn(seen: OnTable, title: str) -> Seen:
    """Return the garment with straight edges, symmetric where it nearly is, upright."""
    straight = straighten(seen.contour)
    notes = [
        Message("corners_seen", f"the outline has {len(straight.corners)} corners", {"corners": len(straight.corners)})
    ]
    corners, axis_rad = straight.corners, seen.up_rad
    mirror = find_mirror(corners)
    made = None if mirror is None else symmetric(corners, mirror)
    if made is not None and _area_off(made, seen.contour) > _MOST_AREA_OFF:  # of narrow cloth the wrong corners pair up
        made = None
    if mirror is None:
        notes.append(Message.plain("the outline is not symmetric, and was left as it was seen"))
    elif made is None:
        axis_rad = mirror.angle_rad
        notes.append(Message.plain("the outline is nearly symmetric, but its corners do not pair up; left as it is"))
    else:
        corners, axis_rad = made, mirror.angle_rad
        text = f"the outline was made symmetric; its halves differed by {mirror.off_m:.4f} m in the mean"
        notes.append(Message("made_symmetric", text, {"off_m": mirror.off_m}))
    outline, placement = _upright(corners, axis_rad, seen.up_rad)
    sure = Sure(
        straight.share, straight.within_m, seen.seen.agreement, seen.size_error, _doubt(seen, straight, outline)
    )
    try:
        garment = Garment.from_dict({"name": plain_name(title), "title": title, "outline": outline.tolist()})
    except GarmentError as error:
        text = f"what stands out from the table has no outline that a garment may have: {error.message}"
        raise NothingToldError(seen.doubt or Message.plain(text)) from None
    return Seen(garment, placement, seen.frame, seen.scale_from, sure, tuple(notes))


def _likened(seen: OnTable, title: str, like: Like) -> Seen:
    """Return a known kind of garment that fits the outline seen."""
    found = liken(seen.contour, like)
    within_m = near_m(size_m(Region.polygon(seen.contour)))
    share = float((np.abs(found.distances) <= within_m).mean())
    doubt = seen.doubt
    if doubt is None and share < _LEAST_SHARE:
        text = f"only {share:.0%} of the outline lie within {within_m:.3f} m of what it should be like"
        doubt = Message("likeness_does_not_fit", text, {"share": share, "within_m": within_m})
    sure = Sure(share, within_m, seen.seen.agreement, seen.size_error, doubt)
    garment = replace(found.garment, name=plain_name(title), title=title)
    note = Message.plain(f"the outline is that of {like.title}, fitted to what was seen; its folds were taken along")
    return Seen(garment, found.placement, seen.frame, seen.scale_from, sure, (note,))


_LEAST_SHARE = 0.85

_MOST_AREA_OFF = 0.05
"""The largest relative error of an outline's area; more means that a corner is missing, however near the points are."""


def _area_off(corners: FloatArray, contour: FloatArray) -> float:
    """Return by which share the area within some corners differs from that within the points seen."""
    return abs(Region.polygon(corners).area / Region.polygon(contour).area - 1.0)


def _doubt(seen: OnTable, straight: Straightened, outline: FloatArray) -> Message | None:
    off = _area_off(outline, seen.contour)
    if seen.doubt is None and off > _MOST_AREA_OFF:
        text = f"the area within the straight edges differs by {off:.0%} from what was seen"
        return Message("edges_do_not_fit", text, {"share": off})
    if seen.doubt is None and straight.share < _LEAST_SHARE:
        text = f"straight edges fit only {straight.share:.0%} of the outline to {straight.within_m:.3f} m"
        return Message("edges_do_not_fit", text, {"share": straight.share, "within_m": straight.within_m})
    return seen.doubt


def _upright(corners: FloatArray, axis_rad: float, up_rad: float) -> tuple[FloatArray, Pose2]:
    """Return corners in a garment frame with a line of symmetry along x or y, and its placement.

    Of the frame's four turns the one with y nearest to up is taken. Its origin is at the lower left of the corners.
    """
    turn = up_rad - math.pi / 2 + math.remainder(axis_rad - up_rad, math.pi / 2)
    inner = Pose2(0.0, 0.0, turn).to_inner(corners)
    low = inner.min(axis=0)
    x, y = Pose2(0.0, 0.0, turn).to_outer(low)
    return inner - low, Pose2(float(x), float(y), turn)
