"""Finds a fold's line on the cloth as the fold finds it, from the ties of its ends.

An end just drawn snaps to the boundary if it is near enough, as in the planner. A tied end goes where its tie takes it,
usually to the boundary. If more cloth now lies beyond that place, or none is left there, the fold keeps its line and
the end slides along it to the nearest point of the boundary. Both ends do so if folding has brought their ties to the
same place.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from app.drawing.drawing import ChordTie, Crease, End, Tie
from app.drawing.problem import Problem
from app.drawing.ties import Names
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import DrawnFold
from planner.errors import FoldError, GarmentError
from planner.folds.attachment import Replay, attached, place_of
from planner.folds.fold import snapped_line
from planner.folds.fold_cloth import Folded, fold_cloth
from planner.folds.missed_flap import flap_missed, is_flap_missed
from planner.geometry.chord import nearest_chord
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M, SNAP_M


@dataclass(frozen=True)
class FoundLine:
    """A legal fold and its line.

    Attributes:
        crease: the fold with its current ends and ties.
        line: its line, garment frame.
        folded: the result of folding.
    """

    crease: Crease
    line: Segment
    folded: Folded


@dataclass(frozen=True, slots=True)
class _Place:
    """The intended position of an end.

    Attributes:
        end: the end.
        point: the position that its tie gives, or its previous position.
        is_held: whether the tie gave the position.
        is_free: whether the end may slide along the line; true unless it was just drawn.
    """

    end: End
    point: Point2
    is_held: bool
    is_free: bool

    def is_on(self, silhouette: Region) -> bool:
        """Return whether the position is on the boundary, so that the end need not slide."""
        return silhouette.boundary_distance(self.point) <= 2 * LENGTH_M


def find_line(crease: Crease, index: int, replay: Replay, names: Names, radius_m: float) -> FoundLine | Problem:
    """Return the fold's line after the previous folds, or the problem that prevents it.

    Args:
        crease: the fold as drawn.
        index: its place in the order.
        replay: the previous folds, all legal.
        names: the ids of corners and folds.
        radius_m: the fold's grip radius (m).
    """
    places = tuple(_place(end, replay, names, crease.kind) for end in crease.ends)
    if math.dist(places[0].point, places[1].point) <= LENGTH_M:
        places = tuple(_Place(end, end.point, is_held=False, is_free=end.tie is not None) for end in crease.ends)
    first: Problem | None = None
    for start, end in _candidates(places[0], places[1], replay, crease.kind):
        found = _tried(crease, (start, end), index, replay, names, radius_m)
        if not isinstance(found, Problem):
            line, folded = found
            return FoundLine(_settled(crease, places, line, replay, names), line, folded)
        first = first or found
    assert first is not None
    return first


def _place(end: End, replay: Replay, names: Names, kind: str) -> _Place:
    attachment = names.attachment(end.tie)
    place = None if attachment is None else place_of(attachment, replay, kind)
    return _Place(end, place or end.point, place is not None, end.tie is not None)


def _candidates(start: _Place, end: _Place, replay: Replay, kind: str) -> Iterator[tuple[Point2, Point2]]:
    """Yield the lines to try, the intended one first."""
    silhouette = FOLD_KINDS[kind].silhouette(replay.cloths[-1])
    slides = [place.is_free and not place.is_on(silhouette) for place in (start, end)]
    if any(slides):
        yield from _slid((start, end), slides, silhouette)
    yield (start.point, end.point)
    yield from _slid((start, end), [start.is_free, end.is_free], silhouette)


def _slid(places: Sequence[_Place], slides: Sequence[bool], silhouette: Region) -> Iterator[tuple[Point2, Point2]]:
    """Yield the line whose sliding ends have moved to where it meets the boundary, if it does."""
    start, end = (place.point for place in places)
    chord = nearest_chord(silhouette, Segment(start, end)) if any(slides) and start != end else None
    if chord is not None:
        yield (chord.start if slides[0] else start, chord.end if slides[1] else end)


def _tried(
    crease: Crease, ends: tuple[Point2, Point2], index: int, replay: Replay, names: Names, radius_m: float
) -> tuple[Segment, Folded] | Problem:
    silhouette = FOLD_KINDS[crease.kind].silhouette(replay.cloths[-1])
    lines = (Segment(*ends),) if ends[0] != ends[1] else ()
    off = tuple(point for point in ends if silhouette.boundary_distance(point) > SNAP_M)
    try:
        drawn = DrawnFold(crease.name, crease.kind, *ends, radius_m)
        if crease.is_red and is_flap_missed(replay.cloths[-1], Segment(*ends)):
            raise FoldError("start", flap_missed(names.titles[index - 1]))
        snapped = snapped_line(drawn, silhouette)
        line = Segment(_kept(crease.start.point, snapped.start), _kept(crease.end.point, snapped.end))
        before = replay.lines[-1] if crease.is_red else None
        return line, fold_cloth(replay.cloths[-1], line, crease.kind, before)
    except (FoldError, GarmentError) as error:
        code = "fold_off_boundary" if off else "fold_illegal"
        field = error.within(f"folds[{index}]").field
        return Problem(code, field, error.message, index, off or ends, lines, error.says)


def _settled(crease: Crease, places: tuple[_Place, ...], line: Segment, replay: Replay, names: Names) -> Crease:
    """Return the fold moved to its line.

    An end that has slid keeps the tie it slid from. The exception is when the line could not be found again from there,
    because the other end, which has no hold, has slid as well.
    """
    ends = (line.start, line.end)
    slid = [place for place, end in zip(places, ends, strict=True) if math.dist(place.point, end) > LENGTH_M]
    if not all(place.is_held for place in slid):
        places = tuple(replace(place, is_held=place.is_held and place not in slid) for place in places)
    start, end = (
        End(end, _settled_tie(place, end, replay, names, crease.kind)) for place, end in zip(places, ends, strict=True)
    )
    return replace(crease, start=start, end=end)


def _kept(before: Point2, now: Point2) -> Point2:
    """Return an end's previous position if the new one equals it within tolerance: rounding must not move it."""
    return before if math.dist(before, now) <= LENGTH_M else now


def _settled_tie(place: _Place, point: Point2, replay: Replay, names: Names, kind: str) -> Tie:
    """Return the new tie of an end: its previous tie if that still exists, otherwise one found at its position."""
    if isinstance(place.end.tie, ChordTie):
        return place.end.tie
    if place.is_held and place.end.tie is not None:
        if names.is_current(place.end.tie):
            return place.end.tie  # along a curve, a tie made anew would differ in its last digit
        attachment = names.attachment(place.end.tie)
    else:
        attachment = attached(point, replay, kind)
    return ChordTie() if attachment is None else names.tie(attachment)
