"""Two parts that are in each other's way."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Contact:
    """Two parts, of the robot or the table, that are in each other's way.

    Attributes:
        first: what people call one, always of the robot: ``left forearm``.
        second: what they call the other: ``right palm``, ``torso``, ``table top``.
        depth_m: how far one must move until they are apart, by the margin asked for (m).
    """

    first: str
    second: str
    depth_m: float
