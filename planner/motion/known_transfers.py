"""The cache of a task's transfers, which its restricted variants share."""

from dataclasses import dataclass, field

from planner.motion.transfer import Transfer
from planner.motion.transfer_candidate import Candidate
from planner.motion.transit import Transit
from planner.robots.tool_path import NoPath

SAMPLED_IN_VAIN_MAX = 2
"""Paths of empty hands that are sampled in vain, at most, while one task is planned."""


@dataclass(slots=True)
class Sampling:
    """How often paths of empty hands were sampled in vain; variants of a task share it.

    Attributes:
        vain: how often.
    """

    vain: int = 0

    @property
    def is_worth_a_try(self) -> bool:
        """Whether paths may still be sampled."""
        return self.vain < SAMPLED_IN_VAIN_MAX


@dataclass(frozen=True, slots=True, eq=False)
class KnownTransfers:
    """Cached answers about the transfers of a task, by their steps' motions; restricted tasks share them.

    Attributes:
        can_be_there: whether the arms have free postures where the steps begin and end.
        candidates: the candidates that steps make.
        made: the transfer of each candidate, None where it has none, and the waypoints at which it was blocked, if any.
        made_at_edges: the same with hands holding edges; whether joint paths were searched, and the transfer.
        transits: how hands come from one transfer to the next, by both and by what the base does meanwhile.
        hastened: the transits that were late, and for which shortcuts were looked for.
        sampling: how often their ways were sampled in vain.
    """

    can_be_there: dict[tuple[object, ...], bool] = field(default_factory=dict)
    candidates: dict[tuple[object, ...], Candidate] = field(default_factory=dict)
    made: dict[tuple[object, ...], tuple[Transfer | None, NoPath | None]] = field(default_factory=dict)
    made_at_edges: dict[tuple[object, ...], tuple[bool, Transfer | None]] = field(default_factory=dict)
    transits: dict[tuple[object, ...], Transit] = field(default_factory=dict)
    hastened: set[tuple[object, ...]] = field(default_factory=set)
    sampling: Sampling = field(default_factory=Sampling)
