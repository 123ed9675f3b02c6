"""How neat a stack is: how well the outline that was seen matches the one that its folds should have left.

The outline as planned is laid where the stack was fitted. Its overlap with the one seen and the distance between both
tell how well they match; an affine map, fitted to the distances, tells of them how far right angles are off.
"""

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from app.rehearsal.vision.outline_edges import OutlineEdges
from planner.geometry.pose import FloatArray, Pose2, wrapped_angle
from planner.geometry.region import Region


@dataclass(frozen=True, slots=True)
class Neatness:
    """The match of a stack with what it should be.

    Attributes:
        iou: the area inside both outlines, as a share of what either encloses.
        edge_error_m: the mean distance of the outline seen from the one as planned (m).
        skewed_rad: by how much right angles of the stack are off (rad).
        turned_rad: how far it is turned from where the plan has it, counter-clockwise (rad); None without a plan or
            the table's frame.
        off_m: how far its middle is from where the plan has it (m); None likewise.
    """

    iou: float
    edge_error_m: float
    skewed_rad: float
    turned_rad: float | None
    off_m: float | None

    @staticmethod
    def of(contour: FloatArray, stack: Region, lies: Pose2, ought: Pose2 | None) -> "Neatness":
        """Return the neatness of a stack.

        Args:
            contour: points evenly along the outline seen, shape (n, 2), m.
            stack: the outline as planned, garment frame.
            lies: the garment frame where the stack was fitted, in the frame of the contour.
            ought: where the plan has it in that frame, if that is known.
        """
        inner = lies.to_inner(contour)
        edges = OutlineEdges.of(stack)
        distances, outwards = edges.distances(inner)
        # Each point stands for a strip as wide as it is off: outlines seen may cross themselves, so areas do not tell.
        beyond, missing = (edges.length * float(np.maximum(side, 0.0).mean()) for side in (distances, -distances))
        middle = edges.spaced(len(contour)).mean(axis=0)
        turned_rad = off_m = None
        if ought is not None:
            turned_rad = wrapped_angle(lies.yaw_rad - ought.yaw_rad)
            off_m = math.dist(lies.to_outer(middle), ought.to_outer(middle))
        return Neatness(
            max(0.0, stack.area - missing) / (stack.area + beyond),
            float(np.abs(distances).mean()),
            _skew(inner - distances[:, None] * outwards - middle, distances, outwards),
            turned_rad,
            off_m,
        )

    @property
    def text(self) -> str:
        """It in one sentence."""
        skewed = f"skewed by {abs(math.degrees(self.skewed_rad)):.1f} degrees"
        matched = (
            f"It matches {self.iou:.0%} of the outline as planned: {1000 * self.edge_error_m:.0f} mm off on average"
        )
        if self.turned_rad is None or self.off_m is None:
            return f"{matched}, {skewed}."
        turned = f"turned by {math.degrees(self.turned_rad):.1f} degrees, {1000 * self.off_m:.0f} mm from its place"
        return f"{matched}, {turned}, {skewed}."

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON."""
        return {**asdict(self), "text": self.text}


def _skew(feet: FloatArray, distances: FloatArray, outwards: FloatArray) -> float:
    """Return the shear of the affine map that moves points of an outline outwards by these distances (rad)."""
    (x, y), (across, up) = feet.T, outwards.T
    factors = np.column_stack([across, up, across * x, across * y, up * x, up * y])
    found = np.linalg.lstsq(factors, distances, rcond=None)[0]
    return float(found[3] + found[4])
