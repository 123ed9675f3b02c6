"""A pointer for tests: it points at places of the table as in the picture."""

import itertools

from app.document import Document
from app.drawing.draft import draft_of
from app.drawing.drawing import Drawing
from app.ui.editor.aim import Aim
from app.ui.editor.editor import Editor
from app.ui.editor.mode import Mode
from planner.geometry.pose import Point2

PIXEL_M = 0.003
"""The size of a pixel on the table (m), as in a picture of 500 pixels that shows 1.5 m."""


def at(point: Point2) -> Aim:
    return Aim(point, PIXEL_M)


def editing(drawing: Drawing, mode: Mode) -> tuple[Document, Editor]:
    """Return a document and an editor in a mode."""
    document = Document(draft_of(drawing))
    editor = Editor(document, "hand")
    editor.choose(mode)
    return document, editor


def drag(editor: Editor, *points: Point2, steps: int = 3) -> None:
    """Press at the first point and release at the last, with some pointer events between neighbours."""
    editor.press(at(points[0]))
    for (ax, ay), (bx, by) in itertools.pairwise(points):
        for step in range(1, steps + 1):
            share = step / steps
            editor.drag(at((ax + share * (bx - ax), ay + share * (by - ay))))
    editor.release(at(points[-1]))
