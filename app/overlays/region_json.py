"""Writes connected regions as JSON."""

from typing import Any

from planner.geometry.pose import FloatArray
from planner.geometry.region import Region


def rings_of(part: Region) -> tuple[FloatArray, ...]:
    """Return the rings of a connected region, shape (n, 2) each, m: the outer one, then those of its holes."""
    holes = Region.polygon(part.ring).difference(part)
    return (part.ring, *(hole.ring for hole in holes.pieces))


def region_to_dict(part: Region) -> dict[str, Any]:
    """Return a connected region as its outer ring and those of its holes."""
    outer, *holes = (ring.tolist() for ring in rings_of(part))
    return {"outer": outer, "holes": holes}
