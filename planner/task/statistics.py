"""Figures of the search that made a plan."""

from dataclasses import dataclass
from typing import Any

from planner.json_form import STRICT


@dataclass(frozen=True, slots=True)
class Statistics:
    """Figures of the search (paper, Table 1).

    Attributes:
        expanded: states expanded.
        explored: successors pushed.
        ik_queries: queries of the exact inverse kinematics, including those for comfort points.
        ik_time_s: time spent in them (s).
        search_time_s: time of the whole search (s), without joint paths.
        joint_time_s: time spent on joint paths (s).
        bound_s: a lower bound on the cost of any plan, whatever the joints can do (s); None when the search ended
            without a plan and had time left.
        ways: candidate steps that were examined; the work of the search, equal on every machine.
        is_cut_short: whether it ended for lack of work, time or states; if not, a longer search finds nothing else.
    """

    __pydantic_config__ = STRICT

    expanded: int
    explored: int
    ik_queries: int
    ik_time_s: float
    search_time_s: float
    joint_time_s: float
    bound_s: float | None
    ways: int = 0
    is_cut_short: bool = False

    def after(self, before: "Statistics") -> "Statistics":
        """Return the sum of these and another search's figures, from which this one went on, with this one's bound."""
        return Statistics(
            before.expanded + self.expanded,
            before.explored + self.explored,
            before.ik_queries + self.ik_queries,
            before.ik_time_s + self.ik_time_s,
            before.search_time_s + self.search_time_s,
            before.joint_time_s + self.joint_time_s,
            self.bound_s,
            before.ways + self.ways,
            self.is_cut_short,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the statistics as JSON."""
        return {name: getattr(self, name) for name in self.__slots__}
