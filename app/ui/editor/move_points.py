"""The tool `Move points`: a corner of the outline, or the middle of an edge, follows the pointer, the plan follows."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from app.document_state import DocumentState
from app.drawing.curve import Curve
from app.drawing.drawing import Corner, Drawing
from app.drawing.ring import ring_of
from app.drawing.rules import BEND_EDGE, FINGER_PX, LEAST_CORNERS, MOVE_CORNER, snapped_handle
from app.language import say
from app.ui.editor.aids import Aids, closed
from app.ui.editor.aim import Aim
from app.ui.editor.document_writer import Change, DocumentWriter
from app.ui.editor.ground import Ground, in_article, on_table
from app.ui.editor.refusal import RefusedError
from app.ui.editor.tool import Tool
from planner.geometry.pose import Point2

MIDDLE_ROOM_M = 0.1
"""Length from which on a straight edge has a handle in its middle (m); a curved one always has."""

_MIDDLE_BEHIND_PX = 3.0
"""How much nearer than a corner the pointer has to be to a middle to grab that (px), as on the board."""


@dataclass(frozen=True, slots=True)
class _Grip:
    """The handle under the pointer: a corner, or the middle of the edge that begins there.

    Attributes:
        corner: the name of the corner.
        is_middle: whether it is the edge's middle.
        offset: from the pointer to what is held when it was grabbed, table frame (m).
        ground: where it may be put down.
    """

    corner: str
    is_middle: bool
    offset: Point2
    ground: Ground

    @property
    def label(self) -> str:
        """The name of the step that a drag makes."""
        return BEND_EDGE if self.is_middle else MOVE_CORNER

    def change(self, aim: Aim) -> Change:
        """Return the change that puts what is held where the pointer is now."""
        place = (aim.point[0] + self.offset[0], aim.point[1] + self.offset[1])
        return _bent(self.corner, place, aim.pixel_m) if self.is_middle else _moved(self.corner, place)


class MovePoints(Tool):
    """Moves the handle nearest to the pointer."""

    def __init__(self, writer: DocumentWriter) -> None:
        """Take the writer that writes into the document."""
        self._writer = writer
        self._grip: _Grip | None = None

    def hint(self) -> str:
        """Return what to do now."""
        if self._grip is not None:
            return self._say("view3d.let_go_bend" if self._grip.is_middle else "view3d.let_go")
        return self._say("view3d.drag_corner" if self._writer.state.drawing.outline else "view3d.no_outline")

    def press(self, aim: Aim) -> None:
        """Grab the nearest handle that is near enough."""
        drawing = self._writer.state.drawing
        handles = [(corner.id, False, place) for corner, place in _corners(drawing)]
        handles += [(corner.id, True, place) for corner, place in _middles(drawing)]
        near = [handle for handle in handles if math.dist(handle[2], aim.point) <= FINGER_PX * aim.pixel_m]
        if not near:
            raise RefusedError(self._say("rule.no_corner_there"))
        behind_m = _MIDDLE_BEHIND_PX * aim.pixel_m
        corner, is_middle, (x, y) = min(near, key=lambda one: math.dist(one[2], aim.point) + one[1] * behind_m)
        self._grip = _Grip(corner, is_middle, (x - aim.point[0], y - aim.point[1]), Ground.of(drawing))

    def drag(self, aim: Aim | None) -> None:
        """Show the document with the handle here."""
        if self._grip is not None and aim is not None and self._grip.ground.holds(aim.point):
            self._writer.preview(self._grip.label, self._grip.change(aim))

    def release(self, aim: Aim | None) -> None:
        """Put the handle here, as one step; off the table, put it back."""
        grip, self._grip = self._grip, None
        if grip is None:
            return
        if aim is None or not grip.ground.holds(aim.point):
            self._writer.cancel()
            raise RefusedError(self._say("rule.off_table_edge" if grip.is_middle else "rule.off_table_corner"))
        self._writer.commit(grip.label, grip.change(aim))

    def tap(self, aim: Aim) -> None:
        """Do nothing: a click moves no corner."""
        raise RefusedError(self._say("rule.hold_down"))

    def put_down(self) -> None:
        """Put the handle back where it was."""
        self._grip = None
        self._writer.cancel()

    def aids(self, state: DocumentState) -> Aids:
        """Return a handle at each corner, and a smaller one in the middle of each edge that has room for it."""
        corners, middles = list(_corners(state.drawing)), list(_middles(state.drawing))
        ids = [(corner.id, False) for corner, _ in corners] + [(corner.id, True) for corner, _ in middles]
        held = (self._grip.corner, self._grip.is_middle) if self._grip is not None else None
        return Aids(
            tuple(place for _, place in corners),
            tuple(place for _, place in middles),
            ids.index(held) if held in ids else None,
            (closed(on_table(state.drawing, ring_of(state.drawing.outline).points)),),
        )

    def _say(self, key: str) -> str:
        return say(self._writer.state.language, key)


def _corners(drawing: Drawing) -> Iterator[tuple[Corner, Point2]]:
    """Yield the corners and where they are, table frame (m)."""
    yield from zip(drawing.outline, on_table(drawing, drawing.points), strict=True)


def _middles(drawing: Drawing) -> Iterator[tuple[Corner, Point2]]:
    """Yield where edges are grabbed to bend them, table frame (m), each with the corner at which it begins."""
    if len(drawing.outline) < LEAST_CORNERS:
        return
    for corner, following in zip(drawing.outline, (*drawing.outline[1:], drawing.outline[0]), strict=True):
        if corner.curve is not None or math.dist(corner.point, following.point) >= MIDDLE_ROOM_M:
            curve = corner.curve or Curve(0.0, 0.0)
            yield corner, on_table(drawing, [curve.handle(corner.point, following.point)])[0]


def _moved(corner: str, place: Point2) -> Change:
    """Return the change that moves a corner to a point of the table (m)."""

    def change(state: DocumentState) -> Drawing:
        index = _index(state, corner, "rule.taken_away")
        return _with(
            state.drawing, index, replace(state.drawing.outline[index], point=in_article(state.drawing, place))
        )

    return change


def _bent(corner: str, place: Point2, pixel_m: float) -> Change:
    """Return the change that bends the edge after a corner so that its middle is at a point of the table (m)."""

    def change(state: DocumentState) -> Drawing:
        index = _index(state, corner, "rule.taken_away_edge")
        points = state.drawing.points
        ends = points[index], points[(index + 1) % len(points)]
        handle = snapped_handle(*ends, in_article(state.drawing, place), pixel_m)
        bent = replace(state.drawing.outline[index], curve=Curve.through(*ends, handle))
        return _with(state.drawing, index, bent)

    return change


def _index(state: DocumentState, corner: str, otherwise: str) -> int:
    """Return the index of a corner; refuse with these words if it is no longer there."""
    ids = [other.id for other in state.drawing.outline]
    if corner not in ids:
        raise RefusedError(say(state.language, otherwise))
    return ids.index(corner)


def _with(drawing: Drawing, index: int, corner: Corner) -> Drawing:
    return replace(drawing, outline=(*drawing.outline[:index], corner, *drawing.outline[index + 1 :]))
