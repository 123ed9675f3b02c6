"""Places a new fold, given a point of the cloth and its target, or a line drawn anywhere.

Folding over the perpendicular bisector of two points takes one to the other. The bisector may cross the cloth several
times. Of the chords that separate the point from its target, the fold takes the one nearest to the middle between them.
"""

import math
from dataclasses import dataclass
from typing import Any, Final

from app.drawing.drawing import ChordTie, End, Tie
from app.drawing.drawing_json import end_to_dict
from app.drawing.solution import Solution, landed_rings, rings
from app.drawing.ties import Names
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import FIRST_IS_RED, FOLDS_MAX
from planner.cloth.outline import EDGE_MIN_M
from planner.errors import FoldError, RequestError
from planner.folds.attachment import Replay, attached
from planner.folds.fold_cloth import Folded, fold_cloth
from planner.folds.missed_flap import flap_missed, is_flap_missed
from planner.geometry.chord import chords, nearest_chord
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.split import split_along
from planner.geometry.tolerance import LENGTH_M
from planner.message import Message

NO_CLOTH: Final = "there is no cloth yet: draw an outline first"


@dataclass(frozen=True)
class PlacedCrease:
    """A legal fold that is not in the drawing yet.

    Attributes:
        start: its first end; the cloth to the left of start -> end moves.
        end: its second end.
        line: the segment from start to end, garment frame.
        folded: the result of folding.
    """

    start: End
    end: End
    line: Segment
    folded: Folded

    def to_dict(self) -> dict[str, Any]:
        """Return as JSON the fold's ends as in a drawing, the moving cloth and where it lands."""
        moving = self.folded.moving
        return {
            "start": end_to_dict(self.start),
            "end": end_to_dict(self.end),
            "moving": rings(moving),
            "landed": landed_rings(moving, self.line),
        }


def grab_and_drop(solution: Solution, after: int | None, grabbed: Point2, dropped: Point2, kind: str) -> PlacedCrease:
    """Return the fold that takes a point of the cloth to another place.

    Args:
        solution: the solved drawing.
        after: the number of its folds done before; None for all.
        grabbed: the point, garment frame, on the cloth after those folds (m).
        dropped: its target (m).
        kind: the fold's kind.

    Raises:
        RequestError: there is no such fold; the field is one of ``after``, ``grab.from``, ``grab.to``.
    """
    replay = _replay(solution, after)
    silhouette = _seen(replay, kind)
    apart = math.dist(grabbed, dropped)
    if apart < EDGE_MIN_M:
        text = f"is {apart * 1000:.3f} mm from where the cloth is grabbed, less than {EDGE_MIN_M * 1000:g} mm"
        raise RequestError("grab.to", Message("dropped_too_near", text, {"apart_m": apart, "least_m": EDGE_MIN_M}))
    if not _is_on(silhouette, grabbed):
        place = f"({grabbed[0]:.4f}, {grabbed[1]:.4f}) m"
        if _is_on(replay.cloths[-1].silhouette, grabbed):
            text = f"{place} is on cloth that a red fold leaves where it is"
            raise RequestError("grab.from", Message("not_on_flap", text, {"at": list(grabbed)}))
        text = f"there is no cloth at {place}"
        raise RequestError("grab.from", Message("no_cloth_there", text, {"at": list(grabbed)}))
    bisector = _bisector(grabbed, dropped)
    is_whole, nearest = FOLD_KINDS[kind].is_whole, FOLD_KINDS[kind].nearest
    line = nearest(silhouette, bisector) if is_whole else _parting_chord(silhouette, bisector, grabbed)
    if line is None:
        raise RequestError("grab.to", "no straight fold through the cloth takes the point there")
    return _placed(solution, replay, line, "grab.to", kind)


def along_line(solution: Solution, after: int | None, guide: Segment, kind: str) -> PlacedCrease:
    """Return the fold along a line, its ends at the points of the cloth's boundary nearest to the line's ends.

    Raises:
        RequestError: there is no such fold; the field is ``after`` or ``line``.
    """
    replay = _replay(solution, after)
    line = FOLD_KINDS[kind].nearest(_seen(replay, kind), guide)
    if line is None:
        whole = nearest_chord(replay.cloths[-1].silhouette, guide)
        if whole is None or not is_flap_missed(replay.cloths[-1], whole):
            raise RequestError("line", Message("line_misses_cloth", "does not cross the cloth"))
        raise RequestError("line", flap_missed(_last_name(solution, replay)))
    return _placed(solution, replay, line, "line", kind)


def _replay(solution: Solution, after: int | None) -> Replay:
    refuse_too_many(solution)
    if solution.replay is None:
        raise RequestError("after", NO_CLOTH)
    count = len(solution.drawing.folds) if after is None else after
    legal = len(solution.replay.lines)
    if count > legal:
        text = f"is {count}, but only {legal} folds are drawn and legal"
        raise RequestError("after", Message("fewer_folds", text, {"asked": count, "legal": legal}))
    return Replay(solution.replay.outline, solution.replay.cloths[: count + 1], solution.replay.lines[:count])


def refuse_too_many(solution: Solution) -> None:
    """Raise `RequestError` where no more folds may be drawn."""
    if len(solution.drawing.folds) >= FOLDS_MAX:
        text = f"there are {FOLDS_MAX} folds already, and there may be no more"
        raise RequestError("after", Message("folds_full", text, {"most": FOLDS_MAX}))


def _seen(replay: Replay, kind: str) -> Region:
    if FOLD_KINDS[kind].is_red and not replay.lines:
        raise RequestError("kind", FIRST_IS_RED)
    return FOLD_KINDS[kind].silhouette(replay.cloths[-1])


def _last_name(solution: Solution, replay: Replay) -> str:
    """Return the user's name for the last fold done."""
    return solution.drawing.folds[len(replay.lines) - 1].name


def _is_on(region: Region, point: Point2) -> bool:
    return region.contains(point) or region.boundary_distance(point) <= LENGTH_M


def _bisector(grabbed: Point2, dropped: Point2) -> Segment:
    """Return the perpendicular bisector of two points, from the middle between them, the first point on its left."""
    (px, py), (qx, qy) = grabbed, dropped
    middle = ((px + qx) / 2, (py + qy) / 2)
    return Segment(middle, (middle[0] + (py - qy), middle[1] - (px - qx)))


def _parting_chord(silhouette: Region, bisector: Segment, grabbed: Point2) -> Segment | None:
    """Return the chord on a bisector, nearest to its start, that has the grabbed point on its left, or None."""
    for chord in sorted(chords(silhouette, bisector), key=lambda chord: _distance(chord, bisector)):
        parts = split_along(silhouette, chord)
        if parts is not None and _is_on(parts[0], grabbed) and not parts[1].is_sliver:
            return chord
    return None


def _distance(chord: Segment, bisector: Segment) -> float:
    """Return the distance from a chord of the bisector to the bisector's start (m)."""
    low, high = (math.dist(bisector.start, end) for end in (chord.start, chord.end))
    return 0.0 if abs(low + high - chord.length) <= LENGTH_M else min(low, high)


def _placed(solution: Solution, replay: Replay, line: Segment, field: str, kind: str) -> PlacedCrease:
    crease = replay.lines[-1] if FOLD_KINDS[kind].is_red else None
    try:
        folded = fold_cloth(replay.cloths[-1], line, kind, crease)
    except FoldError as error:
        raise RequestError(field, error.says or error.message) from None
    names = Names.of(solution.drawing)
    start, end = (End(point, _tie(point, replay, names, kind)) for point in (line.start, line.end))
    return PlacedCrease(start, end, line, folded)


def _tie(point: Point2, replay: Replay, names: Names, kind: str) -> Tie:
    attachment = attached(point, replay, kind)
    return ChordTie() if attachment is None else names.tie(attachment)
