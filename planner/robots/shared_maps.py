"""The maps of a robot's arms, in memory once: what the compiled queries hold serves each arm alone, too."""

from collections.abc import Sequence
from itertools import accumulate

from planner.robots.mapped_comfort import MappedArms
from planner.robots.posture_map import PostureMap


def shared_maps(arms: MappedArms, maps: Sequence[PostureMap]) -> tuple[PostureMap, ...]:
    """Return the maps that arms were made of as parts of what these hold, so that the maps need not be kept as well."""
    counts = [len(known.starts) for known in maps]
    parts = zip(maps, counts, accumulate(counts), strict=True)
    return tuple(PostureMap(known.grid, arms.starts[end - count : end], arms.postures) for known, count, end in parts)
