"""A contact between two parts in collision."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Contact:
    """A contact of two parts, of the robot or of the robot and the table.

    Attributes:
        first: the first part's name for people, always of the robot: ``left forearm``.
        second: the second part's name for people: ``right palm``, ``torso``, ``table top``.
        depth_m: how far either part must move until the margin asked for is kept (m).
    """

    first: str
    second: str
    depth_m: float
