"""Finds a fold's line on the cloth as it is when its turn comes, from what its ends are tied to.

An end just drawn is put onto the boundary when it is near enough, as the planner does. An end that is tied goes where
its tie takes it. Mostly that is on the boundary. When it is not, because cloth now lies beyond it or there is
none left, the line is kept, and the end slides along it to the nearest place on the boundary. The same holds for both
ends where folding has brought what they are tied to together.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from app.drawing.drawing import ChordTie, Crease, End, Tie
from app.drawing.problem import Problem
from app.drawing.ties import Names
from planner.cloth.garment import DrawnFold
from planner.errors import FoldError, GarmentError
from planner.folds.attachment import Replay, attached, place_of
from planner.folds.fold import snapped_line
from planner.folds.fold_cloth import Folded, flap_silhouette, fold_cloth
from planner.folds.missed_flap import flap_missed, is_flap_missed
from planner.geometry.chord import nearest_chord
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M, SNAP_M


@dataclass(frozen=True)
class FoundLine:
    """A fold that is legal where it was found.

    Attributes:
        crease: the fold with its ends where they are now, and what they are tied to.
        line: its line, article frame.
        folded: the fold done.
    """

    crease: Crease
    line: Segment
    folded: Folded


@dataclass(frozen=True, slots=True)
class _Place:
    """Where an end should be.

    Attributes:
        end: the end.
        point: where its tie takes it, or where it was.
        is_held: whether a tie took it there.
        is_free: whether it may slide along the line: all ends but those just drawn.
    """

    end: End
    point: Point2
    is_held: bool
    is_free: bool

    def is_on(self, silhouette: Region) -> bool:
        """Whether it needs no help."""
        return silhouette.boundary_distance(self.point) <= 2 * LENGTH_M


def find_line(crease: Crease, index: int, replay: Replay, names: Names, radius_m: float) -> FoundLine | Problem:
    """The fold's line after the folds so far, or why there is none.

    Args:
        crease: the fold as it is drawn.
        index: its place in the order.
        replay: the folds before it, all legal.
        names: what corners and folds are called.
        radius_m: its grip radius (m).
    """
    places = tuple(_place(end, replay, names, is_red=crease.is_red) for end in crease.ends)
    if math.dist(places[0].point, places[1].point) <= LENGTH_M:
        places = tuple(_Place(end, end.point, is_held=False, is_free=end.tie is not None) for end in crease.ends)
    first: Problem | None = None
    for start, end in _candidates(places[0], places[1], replay, is_red=crease.is_red):
        found = _tried(crease, (start, end), index, replay, names, radius_m)
        if not isinstance(found, Problem):
            line, folded = found
            return FoundLine(_settled(crease, places, line, replay, names), line, folded)
        first = first or found
    assert first is not None
    return first


def _place(end: End, replay: Replay, names: Names, *, is_red: bool) -> _Place:
    attachment = names.attachment(end.tie)
    place = None if attachment is None else place_of(attachment, replay, is_red=is_red)
    return _Place(end, place or end.point, place is not None, end.tie is not None)


def _candidates(start: _Place, end: _Place, replay: Replay, *, is_red: bool) -> Iterator[tuple[Point2, Point2]]:
    """Lines to be tried, the one that is meant first."""
    silhouette = flap_silhouette(replay.cloths[-1], is_red=is_red)
    slides = [place.is_free and not place.is_on(silhouette) for place in (start, end)]
    if any(slides):
        yield from _slid((start, end), slides, silhouette)
    yield (start.point, end.point)
    yield from _slid((start, end), [start.is_free, end.is_free], silhouette)


def _slid(places: Sequence[_Place], slides: Sequence[bool], silhouette: Region) -> Iterator[tuple[Point2, Point2]]:
    """The line with those ends that slide where it meets the boundary."""
    start, end = (place.point for place in places)
    chord = nearest_chord(silhouette, Segment(start, end)) if any(slides) and start != end else None
    if chord is not None:
        yield (chord.start if slides[0] else start, chord.end if slides[1] else end)


def _tried(
    crease: Crease, ends: tuple[Point2, Point2], index: int, replay: Replay, names: Names, radius_m: float
) -> tuple[Segment, Folded] | Problem:
    silhouette = flap_silhouette(replay.cloths[-1], is_red=crease.is_red)
    lines = (Segment(*ends),) if ends[0] != ends[1] else ()
    off = tuple(point for point in ends if silhouette.boundary_distance(point) > SNAP_M)
    try:
        drawn = DrawnFold(crease.name, crease.kind, *ends, radius_m)
        if crease.is_red and is_flap_missed(replay.cloths[-1], Segment(*ends)):
            raise FoldError("start", flap_missed(names.titles[index - 1]))
        snapped = snapped_line(drawn, silhouette)
        line = Segment(_kept(crease.start.point, snapped.start), _kept(crease.end.point, snapped.end))
        before = replay.lines[-1] if crease.is_red else None
        return line, fold_cloth(replay.cloths[-1], line, is_red=crease.is_red, crease=before)
    except (FoldError, GarmentError) as error:
        code = "fold_off_boundary" if off else "fold_illegal"
        field = error.within(f"folds[{index}]").field
        return Problem(code, field, error.message, index, off or ends, lines, error.says)


def _settled(crease: Crease, places: tuple[_Place, ...], line: Segment, replay: Replay, names: Names) -> Crease:
    """The fold where its line is.

    An end that has slid stays tied to the place it slid from, unless the line cannot be found again from there: the
    other end, which nothing held, has slid as well.
    """
    ends = (line.start, line.end)
    slid = [place for place, end in zip(places, ends, strict=True) if math.dist(place.point, end) > LENGTH_M]
    if not all(place.is_held for place in slid):
        places = tuple(replace(place, is_held=place.is_held and place not in slid) for place in places)
    start, end = (
        End(end, _settled_tie(place, end, replay, names, is_red=crease.is_red))
        for place, end in zip(places, ends, strict=True)
    )
    return replace(crease, start=start, end=end)


def _kept(before: Point2, now: Point2) -> Point2:
    """Where an end is now, unless it is where it was: rounding shall not move what nobody has moved."""
    return before if math.dist(before, now) <= LENGTH_M else now


def _settled_tie(place: _Place, point: Point2, replay: Replay, names: Names, *, is_red: bool) -> Tie:
    """What an end is tied to from now on: what it was tied to, if that is there, or what is found where it is."""
    if isinstance(place.end.tie, ChordTie):
        return place.end.tie
    if place.is_held and place.end.tie is not None:
        attachment = names.attachment(place.end.tie)
    else:
        attachment = attached(point, replay, is_red=is_red)
    return ChordTie() if attachment is None else names.tie(attachment)
