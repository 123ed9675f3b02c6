"""Propose folds: ways to fold a garment to a size that a robot can do.

Packets come from a search that asks no robot, those that people like first. Each is planned in turn, with little work,
until enough of them have plans. Of variants of one way (the same moves in another order, or mirrored) only the first is
proposed that can be done: the order and the side decide much for a robot and nothing for the packet.
"""

import math
from collections import Counter
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any, TypedDict, Unpack

from planner.cloth.garment import FOLDS_MAX, Garment
from planner.errors import RequestError
from planner.geometry.pose import Pose2
from planner.geometry.tolerance import DECIMALS
from planner.planning.robot_task import task_for
from planner.plans import find_plan
from planner.proposals.packet import Packet, Way
from planner.proposals.packet_search import PacketSearch
from planner.proposals.target import Sides, Target
from planner.task.plan import Plan
from planner.task.scene import Scene
from planner.task.task import DEFAULT_ROBOT, Task

FACES = ("any", "front", "back")
"""The faces of the cloth that may be asked to look up."""

COUNT_MAX = 32
"""The most proposals that may be asked for."""

WORK_LIMIT_S = 1.0
"""The work for the plan of one packet, in seconds of a present-day machine, by default."""

_PLANNED = 2
"""Packets that are planned for each proposal asked for, at most."""

_VARIANTS = 3
"""Variants of one way that are planned, at most."""


class ProposalOptions(TypedDict, total=False):
    """Further options of each plan; see `Task.of`."""

    placement: Pose2 | None
    start_station: str
    comfort_radius_m: float
    heuristic: str
    time_limit_s: float
    max_expanded: int


@dataclass(frozen=True, slots=True)
class Proposal:
    """A way to fold a garment, and what the robot makes of it.

    Attributes:
        garment: the garment with the folds proposed.
        size_m: the sides of the packet along the article frame's x and y axes (m).
        layers: the most layers that lie on one another.
        face: the face of the cloth that is seen most from above: "front" or "back".
        plan: the plan, or that there is none.
    """

    garment: Garment
    size_m: Sides
    layers: int
    face: str
    plan: Plan

    @property
    def status(self) -> str:
        """The status of its plan."""
        return self.plan.status

    @property
    def cost_s(self) -> float | None:
        """The time that the plan takes (s); None without one."""
        return self.plan.cost_s

    def to_dict(self) -> dict[str, Any]:
        """Return the proposal as JSON, without the plan."""
        garment = self.garment.to_dict()
        return {
            "folds": garment["folds"],
            "garment": garment,
            "size_m": [round(side_m, DECIMALS) for side_m in self.size_m],
            "layers": self.layers,
            "face": self.face,
            "status": self.status,
            "cost_s": self.cost_s,
        }


@dataclass(frozen=True, slots=True)
class Proposals:
    """All that `propose_folds` found.

    Attributes:
        proposals: those that can be done first, the quickest first.
        enumerated: the number of sequences of moves that were folded.
    """

    proposals: tuple[Proposal, ...]
    enumerated: int

    @property
    def is_any_solved(self) -> bool:
        """Whether the robot can do one of them."""
        return any(one.plan.is_solved for one in self.proposals)

    def to_dict(self) -> dict[str, Any]:
        """Return the proposals as JSON."""
        return {"proposals": [one.to_dict() for one in self.proposals], "enumerated": self.enumerated}


def all_proposals(found: Generator[Proposal, None, int], hear: Callable[[Proposal], None] | None = None) -> Proposals:
    """Return all that `propose_folds` finds, in order; `hear` is told each one as it is found."""
    proposals: list[Proposal] = []
    while True:
        try:
            proposals.append(next(found))
        except StopIteration as end:
            in_order = sorted(proposals, key=lambda one: math.inf if one.cost_s is None else one.cost_s)
            return Proposals(tuple(in_order), end.value)
        if hear is not None:
            hear(proposals[-1])


def propose_folds(
    garment: Garment,
    to: str | Sequence[float] | Target,
    *,
    robot: str = DEFAULT_ROBOT,
    count: int = 6,
    max_folds: int = 8,
    face: str = "any",
    scene: Scene | None = None,
    work_limit_s: float = WORK_LIMIT_S,
    should_stop: Callable[[], bool] | None = None,
    **options: Unpack[ProposalOptions],
) -> Generator[Proposal, None, int]:
    """Propose ways to fold a garment to a size, each with its plan.

    Args:
        garment: the garment; folds that it has are kept as the beginning.
        to: the size, see `Target.of`.
        robot: the robot's name.
        count: the most proposals.
        max_folds: the most folds of a proposal, those that the garment has included.
        face: the face of the cloth that looks up at the end: "any", "front" or "back".
        scene: the scene; None for the one that suits the robot.
        work_limit_s: the work for each plan, in seconds of a present-day machine.
        should_stop: polled during planning; nothing more is proposed once it returns true.
        options: those of each plan, as for `Task.of`.

    Yields:
        Those that can be done as they are found, about in the order of what people like; then others, up to the count,
        each the best of a way of which none can be done.

    Returns:
        The number of sequences of moves that were folded.

    Raises:
        FoldError: a fold of the garment is not legal.
        RequestError: an argument is out of range.
    """
    target = Target.of(to)
    _require("count", count, COUNT_MAX)
    _require("max_folds", max_folds, FOLDS_MAX)
    if face not in FACES:
        raise RequestError("face", f"expected one of {', '.join(FACES)}; got {face!r:.80}")
    task = task_for(garment, scene, robot=robot, work_limit_s=work_limit_s, **options)
    search = PacketSearch(garment, target, max_folds, face)
    return _planned(task, search, count, should_stop or _never)


def _planned(
    task: Task, search: PacketSearch, count: int, should_stop: Callable[[], bool]
) -> Generator[Proposal, None, int]:
    solved: dict[Way, Proposal] = {}
    failed: dict[Way, Proposal] = {}
    tried = Counter[Way]()
    for packet in search.packets():
        if len(solved) == count or tried.total() == _PLANNED * count:
            break
        if packet.way in solved or tried[packet.way] == _VARIANTS:
            continue
        tried[packet.way] += 1
        proposal = _proposal(task, packet, should_stop)
        if should_stop():
            return search.enumerated
        if not proposal.plan.is_solved:
            failed.setdefault(packet.way, proposal)
        else:
            solved[packet.way] = proposal
            yield proposal
    others = (proposal for way, proposal in failed.items() if way not in solved)
    yield from islice(others, count - len(solved))
    return search.enumerated


def _proposal(task: Task, packet: Packet, should_stop: Callable[[], bool]) -> Proposal:
    garment = replace(task.garment, folds=packet.folds)
    found = find_plan(replace(task, garment=garment), should_stop=should_stop, with_reasons=False)
    return Proposal(garment, packet.size_m, packet.layers, packet.face, found.plan)


def _require(name: str, value: int, most: int) -> None:
    if not 1 <= value <= most:
        raise RequestError(name, f"{value} is not within 1 to {most}")


def _never() -> bool:
    return False
