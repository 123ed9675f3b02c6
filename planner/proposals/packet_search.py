"""Search for packets of a size: best first over stacks, move by move.

The naive search, every line in every order, drowns in stacks that nobody wants. So a state is the garment after a few
*moves* that people know. What a move does to the garment's length and width is known without folding it, so what waits
is a state with a move that has not been made: it is made, which takes some milliseconds, when its turn comes. The next
is always the one with the least effort so far and the least that is still needed: halves and thirds that bring each
side to the target, and the layers in which all of the cloth lies within it. So packets come out about in the order of
what people like, and the first are there while the rest is not yet looked for.

A robot is queried about a stack when its turn comes to be folded on. What it hardly can do waits longer then, and
so does what begins with folds that turned out to have no plan.
"""

import math
from collections import Counter
from collections.abc import Iterator
from functools import cache
from heapq import heappop, heappush
from itertools import count
from typing import Literal, NamedTuple, TypeAlias

from planner.cloth.garment import DrawnFold, Garment
from planner.proposals.moves import Move, flap_moves, inward_moves, slanted_moves
from planner.proposals.packet import FOLD_EFFORT, LAYER_EFFORT, Packet, grid_of
from planner.proposals.robot_check import DOUBT_EFFORT, RobotCheck
from planner.proposals.target import TOLERANCE_M, Sides, Target, excess_m, is_filling, is_fitting

_ENUMERATED_MAX = 600
"""The most sequences of moves that are folded."""

_LAYERS_MAX = 64
"""The most layers of a stack that is looked at."""

_SOON, _PAUSE = 20, 8
"""The sequences that are folded without one that fits, before sketches come first; and before that is reported."""

_VARIANTS = 3
"""The most variants that are folded: packets of one way that fit, and states of one way and size."""

_OBLONG_M = 0.001
"""Added to each side, so that of rectangles of one area the squarer one counts as smaller (m)."""

_SMALLER = 0.7
"""The size of a packet beside the smallest known, at most, so that it is shown while smaller ones are sought."""

_LAST = 1000.0
"""An effort that puts a packet after all others."""


Turn: TypeAlias = Literal["look", "yield"]
"""What is done with a packet whose turn comes: it is looked at, or it is one of the answers."""


class _Waiting(NamedTuple):
    """A packet in the queue, and what is done with it: a move, or its turn."""

    rank: float
    serial: int
    packet: Packet
    step: Move | Turn
    is_blamed: bool


class PacketSearch:
    """The search for ways to fold a garment to a size.

    Attributes:
        enumerated: the number of sequences of moves that were folded so far.
        nearest_m: the sides of the packet that lacks least to fit the target (m).
        sketched: an iterator of packets that come next where none comes soon, or the robot cannot do the first ones.
    """

    def __init__(
        self, garment: Garment, target: Target, max_folds: int, face: str = "any", robot: RobotCheck | None = None
    ) -> None:
        """Prepare the search; raises `FoldError` if a fold that the garment has is not legal."""
        self._begin = Packet.of(garment)
        self._radius_m, self._thickness_m = garment.grip_radius_m, garment.thickness_m
        self._is_for_smallest = target.is_smallest
        self._target_m = target.sides_of(self._begin.size_m)
        ordered = zip(sorted(self._target_m), sorted(self._begin.size_m), strict=True)
        (x_m, y_m), cloth = self._target_m, self._begin.cloth
        area_m2 = sum(layer.region.area for layer in cloth.layers)
        self._layers_least = math.ceil(area_m2 / ((x_m + TOLERANCE_M) * (y_m + TOLERANCE_M)))
        self._full_m = tuple(min(most, begun) for most, begun in ordered)
        self._max_folds = max_folds
        self._face = face
        self._robot = None if target.is_smallest else robot  # all are folded before the first is yielded
        self._queue: list[_Waiting] = []
        self._serial = count()
        self._met: dict[object, int] = {}
        self._folded = Counter[object]()
        self._blamed: list[tuple[DrawnFold, ...]] = []
        self.enumerated = 0
        self.nearest_m = self._begin.size_m
        self._nearest: dict[int, Packet] = {}
        self._smallest: dict[int, Packet] = {}
        self.sketched: Iterator[Packet] = iter(())

    def packets(self) -> Iterator[Packet]:
        """Yield packets that fit the target, about by taste; those much smaller than the target come last.

        For the smallest packet: the smallest for each number of folds, the smallest first. None is narrower than high.
        """
        if self._is_for_smallest:
            if not self._smallest:
                for _ in self.shrinking():
                    pass
            yield from sorted(self._smallest.values(), key=lambda packet: _bulk_m2(packet.size_m))
        else:
            yield from filter(None, self._found())

    def shrinking(self) -> Iterator[Packet]:
        """Search for the smallest packet of each number of folds; yield the first, and those that are much smaller."""
        for packet in filter(None, self._found()):
            bulk_m2, known = _bulk_m2(packet.size_m), self._smallest.get(len(packet.folds))
            known_m2 = math.inf if known is None else _bulk_m2(known.size_m)
            if bulk_m2 < known_m2 and self._is_wide(packet):
                self._smallest[len(packet.folds)] = packet
                if bulk_m2 < _SMALLER * known_m2:
                    yield packet

    def blame(self, folds: tuple[DrawnFold, ...]) -> None:
        """Have all packets that begin with some folds wait, because the robot cannot do these."""
        self._blamed.append(folds)

    def is_blamed(self, packet: Packet) -> bool:
        """Return whether a packet begins with folds that the robot cannot do."""
        return any(packet.folds[: len(blamed)] == blamed for blamed in self._blamed)

    @property
    def nearest(self) -> list[Packet]:
        """The packets that lack least to fit, the nearest first, each after one with more folds; of none is doubted."""
        found = list[Packet]()
        for packet in sorted(self._nearest.values(), key=self._excess_m):
            if (not found or len(packet.folds) < len(found[-1].folds)) and self._is_wide(packet):
                found.append(packet)
        return found

    def paced(self) -> Iterator[Packet | None]:
        """Yield the same packets, and None where the next one takes long."""
        return self.packets() if self._is_for_smallest else self._found()

    def _found(self) -> Iterator[Packet | None]:
        self._look_at(self._begin)
        if self._face != "any":  # cloth that lies front up ends with its back outside, and the other way round
            for turned in self._begin.turned(self._radius_m):
                self._wait(0.0, turned, "look")
        is_any, since = False, 0
        while self._queue:
            if self._blamed or (self.enumerated >= _SOON and not is_any):
                yield from (packet for packet in self.sketched if not self.is_blamed(packet))
            waiting = heappop(self._queue)
            packet, step = waiting.packet, waiting.step
            if not waiting.is_blamed and self.is_blamed(packet):
                self._wait(waiting.rank + DOUBT_EFFORT, packet, step, is_blamed=True)
            elif step == "yield":
                is_any, since = True, 0
                yield packet
            elif step == "look":
                self._ask(waiting)
            elif self.enumerated < _ENUMERATED_MAX and self._is_new(packet, step):
                self.enumerated += 1
                since += 1
                if since == _PAUSE:
                    since = 0
                    yield None
                after = packet.after(step, self._radius_m)
                if after is not None and len(after.cloth.layers) <= _LAYERS_MAX:
                    self._wait(waiting.rank, after, "look")

    def _ask(self, waiting: "_Waiting") -> None:
        """Ask the robot about a packet, and look at it, or later if it means an effort."""
        packet = waiting.packet
        if self._is_met(packet):
            return
        if self._robot is not None and not packet.is_checked:
            checked = packet.checked(self._robot)
            if checked.effort > packet.effort:
                self._wait(waiting.rank + checked.effort - packet.effort, checked, "look", is_blamed=waiting.is_blamed)
                return
            packet = checked
        self._look_at(packet)

    def _is_new(self, packet: Packet, move: Move) -> bool:
        """Return whether few variants of a packet with a move were folded; count it."""
        is_fit = not self._is_for_smallest and is_fitting(move.size_m, self._target_m)
        variant = (packet.is_turned, packet.way_with(move), None if is_fit else grid_of(move.size_m), packet.doubts)
        self._folded[variant] += 1
        return self._folded[variant] <= _VARIANTS

    def _is_met(self, packet: Packet) -> bool:
        """Return whether an equal packet that is as easy for the robot has been examined."""
        return self._met.get((packet.is_turned, packet.shape), packet.doubts + 1) <= packet.doubts

    def _look_at(self, packet: Packet) -> None:
        """Have a packet wait that fits, and of another one each move that may follow."""
        if len(packet.folds) > self._max_folds:
            return
        self.nearest_m = min(self.nearest_m, packet.size_m, key=lambda size_m: excess_m(size_m, self._target_m))
        if packet.moves and not packet.doubts:
            known = self._nearest.get(len(packet.folds), packet)
            self._nearest[len(packet.folds)] = min(known, packet, key=self._excess_m)
        is_fit = self._is_for_smallest or is_fitting(packet.size_m, self._target_m)
        if is_fit and self._face in ("any", packet.face):
            self._wait(self._rank(packet), packet, "yield")
        elif is_fit and not (packet.is_turned or self._is_for_smallest):
            for turned in packet.turned(self._radius_m):
                self._wait(self._rank(turned), turned, "look")
        if is_fit and not self._is_for_smallest:
            return
        self._met[packet.is_turned, packet.shape] = packet.doubts
        silhouette = packet.cloth.silhouette
        for move in (
            *inward_moves(silhouette.bounds, self._target_m),
            *(() if packet.moves else (*flap_moves(silhouette), *slanted_moves(silhouette))),
        ):
            if len(packet.folds) + len(move.creases) <= self._max_folds:
                self._wait(self._promise(packet, move), packet, move)

    def _is_wide(self, packet: Packet) -> bool:
        """Return whether a packet is no narrower than high."""
        return packet.layers * self._thickness_m <= min(packet.size_m)

    def _excess_m(self, packet: Packet) -> float:
        return excess_m(packet.size_m, self._target_m)

    def _wait(self, rank: float, packet: Packet, step: "Move | Turn", *, is_blamed: bool = False) -> None:
        heappush(self._queue, _Waiting(rank, next(self._serial), packet, step, is_blamed))

    def _rank(self, packet: Packet) -> float:
        """Return where a packet that fits comes in the queue."""
        if self._is_for_smallest:
            return _bulk_m2(packet.size_m)
        return packet.taste if is_filling(packet.size_m, self._full_m) else packet.taste + _LAST

    def _promise(self, packet: Packet, move: Move) -> float:
        """Return where a state with a move comes in the queue: the least effort of the packets that it may lead to.

        For the smallest packet it is the size of the rectangle.
        """
        if self._is_for_smallest:
            return _bulk_m2(move.size_m)
        folds, layers = len(packet.folds) + len(move.creases), max(len(packet.cloth.layers) + 1, self._layers_least)
        done = packet.effort + move.effort + FOLD_EFFORT * folds
        return done + _least_effort(move.size_m, self._target_m) + LAYER_EFFORT * layers


def _bulk_m2(size_m: Sides) -> float:
    """Return how large a rectangle is (m^2), by its area, and of equal areas by its longer side."""
    return size_m[0] * size_m[1] + _OBLONG_M * sum(size_m)


def _least_effort(size_m: Sides, target_m: Sides) -> float:
    """Return the least effort of the moves that bring a rectangle to a target, either way round."""
    wide, long = target_m
    return min(
        sum(_shortening(math.ceil(side / (most + TOLERANCE_M))) for side, most in zip(size_m, sides, strict=True))
        for sides in ((wide, long), (long, wide))
    )


@cache
def _shortening(parts: int) -> float:
    """Return the least effort of the halves and thirds that bring a side to one of some equal parts, or shorter."""
    if parts <= 1:
        return 0.0
    half, thirds = (1.0 + folds * FOLD_EFFORT + _shortening(math.ceil(parts / (folds + 1))) for folds in (1, 2))
    return min(half, thirds)
