"""Transfers that are not validated yet: the combinations of steps, and where others of their kind were blocked.

What is known of a task's transfers is shared with its restricted variants (`KnownTransfers`).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain, islice, product

from planner.motion.transfer import Transfer, Transit
from planner.motion.transfer_tool_paths import Cloths
from planner.motion.waypoints import Waypoints
from planner.primitives.primitive import Step
from planner.robots.tool_path import NoPath
from planner.task.trajectory import Phase


@dataclass(frozen=True, slots=True)
class SearchLimits:
    """The limits of one round on the alternatives tried before a step is rejected.

    Most plans are found with few tries. More are made only where an untried alternative may hide a quicker plan, or the
    only one. The work is counted rather than timed, so that equal tasks get equal answers on every machine.

    Attributes:
        ways: alternatives of a transfer that are tested.
        variants: choices of each step that are combined with those of the others in its transfer.
        alone: failures with one arm after which a transfer is given up.
        together: the same with both arms: their paths take several times as long to find.
        late: transfers longer than estimated that are found before the quickest of them is taken.
        spread: other ways to do the same that are tested once a step is rejected.
        tried: the number of those for which joint paths are searched.
        enough: the number of valid ones among them that suffice.
        vain: failures with both arms after which no more of them are tried.
        failures: failures of the same from one station by the same arms, wherever the cloth lies, after which it is
            given up.
    """

    ways: int
    variants: int
    alone: int
    together: int
    late: int
    spread: int
    tried: int
    enough: int
    vain: int
    failures: int


QUICK = SearchLimits(
    ways=40, variants=6, alone=8, together=2, late=2, spread=64, tried=12, enough=4, vain=6, failures=5
)
"""The limits of the first round."""

THOROUGH = SearchLimits(
    ways=320, variants=24, alone=32, together=8, late=8, spread=256, tried=48, enough=16, vain=24, failures=20
)
"""The limits where the first round leaves a doubt."""

MORE_TRANSFERS = 160
"""Transfers planned in the second round while there is no plan yet."""


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """Steps of a transfer that are not validated yet.

    Attributes:
        steps: the primitives, none but the last of which lets go.
        motion: their key, see `motion_of`.
        carrying: the phases in which cloth is held, each with its primitive's number.
        waypoints: the same phases, moment by moment.
        cloths: the cloth on the table before and after.
    """

    steps: tuple[Step, ...]
    motion: tuple[object, ...]
    carrying: tuple[tuple[int, Phase], ...]
    waypoints: Waypoints
    cloths: Cloths

    @property
    def kind(self) -> tuple[object, ...]:
        """The key it shares with others that do the same with the same arms from the same station."""
        return tuple(step.task for step in self.steps)

    @property
    def is_together(self) -> bool:
        """Whether more than one arm holds cloth."""
        return bool(self.waypoints.is_held.any(axis=1).sum() > 1)


class BlockedWaypoints:
    """The waypoints at which transfers were blocked; others of the same kind are mostly blocked nearby."""

    def __init__(self) -> None:
        self._shares: dict[tuple[object, ...], float] = {}

    def note(self, candidate: "Candidate", found: NoPath) -> None:
        """Note the middle of the waypoints at which a candidate is blocked."""
        if len(found.blocked):
            middle = found.blocked[len(found.blocked) // 2]
            self._shares[candidate.kind] = float(middle) / (len(candidate.waypoints) - 1)

    def suspects(self, candidate: "Candidate") -> list[int]:
        """Return the waypoint of a candidate at which the last one of its kind was blocked, if one was."""
        share = self._shares.get(candidate.kind)
        return [] if share is None else [round(share * (len(candidate.waypoints) - 1))]


def ways_of(steps: Sequence[Step], search_limits: SearchLimits) -> Iterator[tuple[Step, ...]]:
    """Yield the steps, then combinations of their variants, up to the number of tries; variants take time to find.

    Those in which the hands of the first step are turned as the second needs them come before others: such hands need
    not turn in their grip, and the first few variants of both may have no turn in common.
    """
    yield tuple(steps)
    yield from islice(_others(steps, search_limits), search_limits.ways - 1)


def _others(steps: Sequence[Step], search_limits: SearchLimits) -> Iterator[tuple[Step, ...]]:
    """Yield the combinations of variants but for the steps themselves, each once."""
    choices = [tuple(islice(step.variants(), search_limits.variants)) for step in steps]
    seen = {motion_of(steps)}
    alike = ((one, *rest) for rest in product(*choices[1:]) if rest for one in steps[0].turned(rest[0].turns))
    for way in chain(alike, product(*choices)):
        key = motion_of(way)
        if key not in seen:
            seen.add(key)
            yield way


def motion_of(steps: Sequence[Step]) -> tuple[object, ...]:
    """Return the cache key of steps: a second round of tries repeats many of the first."""
    return tuple(step.motion for step in steps)


SAMPLED_IN_VAIN_MAX, SAMPLED_MORE_MAX = 2, 40
"""Paths of empty hands that are sampled in vain, at most, while one task is planned; and where a doubt is left."""


@dataclass(slots=True)
class Sampling:
    """How often paths of empty hands were sampled in vain; variants of a task share it.

    Attributes:
        vain: how often.
        most: how often they may be.
        left_out: how often no path was found where none was sampled.
    """

    vain: int = 0
    most: int = SAMPLED_IN_VAIN_MAX
    left_out: int = 0

    @property
    def is_worth_a_try(self) -> bool:
        """Whether paths may still be sampled."""
        return self.vain < self.most


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
        unsampled: the candidates without a transfer for which a path might be found by sampling.
    """

    can_be_there: dict[tuple[object, ...], bool] = field(default_factory=dict)
    candidates: dict[tuple[object, ...], Candidate] = field(default_factory=dict)
    made: dict[tuple[object, ...], tuple[Transfer | None, NoPath | None]] = field(default_factory=dict)
    made_at_edges: dict[tuple[object, ...], tuple[bool, Transfer | None]] = field(default_factory=dict)
    transits: dict[tuple[object, ...], Transit] = field(default_factory=dict)
    hastened: set[tuple[object, ...]] = field(default_factory=set)
    sampling: Sampling = field(default_factory=Sampling)
    unsampled: set[tuple[object, ...]] = field(default_factory=set)
