"""The paper's simulation results, typed from its Tables 1 and 2 (section 8).

These are another planner's results, on another machine, for garments, placements and a reach that the paper does not
fully state. They stand beside ours for comparison; ours are not meant to be equal.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

SOURCE: Final = (
    "K. Lakshmanan, A. Sachdev, Z. Xie, D. Berenson, K. Goldberg, P. Abbeel: A Constraint-Aware Motion Planning "
    "Algorithm for Robotic Folding of Clothes, ISER 2012, section 8"
)


@dataclass(frozen=True, slots=True)
class PaperRow:
    """A row of the paper's Table 1 or 2; the fields are in the order of its columns.

    Attributes:
        folds: number of folds.
        primitives: L, primitives in the plan.
        cost_s: C, the plan's duration (s).
        expanded: nodes expanded.
        explored: nodes explored.
        search_time_s: T, the time of the search (s).
        ik_time_s: the part of it spent in inverse kinematics (s).
        ik_queries: queries of inverse kinematics.
        overhead_s: "Overhead" (s), which the paper does not explain.
    """

    folds: int
    primitives: int
    cost_s: float
    expanded: int
    explored: int
    search_time_s: float
    ik_time_s: float
    ik_queries: int
    overhead_s: float


TABLE_1: Final[Mapping[str, PaperRow]] = MappingProxyType(
    {
        "t-shirt": PaperRow(5, 7, 48.12, 16, 84, 6.29, 1.14, 3512, 0.007),
        "jeans": PaperRow(2, 3, 35.01, 13, 116, 4.07, 1.44, 776, 0.008),
        "shirt": PaperRow(7, 9, 76.94, 84, 491, 28.29, 3.96, 5911, 0.040),
        "tie": PaperRow(3, 4, 27.90, 24, 256, 6.06, 1.59, 593, 0.013),
        "scarf": PaperRow(2, 3, 18.90, 14, 177, 4.94, 1.37, 593, 0.011),
        "vest": PaperRow(2, 2, 24.62, 8, 61, 1.91, 0.41, 383, 0.004),
        "skirt": PaperRow(3, 4, 29.63, 60, 535, 15.37, 5.42, 10087, 0.026),
        "big-towel": PaperRow(3, 4, 27.91, 22, 232, 8.47, 3.01, 6675, 0.013),
        "hand-towel": PaperRow(3, 3, 27.35, 18, 161, 5.04, 1.90, 400, 0.007),
    }
)
"""Table 1, by the names of our garments: a point counts as reachable without a comfort radius."""

TABLE_2: Final[Mapping[str, PaperRow]] = MappingProxyType(
    {
        "t-shirt": PaperRow(5, 7, 48.12, 40, 319, 55.08, 39.77, 9950, 0.010),
        "jeans": PaperRow(2, 3, 35.01, 13, 60, 1.64, 1.25, 272, 0.006),
        "shirt": PaperRow(7, 9, 76.94, 134, 920, 121.70, 85.99, 26867, 0.034),
        "tie": PaperRow(3, 4, 27.90, 26, 329, 20.75, 11.89, 4387, 0.007),
        "scarf": PaperRow(2, 3, 18.90, 16, 197, 18.71, 14.01, 4950, 0.004),
        "vest": PaperRow(2, 2, 24.62, 14, 101, 9.24, 6.82, 2073, 0.007),
        "skirt": PaperRow(3, 4, 29.63, 22, 201, 19.61, 14.87, 4432, 0.006),
        "big-towel": PaperRow(3, 4, 27.91, 24, 284, 35.63, 26.23, 6921, 0.016),
        "hand-towel": PaperRow(3, 3, 27.35, 17, 175, 20.80, 15.25, 4214, 0.004),
    }
)
"""Table 2, by the names of our garments: with an "IK comfort radius" of 3 cm."""
