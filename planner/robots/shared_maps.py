"""The maps of a robot's arms, in memory once: what the compiled queries hold serves each arm alone, too."""

from collections.abc import Sequence
from itertools import accumulate

from planner.robots.mapped_comfort import MappedArms
from planner.robots.reach_map import ReachMap


def shared_maps(arms: MappedArms, maps: Sequence[ReachMap]) -> tuple[ReachMap, ...]:
    """Return the maps that arms were made of as parts of what these hold, so that the maps need not be kept as well."""
    counts = [len(known.starts) for known in maps]
    parts = zip(maps, counts, accumulate(counts), strict=True)
    return tuple(ReachMap(known.grid, arms.starts[end - count : end], arms.postures) for known, count, end in parts)
