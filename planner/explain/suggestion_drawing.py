"""Suggest to draw the garment otherwise.

- **flip**: the other side of the cloth moves at the same line.
- **order**: the same folds in another order. The planner already tries every order that the Fold-DAG allows; they all
  give the same stack. So only orders are worth trying that give another DAG, hence other layers, and still the same
  outline in the end.
- **fold_line**: the line is shifted across its own direction, as little as possible.
- **split**: the far part of what moves is folded over first, along a line parallel to the fold's own. What is left to
  move is narrower and thicker, and ends in a straight crease, of which only the corners must be held.
- **halve**: the whole cloth is folded in half across the fold's own line first, so that the fold moves half the width.
- **size**: a smaller garment of the same shape, where nothing else helps: the largest that can be folded. A cloth that
  is too large for the arms, or has more rim than the hands can hold, is no dead end: people want to know how large it
  may be. The garment keeps its edge nearest to the robot's side of the table, where arms reach best.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import FOLDS_MAX, DrawnFold, Garment
from planner.errors import FieldError
from planner.explain.suggestion import Search, SuggestionTrial, each_cheaper, narrowed, proven
from planner.folds.fold import snapped_line
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import FloatArray, Point2, Pose2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from planner.message import Message
from planner.task.task import Task
from planner.words.catalogue import worded

SWAPS_MAX = 3
"""Swaps of neighbours between the user's order and an order that is tried, at most."""

ORDERS_MAX = 60
"""Orders that are looked at."""

Chain = tuple[int, ...]
"""A blue fold and the red folds that follow it, by their indices."""

STEPS_M = (0.1, 0.2)
"""Shifts of a line that are tried first (m)."""

NARROWED_TO_M = 0.0125
"""The resolution of the least shift (m)."""

_FAR_M = 20.0
"""Length by which a line is extended to cross any cloth (m)."""

_DECIMALS = 5
"""Decimals to which the ends of a line are rounded (m)."""

THINNEST_M = 0.04
"""Least width of either part of a fold that is split; narrower strips are not worth a fold of their own (m)."""

_SHARES = (0.5, 0.35, 0.65)
"""Shares of the moving part's depth at which a fold is split, besides the corners of the part."""

_CORNERS_MAX = 6
"""Corners of a moving part through which a fold is split."""

SIZES = (0.8, 0.6, 0.4, 0.25)
"""The sizes that are tried first, as shares of the garment's own."""

SIZE_STEP = 0.05
"""The resolution of the share."""


@each_cheaper
def flips(task: Task, folds: Sequence[int]) -> Iterator[SuggestionTrial]:
    """Yield trials in which one of some folds moves its other part; the others must be legal on the cloth then."""
    drawn = task.garment.folds
    for index in folds:
        flipped = replace(drawn[index], start=drawn[index].end, end=drawn[index].start)
        garment = replace(task.garment, folds=(*drawn[:index], flipped, *drawn[index + 1 :]))
        if _replayed(garment) is not None:
            says = worded("flip_fold", {"fold": index}, drawn)
            yield SuggestionTrial("flip", says, 1.0, task, replace(task, garment=garment))


@dataclass(frozen=True, slots=True)
class _Order:
    """An order of a garment's folds, in which chains of red folds stay whole.

    Attributes:
        chains: the folds, numbered as the user drew them.
        swaps: the number of swaps of neighbours from the user's order.
    """

    chains: tuple[Chain, ...]
    swaps: int

    @property
    def folds(self) -> tuple[int, ...]:
        return tuple(fold for chain in self.chains for fold in chain)

    def neighbours(self) -> Iterator["_Order"]:
        for i in range(len(self.chains) - 1):
            first, second = self.chains[i : i + 2]
            yield _Order((*self.chains[:i], second, first, *self.chains[i + 2 :]), self.swaps + 1)


@each_cheaper
def orders(task: Task) -> Iterator[SuggestionTrial]:
    """Yield trials of other orders, the fewest swaps first."""
    for order, garment in _other_orders(task.garment):
        says = _in_words(task.garment, order)
        yield SuggestionTrial("order", says, order.swaps, task, replace(task, garment=garment))


def _other_orders(garment: Garment) -> Iterator[tuple[_Order, Garment]]:
    """Yield legal orders with the same outline in the end, one for each other DAG."""
    sequence = FoldSequence.of(garment)
    wanted = sequence.final.silhouette
    seen_dags = {frozenset(sequence.dag.edges)}
    for order in _by_swaps(sequence.dag.chains):
        changed = replace(garment, folds=tuple(garment.folds[i] for i in order.folds))
        found = _replayed(changed)
        if found is None:
            continue
        edges = frozenset((order.folds[a], order.folds[b]) for a, b in found.dag.edges)
        if edges not in seen_dags and _is_same(wanted, found.final.silhouette):
            seen_dags.add(edges)
            yield order, changed


def _by_swaps(chains: Sequence[Chain]) -> Iterator[_Order]:
    """Yield orders by the number of swaps, without the user's own."""
    front = [_Order(tuple(chains), 0)]
    seen = {front[0].chains}
    while front and len(seen) <= ORDERS_MAX:
        order = front.pop(0)
        for other in order.neighbours():
            if other.chains not in seen and other.swaps <= SWAPS_MAX:
                seen.add(other.chains)
                front.append(other)
                yield other


def _replayed(garment: Garment) -> FoldSequence | None:
    try:
        return FoldSequence.of(garment)
    except FieldError:
        return None


def _is_same(one: Region, other: Region) -> bool:
    return one.difference(other).is_sliver and other.difference(one).is_sliver


def _in_words(garment: Garment, order: _Order) -> Message:
    turned = [(later, earlier) for later, earlier in combinations(order.folds, 2) if later > earlier]
    if len(turned) == 1:
        later, earlier = turned[0]
        return worded("fold_before", {"fold": later, "before": earlier}, garment.folds)
    return worded("fold_in_order", {"folds": list(order.folds)}, garment.folds)


def fold_lines(task: Task, folds: Sequence[int]) -> Search:
    """Look for the smallest shift of some folds, each alone and then all, first to the side where less cloth moves."""
    each = [_Shift(task, (fold,), sign) for fold in folds for sign in (1, -1)]
    sides = each + ([_Shift(task, tuple(folds), sign) for sign in (1, -1)] if len(folds) > 1 else [])
    for before_m, shift_m in zip((0.0, *STEPS_M), STEPS_M, strict=False):
        for side in tuple(sides):
            proof = yield from proven(side.shifted(shift_m))
            if proof is not None:
                sides.remove(side)
                yield from narrowed(side.shifted, before_m, shift_m, proof, NARROWED_TO_M)


@dataclass(frozen=True, slots=True)
class _Shift:
    """Folds, and the side to which their lines may be shifted: 1 is left of each, where less moves; -1 right."""

    task: Task
    folds: tuple[int, ...]
    sign: int

    def shifted(self, by_m: float) -> SuggestionTrial | None:
        """Return the trial of shifting all their lines by a distance (m); None where it is not legal."""
        garment: Garment | None = self.task.garment
        for fold in self.folds:
            garment = None if garment is None else redrawn(garment, fold, self._moved(garment.folds[fold], by_m))
        if garment is None:
            return None
        first, *others = says = [self._said(fold, by_m) for fold in self.folds]
        if others:
            first = worded("shift_folds", {"shifts": [one.to_dict() for one in says]}, self.task.garment.folds)
        return SuggestionTrial("fold_line", first, by_m, self.task, replace(self.task, garment=garment))

    def _moved(self, drawn: DrawnFold, by_m: float) -> Segment:
        return _beside(Segment(drawn.start, drawn.end), self.sign * by_m)

    def _said(self, fold: int, by_m: float) -> Message:
        """Return the message that says how to shift one of the folds."""
        drawn, placement = self.task.garment.folds[fold], self.task.start.placement
        left = np.array(Segment(drawn.start, drawn.end).left)
        x, y = placement.to_outer(self.sign * left) - placement.to_outer(np.zeros(2))
        values = {"fold": fold, "by_m": by_m, "towards": [float(x), float(y)]}
        return worded("shift_fold", values, self.task.garment.folds)


def _beside(line: Segment, by_m: float) -> Segment:
    """Return a line moved to its left by a distance (m)."""
    dx, dy = (by_m * part for part in line.left)
    (x0, y0), (x1, y1) = line.start, line.end
    return Segment((x0 + dx, y0 + dy), (x1 + dx, y1 + dy))


def redrawn(garment: Garment, fold: int, line: Segment) -> Garment | None:
    """Return the garment with a fold along another line; None if that fold, or a later fold, is then not legal.

    Later folds keep their lines; where an end no longer meets the edge of the cloth it moves along the line to the
    edge.
    """
    folds = garment.folds[:fold]
    try:
        for index in range(fold, len(garment.folds)):
            drawn = garment.folds[index]
            cloth = FoldSequence.of(replace(garment, folds=folds)).final
            silhouette = FOLD_KINDS[drawn.kind].silhouette(cloth)
            if index > fold and _is_snapped(drawn, silhouette):
                folds = (*folds, drawn)
                continue
            ends = chord(silhouette, line if index == fold else Segment(drawn.start, drawn.end))
            if ends is None:
                return None
            folds = (*folds, replace(drawn, start=ends.start, end=ends.end))
        changed = replace(garment, folds=folds)
        FoldSequence.of(changed)
    except FieldError:
        return None
    return changed


def chord(silhouette: Region, line: Segment) -> Segment | None:
    """Return the part of a line within a silhouette that overlaps most with the given segment (m, rounded).

    The line extends beyond the segment.
    """
    whole = Segment(line.at(-_FAR_M), line.at(line.length + _FAR_M))
    best, most_m = None, 0.0
    for ends in silhouette.overlaps_with(whole):
        low, high = sorted(line.positions(np.array(ends)))
        common_m = float(min(high, line.length) - max(low, 0.0))
        if common_m > most_m:
            best, most_m = (float(low), float(high)), common_m
    if best is None:
        return None
    (x0, y0), (x1, y1) = line.at(best[0]), line.at(best[1])
    return Segment((round(x0, _DECIMALS), round(y0, _DECIMALS)), (round(x1, _DECIMALS), round(y1, _DECIMALS)))


def _is_snapped(drawn: DrawnFold, silhouette: Region) -> bool:
    try:
        snapped_line(drawn, silhouette)
    except FieldError:
        return False
    return True


@each_cheaper
def splits(task: Task, folds: Sequence[int]) -> Iterator[SuggestionTrial]:
    """Yield trials in which one of some folds is done in two parts, the evenest parts first."""
    for fold, sequence in _blue_ones(task.garment, folds):
        line = sequence.folds[fold].line
        distances = line.left_distances(sequence.moving(fold).coordinates)
        deep_m = float(distances.max())
        for depth_m in _depths(distances, deep_m):
            says = worded("split_fold", {"fold": fold, "depth_m": deep_m - depth_m}, task.garment.folds)
            yield from _with_fold_before(task, fold, _beside(line, depth_m), "split", says)


def _depths(distances: FloatArray, deep_m: float) -> list[float]:
    """Return the distances from a fold's line at which to split it (m), the evenest first.

    Lines through corners of the moving part can take two corners that must be held off the far side at once.
    """
    corners = sorted({round(float(d), 3) for d in distances}, key=lambda d: abs(d - deep_m / 2))
    wanted = [share * deep_m for share in _SHARES] + corners[:_CORNERS_MAX]
    found: list[float] = []
    for depth_m in wanted:
        is_new = all(abs(depth_m - known) > THINNEST_M / 2 for known in found)
        if is_new and THINNEST_M <= depth_m <= deep_m - THINNEST_M:
            found.append(depth_m)
    return found


@each_cheaper
def halvings(task: Task, folds: Sequence[int]) -> Iterator[SuggestionTrial]:
    """Yield trials in which the cloth is halved across the line of one of some folds first."""
    for fold, sequence in _blue_ones(task.garment, folds):
        line = sequence.folds[fold].line
        silhouette = sequence.cloth((1 << fold) - 1).silhouette.coordinates
        along = line.positions(silhouette)
        x, y = line.at(float(along.min() + along.max()) / 2)
        reach_m = float(np.abs(line.left_distances(silhouette)).max()) + LENGTH_M
        left = reach_m * np.array(line.left)
        for sign in (1, -1):
            dx, dy = sign * left
            across = Segment((x - dx, y - dy), (x + dx, y + dy))
            says = worded("halve_first", {"fold": fold}, task.garment.folds)
            yield from _with_fold_before(task, fold, across, "halve", says)


def _blue_ones(garment: Garment, folds: Sequence[int]) -> Iterator[tuple[int, FoldSequence]]:
    sequence = FoldSequence.of(garment)
    yield from ((fold, sequence) for fold in folds if not garment.folds[fold].is_red)


def _with_fold_before(task: Task, fold: int, line: Segment, kind: str, says: Message) -> Iterator[SuggestionTrial]:
    garment = with_fold_before(task.garment, fold, line)
    if garment is not None:
        yield SuggestionTrial(kind, says, 1.0, task, replace(task, garment=garment))


def with_fold_before(garment: Garment, fold: int, line: Segment) -> Garment | None:
    """Return the garment with one more blue fold before another; None where that, or a later fold, is not legal.

    The new fold has no name. Later folds keep their lines; where an end no longer meets the edge of the cloth it moves
    along the line to the edge.
    """
    if len(garment.folds) >= FOLDS_MAX:
        return None
    added = DrawnFold("", "blue", line.start, line.end, garment.folds[fold].grip_radius_m)
    try:
        changed = replace(garment, folds=(*garment.folds[:fold], added, *garment.folds[fold:]))
    except FieldError:
        return None
    return redrawn(changed, fold, line)


def sizes(task: Task) -> Search:
    """Look for a size with which there is a plan, and then for the largest one."""
    if task.start.folds_done:
        return
    too_large = 1.0
    for share in SIZES:
        proof = yield from proven(_smaller(task, share))
        if proof is not None:
            yield from narrowed(lambda by: _smaller(task, 1.0 - by), 1.0 - too_large, 1.0 - share, proof, SIZE_STEP)
            return
        too_large = share


def _smaller(task: Task, share: float) -> SuggestionTrial | None:
    """Return the trial with all lengths of the garment multiplied by a share; None if that gives no valid garment."""
    try:
        garment = _scaled(task.garment, share)
    except FieldError:
        return None
    placement = _kept_near(task, garment)
    width, height = np.ptp(np.array(garment.outline), axis=0).tolist()
    says = worded("smaller", {"by": round(1.0 - share, 6), "size_m": [width, height]})
    return SuggestionTrial("size", says, 1.0 - share, task, replace(task, garment=garment).at(placement))


def _scaled(garment: Garment, share: float) -> Garment:
    def point(at: Point2) -> Point2:
        return (share * at[0], share * at[1])

    folds = tuple(replace(fold, start=point(fold.start), end=point(fold.end)) for fold in garment.folds)
    return replace(garment, outline=tuple(point(at) for at in garment.outline), folds=folds)


def _kept_near(task: Task, garment: Garment) -> Pose2:
    """Return the placement that keeps the garment's near side, and its middle, where they are in the task."""
    before = task.start.placement
    old, new = (before.to_outer(np.array(one.outline)) for one in (task.garment, garment))
    dx = old[:, 0].min() - new[:, 0].min()
    dy = (old[:, 1].min() + old[:, 1].max() - new[:, 1].min() - new[:, 1].max()) / 2
    return before.moved(float(dx), float(dy))
