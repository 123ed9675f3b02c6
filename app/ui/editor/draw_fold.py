"""The tool `Draw fold`: a line dragged across the cloth, as it lies after all folds so far.

The cloth to the left of the line, seen along the drag, moves. An end released near the boundary snaps to it; any other
end slides along the line to where the line leaves the cloth.
"""

import math
from dataclasses import dataclass, replace

from app.document_state import DocumentState
from app.drawing.drawing import Crease, Drawing, fresh_ids
from app.drawing.place_crease import PlacedCrease, along_line, refuse_too_many
from app.drawing.rules import DRAW_FOLD, NO_CLOTH, STROKE_MIN_M, as_sentence, fold_name, snapped
from app.drawing.solution import landed_rings
from app.language import say, translated
from app.ui.editor.aids import Aids, Ghost, Pile, closed
from app.ui.editor.aim import Aim
from app.ui.editor.document_writer import DocumentWriter
from app.ui.editor.drawing_messages import localized
from app.ui.editor.ground import Ground, in_article, on_table
from app.ui.editor.mode import FoldKind
from app.ui.editor.refusal import RefusedError
from app.ui.editor.tool import Tool
from planner.cloth.garment import FIRST_IS_RED
from planner.folds.fold_cloth import flap_silhouette
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment


@dataclass(frozen=True, slots=True)
class _Stroke:
    """A line that is being drawn.

    Attributes:
        start: where it began, table frame (m).
        end: where the pointer is.
        ground: where it may end.
    """

    start: Point2
    end: Point2
    ground: Ground


class DrawFold(Tool):
    """A drag, or a click at each end.

    Attributes:
        kind: the kind of fold drawn.
    """

    def __init__(self, writer: DocumentWriter) -> None:
        """Take the writer that writes into the document."""
        self.kind = FoldKind.BLUE
        self._writer = writer
        self._stroke: _Stroke | None = None
        self._found: PlacedCrease | None = None

    def hint(self) -> str:
        """Return what to do now."""
        if self._stroke is not None:
            return say(self._writer.state.language, "view3d.line_to_edge")
        if len(self._writer.state.solution.cloths) > 1:
            return say(self._writer.state.language, "view3d.line_folded")
        return say(self._writer.state.language, "view3d.line_flat")

    def press(self, aim: Aim) -> None:
        """Begin a line."""
        state = self._writer.state
        start = _snapped(state, aim, self._seen(state))
        self._stroke = _Stroke(start, start, Ground.of(state.drawing))

    def drag(self, aim: Aim | None) -> None:
        """Draw the line up to the pointer."""
        if self._stroke is None or aim is None:
            return
        state = self._writer.state
        self._found, self._stroke = None, replace(self._stroke, end=_snapped(state, aim, self._seen(state)))
        self._found = self._placed(state, self._stroke)

    def release(self, aim: Aim | None) -> None:
        """Make the fold, as one step."""
        stroke = self._stroke
        if stroke is None:
            return
        self.put_down()
        if aim is None or not stroke.ground.holds(aim.point):
            raise RefusedError(say(self._writer.state.language, "rule.off_table_no_fold"))
        state = self._writer.state
        drawn = replace(stroke, end=_snapped(state, aim, self._seen(state)))
        self._writer.commit(DRAW_FOLD, lambda now: self._folded(now, drawn))

    def tap(self, aim: Aim) -> None:
        """Begin a line, or end it."""
        if self._stroke is None:
            self.press(aim)
        else:
            self.release(aim)

    def last(self) -> str | None:
        """Return the label of the line that has been begun."""
        return say(self._writer.state.language, "view3d.line") if self._stroke is not None else None

    def put_down(self) -> None:
        """Drop the line that has been begun."""
        self._stroke = self._found = None

    def aids(self, state: DocumentState) -> Aids:
        """Return where lines may begin, the folded cloth, and the line."""
        if not state.solution.cloths:
            return Aids()
        cloth, drawing = state.solution.cloths[-1], state.drawing
        seen = flap_silhouette(cloth, is_red=self._is_red)
        lines = tuple(closed(on_table(drawing, ring.tolist())) for ring in seen.rings)
        pile = Pile(cloth, drawing.placement) if len(state.solution.cloths) > 1 else None
        return Aids(lines=lines, pile=pile, ghost=self._ghost(drawing))

    @property
    def _is_red(self) -> bool:
        return self.kind is FoldKind.RED

    def _seen(self, state: DocumentState) -> Region:
        """Return the region that folds of this kind see, article frame."""
        solution = state.solution
        if not solution.cloths:
            raise RefusedError(translated(state.language, as_sentence(NO_CLOTH)))
        legal = len(solution.cloths) - 1
        if legal < len(state.drawing.folds):
            problems = (problem for problem in solution.problems if problem.fold == legal)
            told = (localized(state.language, problem.says, problem.message) for problem in problems)
            why = next(told, say(state.language, "view3d.not_legal"))
            name = translated(state.language, state.drawing.folds[legal].name)
            raise RefusedError(
                as_sentence(say(state.language, "view3d.fix_first", number=legal + 1, name=name, why=why))
            )
        refuse_too_many(solution)
        if self._is_red and legal == 0:
            raise RefusedError(translated(state.language, as_sentence(FIRST_IS_RED)))
        return flap_silhouette(solution.cloths[-1], is_red=self._is_red)

    def _placed(self, state: DocumentState, stroke: _Stroke) -> PlacedCrease:
        start, end = (in_article(state.drawing, point) for point in (stroke.start, stroke.end))
        if math.dist(start, end) < STROKE_MIN_M:
            raise RefusedError(say(self._writer.state.language, "rule.drag_on"))
        return along_line(state.solution, None, Segment(start, end), is_red=self._is_red)

    def _folded(self, state: DocumentState, stroke: _Stroke) -> Drawing:
        self._seen(state)
        placed, folds = self._placed(state, stroke), state.drawing.folds
        (name,) = fresh_ids("f", (fold.id for fold in folds), 1)
        kind = "red" if self._is_red else "blue"
        crease = Crease(
            name, fold_name(placed.line.direction, {fold.name for fold in folds}), kind, placed.start, placed.end
        )
        return replace(state.drawing, folds=(*folds, crease))

    def _ghost(self, drawing: Drawing) -> Ghost | None:
        stroke, found = self._stroke, self._found
        if stroke is None or stroke.start == stroke.end:
            return None
        if found is None:
            return Ghost(Segment(stroke.start, stroke.end), self._is_red)
        start, end = on_table(drawing, (found.line.start, found.line.end))
        landed = landed_rings(found.folded.moving, found.line)
        rings = tuple(on_table(drawing, [(x, y) for x, y in ring]) for ring in landed)
        return Ghost(Segment(start, end), self._is_red, rings)


def _snapped(state: DocumentState, aim: Aim, seen: Region) -> Point2:
    """Return the place of the cloth that the pointer means, or the pointer's own; table frame (m)."""
    point = in_article(state.drawing, aim.point)
    place = snapped(seen, point, aim.pixel_m)
    return aim.point if place == point else on_table(state.drawing, [place])[0]
