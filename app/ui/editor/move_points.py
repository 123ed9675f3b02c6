"""The tool `Move points`: a corner of the outline follows the pointer, and cloth and plan follow the corner."""

import math
from dataclasses import dataclass, replace

from app.document_state import DocumentState
from app.drawing.drawing import Drawing
from app.drawing.ring import ring_of
from app.drawing.rules import FINGER_PX, MOVE_CORNER
from app.language import say
from app.ui.editor.aids import Aids, closed
from app.ui.editor.aim import Aim
from app.ui.editor.ground import Ground, in_article, on_table
from app.ui.editor.pencil import Change, Pencil
from app.ui.editor.refusal import RefusedError
from app.ui.editor.tool import Tool
from planner.geometry.pose import Point2


@dataclass(frozen=True, slots=True)
class _Grip:
    """A corner that is held.

    Attributes:
        corner: its name.
        offset: from the pointer to the corner when it was grabbed, table frame (m).
        ground: where it may be put down.
    """

    corner: str
    offset: Point2
    ground: Ground

    def place(self, aim: Aim) -> Point2:
        """Return where the corner is now (m)."""
        return (aim.point[0] + self.offset[0], aim.point[1] + self.offset[1])


class MovePoints(Tool):
    """Moves the handle nearest to the pointer."""

    def __init__(self, pencil: Pencil) -> None:
        """Take the pencil that writes into the document."""
        self._pencil = pencil
        self._grip: _Grip | None = None

    def hint(self) -> str:
        """Return what to do now."""
        if self._grip is not None:
            return say(self._pencil.state.language, "stage.let_go")
        if not self._pencil.state.drawing.outline:
            return say(self._pencil.state.language, "stage.no_outline")
        is_curved = any(corner.curve is not None for corner in self._pencil.state.drawing.outline)
        return say(self._pencil.state.language, "stage.drag_corner.curved" if is_curved else "stage.drag_corner")

    def press(self, aim: Aim) -> None:
        """Grab the nearest corner that is near enough."""
        drawing = self._pencil.state.drawing
        places = on_table(drawing, drawing.points)
        apart, index = min(((math.dist(place, aim.point), i) for i, place in enumerate(places)), default=(math.inf, 0))
        if apart > FINGER_PX * aim.pixel_m:
            raise RefusedError(say(self._pencil.state.language, "rule.no_corner_there"))
        x, y = places[index]
        offset = (x - aim.point[0], y - aim.point[1])
        self._grip = _Grip(drawing.outline[index].id, offset, Ground.of(drawing))

    def drag(self, aim: Aim | None) -> None:
        """Show the document with the corner here."""
        if self._grip is not None and aim is not None and self._grip.ground.holds(aim.point):
            self._pencil.preview(MOVE_CORNER, _moved(self._grip.corner, self._grip.place(aim)))

    def release(self, aim: Aim | None) -> None:
        """Put the corner here, as one step; off the table, put it back."""
        grip, self._grip = self._grip, None
        if grip is None:
            return
        if aim is None or not grip.ground.holds(aim.point):
            self._pencil.cancel()
            raise RefusedError(say(self._pencil.state.language, "rule.off_table_corner"))
        self._pencil.commit(MOVE_CORNER, _moved(grip.corner, grip.place(aim)))

    def tap(self, aim: Aim) -> None:
        """Do nothing: a click moves no corner."""
        raise RefusedError(say(self._pencil.state.language, "rule.hold_down"))

    def put_down(self) -> None:
        """Put the corner back where it was."""
        self._grip = None
        self._pencil.cancel()

    def aids(self, state: DocumentState) -> Aids:
        """Return a handle at each corner."""
        drawing = state.drawing
        handles = on_table(drawing, drawing.points)
        ids = [corner.id for corner in drawing.outline]
        held = self._grip.corner if self._grip is not None else None
        rim = on_table(drawing, ring_of(drawing.outline).points)
        return Aids(handles, ids.index(held) if held in ids else None, (closed(rim),))


def _moved(corner: str, place: Point2) -> Change:
    """Return the change that moves a corner to a point of the table (m)."""

    def change(state: DocumentState) -> Drawing:
        drawing = state.drawing
        if all(other.id != corner for other in drawing.outline):
            raise RefusedError(say(state.language, "rule.taken_away"))
        point = in_article(drawing, place)
        outline = tuple(replace(other, point=point) if other.id == corner else other for other in drawing.outline)
        return replace(drawing, outline=outline)

    return change
