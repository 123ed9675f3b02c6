"""Propose folds: ways to fold a garment to a size that a robot can do.

Packets come from a search that asks the robot about single folds, those that people like first. Each is planned in
turn until enough of them have plans. Until there is a proposal, what takes much work is put aside, since something
easier may follow, and the first plan that is found is not improved at length. Where a packet has no plan, its first
folds are planned alone, to learn which of them are to blame. To ask the robot takes much of the time: where no packet
comes soon, or the first has no plan, those that a search without a robot finds first are planned. Little work may give
a plan with loose grips where much work gives a firm one, which may take longer: such proposals say that they are loose,
and are planned once more at the end.

Of variants of one way (the same moves in another order, or from another side) only the first is proposed that can be
done: order and side decide much for a robot and nothing for the packet. At the end those variants and mirror images are
planned that may spare an arm motion; one that takes less time stands in for it.

Instead of a size another garment may be given: then its folds, fitted to this one, are the only way. Or the garment is
rolled up, to whatever size.
"""

import math
from collections import Counter
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence, Set
from contextlib import closing
from dataclasses import dataclass, replace
from heapq import heapify, heappop, heappush
from itertools import chain, islice
from typing import Any, Literal, NamedTuple, TypeAlias, TypedDict, Unpack, get_args

from planner.cloth.garment import FOLDS_MAX, DrawnFold, Garment
from planner.deadline import ShouldStop
from planner.errors import RequestError
from planner.geometry.pose import Pose2
from planner.geometry.region import Region
from planner.geometry.tolerance import DECIMALS, TIME_S
from planner.planning.events import Blocked
from planner.planning.found_plan import FoundPlan
from planner.planning.heuristic import arm_time
from planner.planning.plan_search import Hints
from planner.planning.problem import Problem
from planner.planning.robot_task import task_for
from planner.plans import FIRM_SHARE
from planner.plans import plan as plan_events
from planner.proposals.likeness import LikenessSearch
from planner.proposals.packet import Packet, Way, grid_of
from planner.proposals.packet_search import PacketSearch
from planner.proposals.robot_check import RobotCheck
from planner.proposals.rolling import RollSearch
from planner.proposals.target import Sides, Target
from planner.task.plan import Plan
from planner.task.scene import Scene
from planner.task.task import DEFAULT_ROBOT, Task

Face: TypeAlias = Literal["any", "front", "back"]
"""The faces of the cloth that may be requested to look up."""

COUNT_MAX = 32
"""The most proposals that may be requested."""

WORK_LIMIT_S = 1.0
"""The work for the plan of one packet, in seconds of a present-day machine, by default."""

_FAILURES = 4
"""Packets without a plan for each proposal requested, after which no more are planned."""

_BRIEF_SHARE = 0.4
"""The work for the plan of a packet's first folds, for a first try and for improving the first plan, as a share."""

_PATIENT_SHARE = 10.0
"""The work for a better plan at the end, and where no packet has a plan with its work, as a share of that."""

_ASIDE = 2
"""How many ways without a plan at that work are put aside, until one of them is planned with all of it."""

_VARIANTS, _MORE = 3, 4
"""Variants of one way that are planned, at most, and packets more that are looked at for them in the end."""

_FIRST, _SKETCHES = 2, 2
"""Sketches that are planned where the robot must be queried much, and ways looked at for each sketch."""


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
        size_m: the sides of the packet along the garment frame's x and y axes (m).
        layers: the most layers that lie on one another.
        face: the face of the cloth that is seen most from above: "front" or "back".
        plan: the plan, or that there is none; None before one is looked for.
        is_loose: whether hands hold some cloth from further away than firm grips do: no other plan was found.
        number: its place among those that were tried, from 1: a better one takes the number of the one that it stands
            in for; 0 of an untried one, and of one that does not fit.
    """

    garment: Garment
    size_m: Sides
    layers: int
    face: str
    plan: Plan | None
    is_loose: bool = False
    number: int = 0

    @property
    def status(self) -> str:
        """The status of its plan; "untried" before it is looked for."""
        return "untried" if self.plan is None else self.plan.status

    @property
    def cost_s(self) -> float | None:
        """The time that the plan takes (s); None without one."""
        return None if self.plan is None else self.plan.cost_s

    def planned(self, found: FoundPlan) -> "Proposal":
        """Return the same packet with a plan for its folds."""
        is_loose = found.plan.is_solved and not found.context.is_firm
        return replace(self, garment=found.plan.garment, plan=found.plan, is_loose=is_loose)

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
            "is_loose": self.is_loose,
            "number": self.number,
        }


class _Aside(NamedTuple):
    """A packet that was put aside, with the least time for each fold (s): infinite for a variant of another packet."""

    fold_s: float
    taste: float
    packet: Packet

    def __lt__(self, other: tuple[Any, ...]) -> bool:
        """Return whether it comes before another one, as the search has them where they are alike."""
        return self[:2] < other[:2]


@dataclass(frozen=True, slots=True)
class Tried:
    """What was tried to find proposals.

    Attributes:
        enumerated: the number of sequences of moves that were folded.
        nearest_m: the sides of the packet that lacks least to fit (m); one that fits, if any does.
    """

    enumerated: int
    nearest_m: Sides


@dataclass(frozen=True, slots=True)
class Proposals:
    """All that `propose_folds` found.

    Attributes:
        proposals: those that can be done first, the quickest first.
        tried: what was tried.
    """

    proposals: tuple[Proposal, ...]
    tried: Tried

    @property
    def is_any_solved(self) -> bool:
        """Whether the robot can do one of them."""
        return any(one.status == "solved" for one in self.proposals)

    def to_dict(self) -> dict[str, Any]:
        """Return the proposals as JSON; where nothing fits, with the size that comes nearest."""
        found = {"proposals": [one.to_dict() for one in self.proposals], "enumerated": self.tried.enumerated}
        if self.proposals:
            return found
        return {**found, "nearest_m": [round(side_m, DECIMALS) for side_m in self.tried.nearest_m]}


def all_proposals(found: Generator[Proposal, None, Tried], hear: Callable[[Proposal], None] | None = None) -> Proposals:
    """Return all proposals of `propose_folds` that were tried and fit, in order; call `hear` with each when found."""
    proposals: dict[int, Proposal] = {}
    while True:
        try:
            one = next(found)
        except StopIteration as end:
            proposals.pop(0, None)  # untried, or not fitting
            in_order = sorted(proposals.values(), key=lambda one: math.inf if one.cost_s is None else one.cost_s)
            return Proposals(tuple(in_order), end.value)
        proposals[one.number] = one
        if hear is not None:
            hear(one)


def propose_folds(
    garment: Garment,
    to: str | Sequence[float] | Target | Garment,
    *,
    robot: str = DEFAULT_ROBOT,
    count: int = 6,
    untried: int = 0,
    max_folds: int = 8,
    face: str = "any",
    scene: Scene | None = None,
    work_limit_s: float = WORK_LIMIT_S,
    should_stop: ShouldStop | None = None,
    **options: Unpack[ProposalOptions],
) -> Generator[Proposal, None, Tried]:
    """Propose ways to fold a garment to a size, or like another one, each with its plan.

    Args:
        garment: the garment; folds that it has are kept as the beginning.
        to: the size, see `Target.of`; or a garment that is folded like this one is to be.
        robot: the robot's name.
        count: the most proposals.
        untried: the most ways to fold to a size that come first, soon and without a plan, preferably such that each
            fold can be done alone; and where none can be done, the most that do not fit and can.
        max_folds: the most folds of a proposal, those that the garment has included.
        face: the face of the cloth that looks up at the end: "any", "front" or "back".
        scene: the scene; None for the one that suits the robot.
        work_limit_s: the work for each plan, in seconds of a present-day machine.
        should_stop: polled during planning; nothing more is proposed once it returns true.
        options: those of each plan, as for `Task.of`.

    Yields:
        Untried ways; then those that can be done as they are found, about in the order of what people like (where none
        is found with that work, with ten times as much); then others, up to the count, each the best of a way of which
        none can be done. At last the first one may come again with a quicker plan, those with loose grips with firm
        ones, and any with the folds of a quicker variant. Where nothing fits or none can be done, those that come
        nearest.

    Returns:
        What was tried.

    Raises:
        FoldError: a fold of the garment is not legal.
        RequestError: an argument is out of range.
    """
    target = to if isinstance(to, Garment) else Target.of(to)
    _require("count", count, COUNT_MAX)
    _require("max_folds", max_folds, FOLDS_MAX)
    if face not in get_args(Face):
        raise RequestError("face", f"expected one of {', '.join(get_args(Face))}; got {face!r:.80}")
    task = task_for(garment, scene, robot=robot, work_limit_s=work_limit_s, **options)
    proposer = _Proposer(task, count, should_stop or (lambda: False))
    if isinstance(target, Garment):
        return proposer.planned(LikenessSearch(garment, target))
    if target.is_roll:
        return proposer.planned(RollSearch(garment, max_folds))
    robot_check = RobotCheck(task)
    if target.is_smallest:
        return proposer.smallest(PacketSearch(garment, target, max_folds, face), untried)
    sketches = PacketSearch(garment, target, max_folds, face)
    search = PacketSearch(garment, target, max_folds, face, robot_check)
    return proposer.sketched_and_planned(sketches, search, robot_check, untried)


@dataclass(frozen=True, slots=True)
class _Proposer:
    """Plans what searches find until nobody wants proposals any more.

    Attributes:
        task: the garment, whose folds are the beginning, the robot, and the work for each plan.
        count: the most proposals.
        should_stop: polled during planning.
    """

    task: Task
    count: int
    should_stop: ShouldStop

    def sketched_and_planned(
        self, sketches: PacketSearch, search: PacketSearch, robot: RobotCheck, untried: int
    ) -> Generator[Proposal, None, Tried]:
        """Propose what a search without a robot finds first, without plans; then what the robot can do."""
        packets = sketches.packets()
        if untried:
            first = next(packets, None)
            if first is None:
                yield from (self._untried(packet) for packet in sketches.nearest[:untried])
                if not (yield from self._nearest(sketches, untried)):
                    for _ in search.packets():
                        if self.should_stop():
                            break
                    yield from self._nearest(search, untried)
                return Tried(sketches.enumerated, sketches.nearest_m)
            packets = chain((first,), packets)
        doubted, shown = list[Packet](), list[Packet]()
        sketched = _sketched(packets, robot, max(untried, _FIRST), doubted)
        for packet in islice(chain(sketched, doubted), untried):
            yield self._untried(packet)
            shown += [packet] if packet.is_sketch else []
        search.sketched = islice(chain(shown, sketched), _FIRST)
        return (yield from self.planned(search, untried))

    def smallest(self, search: PacketSearch, untried: int) -> Generator[Proposal, None, Tried]:
        """Propose ever smaller packets without plans, while they are sought; then those that the robot can do."""
        for number, packet in enumerate(search.shrinking()):
            if self.should_stop():
                break
            if number < untried:
                yield self._untried(packet)
        return (yield from self.planned(search))

    def planned(
        self, search: PacketSearch | LikenessSearch | RollSearch, nearest: int = 0
    ) -> Generator[Proposal, None, Tried]:
        """Propose what a search finds that the robot can do.

        Variants of sketched ways are proposed only if they spare an arm motion. Where the robot can do nothing, so many
        are proposed at the end that come nearest.
        """
        solved: set[Way] = set()
        failed: dict[Way, Proposal] = {}
        shown, fine = set[object](), set[tuple[DrawnFold, ...]]()
        sketched_s, found = dict[Way, float](), list[tuple[Packet, Proposal]]()
        aside, variants = list[_Aside](), list[Packet]()
        failures = 0
        packets = search.paced() if isinstance(search, PacketSearch) else search.packets()
        for packet, is_brief in _turns(packets, solved, shown, aside, variants):
            is_enough = failures >= _FAILURES * self.count or (packet.doubts and len(failed) >= self.count)
            if len(shown) == self.count or is_enough:
                break
            share = _BRIEF_SHARE if is_brief else 1.0
            improving_share = math.inf if shown else _BRIEF_SHARE  # the first one is not waited for
            proposal = _proposal(packet, self.plan(packet.folds, share, improving_share))
            if self.should_stop():
                break
            if is_brief and proposal.status == "budget_exceeded":
                bound_s = None if proposal.plan is None else proposal.plan.bound_s
                heappush(aside, _Aside((bound_s or 0.0) / len(packet.folds), packet.taste, packet))
                continue
            if proposal.status != "solved":
                failures += 1
                failed.setdefault(packet.way, proposal)
                if isinstance(search, PacketSearch) and (blamed := self._blamed(packet, fine)):
                    search.blame(blamed)
                    aside[:] = (one for one in aside if not search.is_blamed(one.packet))
                    heapify(aside)
                continue
            cost_s = proposal.cost_s or 0.0
            if packet.is_sketch:
                sketched_s[packet.way] = cost_s
            else:
                solved.add(packet.way)
                if cost_s > sketched_s.get(packet.way, math.inf) - self.task.scene.arm_motion_s:
                    continue
            if (looks := (packet.shape, proposal.cost_s)) not in shown:
                shown.add(looks)
                found.append((packet, replace(proposal, number=len(shown))))
                yield found[-1][1]
        if not self.should_stop():
            left = islice((one for way, one in failed.items() if way not in solved), self.count - len(shown))
            numbered = (replace(one, number=number) for number, one in enumerate(left, start=len(shown) + 1))
            is_any = bool(shown)
            for one in numbered if shown else self._tried_longer(numbered):
                is_any |= one.status == "solved"
                yield one
            if not is_any and isinstance(search, PacketSearch):
                yield from self._nearest(search, nearest)
        if not self.should_stop() and any(_may_spare(self.task, one.garment.folds, one) for _, one in found):
            known = {one.garment.folds for _, one in found}
            variants += (packet for packet in islice(filter(None, packets), _MORE) if packet.folds not in known)
        for packet, proposal in found:
            yield from self.better(packet, proposal, variants)
        return Tried(search.enumerated, search.nearest_m)

    def _untried(self, packet: Packet) -> Proposal:
        garment = replace(self.task.garment, folds=packet.folds)
        return Proposal(garment, packet.size_m, packet.layers, packet.face, None)

    def _nearest(self, search: PacketSearch, most: int) -> Generator[Proposal, None, bool]:
        """Propose those that come nearest to the size, without numbers, if they can be done; return whether any can."""
        is_any = False
        for packet in islice(search.nearest, most):
            proposal = _proposal(packet, self.plan(packet.folds))
            if self.should_stop():
                break
            if proposal.status == "solved":
                is_any = True
                yield proposal
        return is_any

    def _tried_longer(self, found: Iterable[Proposal]) -> Iterator[Proposal]:
        """Yield proposals of which none has a plan: first those that get one from more work, then the others."""
        others = list[Proposal]()
        for one in found:
            if one.status == "budget_exceeded" and not self.should_stop():
                one = one.planned(self.plan(one.garment.folds, _PATIENT_SHARE))
            if one.status == "solved":
                yield one
            else:
                others.append(one)
        if not self.should_stop():
            yield from others

    def _blamed(self, packet: Packet, fine: set[tuple[DrawnFold, ...]]) -> tuple[DrawnFold, ...]:
        """Return the first folds of a packet that have no plan by themselves; none if it takes all of them.

        Others that begin so have no plan either. First folds that have one are added to `fine`.
        """
        for done in range(len(self.task.garment.folds) + 1, len(packet.folds)):
            folds = packet.folds[:done]
            if folds not in fine and not self.plan(folds, _BRIEF_SHARE, 0.0).plan.is_solved:
                return folds
            fine.add(folds)
        return ()

    def better(self, packet: Packet, one: Proposal, variants: Iterable[Packet]) -> Iterator[Proposal]:
        """Yield a proposal again: if a variant or mirror image takes less time, or more work gives a better plan.

        More work is done for the first one, and for one with loose grips.
        """
        firm_share = 1.0 / FIRM_SHARE  # with a cost to beat, hands that hold in any way are not looked for
        for other in islice(_likely_quicker(self.task, packet, one, variants), _VARIANTS):
            if self.should_stop():
                return
            found = self.plan(other.folds, firm_share, below_s=one.cost_s or 0.0)
            if found.plan.is_solved:
                one = _proposal(other, found, one.number)
                yield one
                break
        is_fine = one.plan is None or one.plan.is_proven or one.number > 1
        if self.should_stop() or (is_fine and not one.is_loose):
            return
        again = one.planned(self.plan(one.garment.folds, _PATIENT_SHARE))
        is_quicker = (again.cost_s or math.inf) < (one.cost_s or 0.0) - TIME_S
        if is_quicker or (one.is_loose and again.status == "solved" and not again.is_loose):
            yield again

    def plan(
        self,
        folds: tuple[DrawnFold, ...],
        share: float = 1.0,
        improving_share: float = math.inf,
        below_s: float = math.inf,
    ) -> FoundPlan:
        """Return the plan for some folds; where there is none, with the reasons that were met and not tried.

        Args:
            folds: the folds.
            share: the share of the task's work to do.
            improving_share: the share of that work for which a plan is improved once there is one.
            below_s: the cost that it has to beat (s).
        """
        work_s = share * (self.task.limits.work_limit_s or 0.0)
        limits = replace(self.task.limits, work_limit_s=work_s)
        folded = replace(self.task, garment=replace(self.task.garment, folds=folds), limits=limits)
        events = plan_events(
            folded, Hints(below_s=below_s), should_stop=self.should_stop, improving_s=improving_share * work_s
        )
        with closing(events):
            for event in events:
                if isinstance(event, Blocked):
                    break
        return event.found


def _sketched(packets: Iterator[Packet], robot: RobotCheck, most: int, doubted: list[Packet]) -> Iterator[Packet]:
    """Yield one packet of each way of which the robot can do each fold alone; few are looked at.

    Those of other ways are added to `doubted`.
    """
    ways = set[Way]()
    for packet in packets:
        if packet.way not in ways and packet.checked(robot).doubts:
            doubted.append(packet)
        elif packet.way not in ways:
            yield replace(packet, is_sketch=True)
        ways.add(packet.way)
        if len(ways) == _SKETCHES * most:
            return


def _likely_quicker(task: Task, packet: Packet, found: Proposal, variants: Iterable[Packet]) -> Iterator[Packet]:
    """Yield mirror images and variants of a packet whose plans may spare an arm motion."""
    images = () if task.garment.folds else packet.images(Region.polygon(task.garment.outline))
    others = (one for one in variants if one.way == packet.way and grid_of(one.size_m) == grid_of(packet.size_m))
    for one in chain((replace(packet, folds=folds) for folds in images), others):
        if _may_spare(task, one.folds, found):
            yield one


def _may_spare(task: Task, folds: tuple[DrawnFold, ...], found: Proposal) -> bool:
    """Return whether some folds alone take an arm motion less than a plan, so that a drag or a drive may be spared."""
    problem = Problem.of(replace(task, garment=replace(task.garment, folds=folds)))
    return arm_time(problem.context)(problem.start) <= (found.cost_s or 0.0) - task.scene.arm_motion_s


def _turns(
    packets: Iterable[Packet | None],
    solved: Set[Way],
    shown: Set[object],
    aside: "list[_Aside]",
    variants: list[Packet],
) -> Iterator[tuple[Packet, bool]]:
    """Yield packets to plan, and whether with little work: few of each way, and those put aside again.

    They come again once there are enough of them, or a proposal, or the next packet takes long (None): the one with the
    least bound for each of its folds first. Variants of solved ways are added to `variants` instead.
    """
    planned, tried = set[tuple[DrawnFold, ...]](), Counter[Way]()
    for packet in packets:
        if packet is not None:
            is_enough = packet.way in solved or tried[packet.way] >= (1 if packet.doubts else _VARIANTS)
            if is_enough or packet.folds in planned:
                variants += [packet] if packet.way in solved and packet.folds not in planned else []
                continue
            planned.add(packet.folds)
            tried[packet.way] += not packet.is_sketch
            if any(one.packet.way == packet.way for one in aside):
                heappush(aside, _Aside(math.inf, packet.taste, packet))
                continue
            yield packet, not (shown or packet.is_sketch)
        is_due = packet is None
        while aside and (is_due or shown or len({one.packet.way for one in aside}) == _ASIDE):
            is_due = False
            yield from _again(aside, solved)
    while aside:
        yield from _again(aside, solved)


def _again(aside: "list[_Aside]", solved: Set[Way]) -> Iterator[tuple[Packet, bool]]:
    """Take the next packet that was put aside, and yield it unless its way has been found since."""
    packet = heappop(aside).packet
    if packet.way not in solved:
        yield packet, False


def _proposal(packet: Packet, found: FoundPlan, number: int = 0) -> Proposal:
    one = Proposal(found.plan.garment, packet.size_m, packet.layers, packet.face, None, number=number)
    return one.planned(found)


def _require(name: str, value: int, most: int) -> None:
    if not 1 <= value <= most:
        raise RequestError(name, f"{value} is not within 1 to {most}")
