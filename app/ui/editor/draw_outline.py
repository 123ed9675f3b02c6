"""The tool `Draw outline`: corner after corner on the table, closed at the first; it replaces the old outline."""

from dataclasses import replace
from typing import Final

from app.document_state import DocumentState
from app.drawing.drawing import Corner, Drawing
from app.drawing.outline_problems import outline_problems
from app.drawing.ring import straight_ring
from app.drawing.rules import (
    CORNER_TAKEN,
    DRAW_OUTLINE,
    LEAST_CORNERS,
    TOO_MANY_CORNERS,
    as_sentence,
    next_corner,
    snapped_corner,
)
from app.language import say, translated
from app.ui.editor.aids import Aids
from app.ui.editor.aim import Aim
from app.ui.editor.document_writer import DocumentWriter
from app.ui.editor.drawing_messages import localized
from app.ui.editor.ground import Ground, in_article
from app.ui.editor.refusal import RefusedError
from app.ui.editor.tool import Tool
from planner.geometry.pose import Point2

_REFUSALS: Final = {"taken": CORNER_TAKEN, "full": TOO_MANY_CORNERS}


class DrawOutline(Tool):
    """Draws an outline, whose corners stay in the table frame until it is closed."""

    def __init__(self, writer: DocumentWriter) -> None:
        """Take the writer that writes into the document."""
        self._writer = writer
        self._points: tuple[Point2, ...] = ()
        self._is_closed = False

    def hint(self) -> str:
        """Return what to do now."""
        count = len(self._points)
        if count == 0 and self._is_closed:
            return say(self._writer.state.language, "view3d.outline_closed")
        if count == 0:
            return say(self._writer.state.language, "view3d.outline_begin")
        if count < LEAST_CORNERS:
            return say(self._writer.state.language, "view3d.outline_count", number=count, least=LEAST_CORNERS)
        return say(self._writer.state.language, "view3d.outline_close")

    def press(self, aim: Aim) -> None:
        """Do nothing: a corner is put where the pointer is released."""

    def drag(self, aim: Aim | None) -> None:
        """Do nothing."""

    def release(self, aim: Aim | None) -> None:
        """Treat a drag that hardly moved as a click."""
        if aim is None:
            raise RefusedError(say(self._writer.state.language, "rule.off_table"))
        self.tap(aim)

    def tap(self, aim: Aim) -> None:
        """Put a corner here, or close the outline."""
        if not Ground.of(self._writer.state.drawing).holds(aim.point):
            raise RefusedError(say(self._writer.state.language, "rule.off_table"))
        place = snapped_corner(self._points, aim.point, aim.pixel_m)
        becomes = next_corner(self._points, place)
        if becomes == "close":
            self._close()
        elif becomes == "put":
            self._points = (*self._points, place)
        else:
            raise RefusedError(translated(self._writer.state.language, as_sentence(_REFUSALS[becomes])))

    def last(self) -> str | None:
        """Return the label of the last corner."""
        return say(self._writer.state.language, "part.corner", number=len(self._points)) if self._points else None

    def take_back(self) -> None:
        """Remove the last corner."""
        self._points = self._points[:-1]

    def put_down(self) -> None:
        """Forget the corners."""
        self._points = ()
        self._is_closed = False

    def aids(self, state: DocumentState) -> Aids:
        """Return the corners so far, and the edges between them."""
        chosen = 0 if len(self._points) >= LEAST_CORNERS else None
        return Aids(self._points, chosen=chosen, lines=(self._points,))

    def _close(self) -> None:
        def change(state: DocumentState) -> Drawing:
            points = [in_article(state.drawing, point) for point in self._points]
            for problem in outline_problems(straight_ring(points)):
                raise RefusedError(as_sentence(localized(state.language, problem.says, problem.message)))
            corners = tuple(Corner(f"v{i}", point) for i, point in enumerate(points))
            return replace(state.drawing, outline=corners, folds=())

        self._writer.commit(DRAW_OUTLINE, change)
        self._points = ()
        self._is_closed = True
