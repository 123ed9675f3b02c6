"""The editing state of one visitor: mode, active tool, last refusal. It depends on the document, not on viser.

A single thread calls everything here (see `app.ui.editor.sessions`).
"""

from collections.abc import Callable, Mapping

from app.document import Document
from app.drawing.rules import as_sentence
from app.language import Language, say, translated
from app.ui.editor.aids import NO_AIDS, Aids
from app.ui.editor.aim import Aim
from app.ui.editor.document_writer import DocumentWriter
from app.ui.editor.draw_fold import DrawFold
from app.ui.editor.draw_outline import DrawOutline
from app.ui.editor.drawing_messages import localized
from app.ui.editor.mode import FoldKind, Mode
from app.ui.editor.move_points import MovePoints
from app.ui.editor.refusal import RefusedError, sentence
from app.ui.editor.tool import Tool
from planner.errors import FoldingError


class Editor:
    """Turns a pointer's gestures into changes of a document.

    Attributes:
        mode: what the pointer does now.
    """

    def __init__(self, document: Document, owner: str) -> None:
        """Begin in the viewing mode.

        Args:
            document: the document that is edited.
            owner: a name that no other editor of this document has.
        """
        self.mode = Mode.LOOK
        self._document = document
        self._writer = DocumentWriter(document, owner)
        self._fold = DrawFold(self._writer)
        self._tools: Mapping[Mode, Tool] = {
            Mode.MOVE_POINTS: MovePoints(self._writer),
            Mode.DRAW_OUTLINE: DrawOutline(self._writer),
            Mode.DRAW_FOLD: self._fold,
        }
        self._refusal = ""
        self._is_down = False

    @property
    def kind(self) -> FoldKind:
        """The kind of fold drawn."""
        return self._fold.kind

    @property
    def is_drawing(self) -> bool:
        """Whether the pointer draws instead of moving the camera."""
        return self.mode is not Mode.LOOK

    @property
    def language(self) -> Language:
        """The language in which it speaks."""
        return self._document.state.language

    @property
    def says(self) -> str:
        """What to do now; or why the last action was refused, or what is wrong with the drawing."""
        if self._refusal:
            return self._refusal
        tool = self._tool
        if tool is None:
            return say(self.language, "view3d.looking")
        problems = self._document.state.solution.problems
        shows_problem = self.mode is Mode.MOVE_POINTS and self._document.state.drawing.outline
        if not problems or not shows_problem:
            return tool.hint()
        return as_sentence(localized(self.language, problems[0].says, problems[0].message))

    @property
    def undo_label(self) -> str:
        """The label of the undo button; just "Undo" when there is nothing."""
        label = (self._tool.last() if self._tool else None) or self._document.state.draft.closed().history.can_undo
        return _named(self.language, "history.undo", label)

    @property
    def redo_label(self) -> str:
        """The label of the redo button; just "Redo" when there is nothing."""
        label = self._document.state.draft.closed().history.can_redo
        return _named(self.language, "history.redo", label)

    def choose(self, mode: Mode) -> None:
        """Take another tool; to draw, move playback to the beginning, where the cloth lies spread."""
        if mode is self.mode:
            return
        self._try(self._put_down)
        self.mode = mode
        if self.is_drawing:
            self._document.rewind()

    def choose_kind(self, kind: FoldKind) -> None:
        """Draw folds of another kind from now on."""
        self._try(self._put_down)
        self._fold.kind = kind

    def press(self, aim: Aim | None) -> None:
        """Begin a drag; when that is refused, the rest of the drag does nothing."""
        self._is_down = self._aimed(aim, lambda tool, at: tool.press(at))

    def drag(self, aim: Aim | None) -> None:
        """Go on with a drag."""
        if self._is_down and (tool := self._tool) is not None:
            self._try(lambda: tool.drag(aim))

    def release(self, aim: Aim | None) -> None:
        """End a drag."""
        is_down, self._is_down = self._is_down, False
        if is_down and (tool := self._tool) is not None:
            self._try(lambda: tool.release(aim))

    def tap(self, aim: Aim | None) -> None:
        """Handle a click."""
        self._aimed(aim, lambda tool, at: tool.tap(at))

    def undo(self) -> None:
        """Undo what is being drawn, or the last step."""
        tool = self._tool
        if tool is not None and tool.last() is not None:
            self._try(tool.take_back)
        else:
            self._try(self._undone)

    def redo(self) -> None:
        """Redo the step that was undone last."""
        self._try(self._redone)

    def leave(self) -> None:
        """Drop what is unfinished, since the visitor has left."""
        self._try(self._put_down)

    @property
    def aids(self) -> Aids:
        """The aids drawn over the cloth; none while it does not lie spread."""
        tool = self._tool
        return tool.aids(self._document.state) if tool is not None and self._is_spread else NO_AIDS

    @property
    def _tool(self) -> Tool | None:
        return self._tools.get(self.mode)

    @property
    def _is_spread(self) -> bool:
        return not self._document.state.playback.is_playing and self._document.t_s == 0.0

    def _aimed(self, aim: Aim | None, act: Callable[[Tool, Aim], None]) -> bool:
        """Let the tool act at a point of the cloth as it lies spread; return False when it was refused."""
        tool = self._tool
        if tool is None:
            return False

        def acted() -> None:
            if not self._is_spread:
                self._document.rewind()
                raise RefusedError(say(self.language, "rule.spread_again"))
            if aim is None:
                raise RefusedError(say(self.language, "rule.off_table"))
            act(tool, aim)

        return self._try(acted)

    def _undone(self) -> None:
        self._document.undo()

    def _redone(self) -> None:
        self._document.redo()

    def _put_down(self) -> None:
        self._is_down = False
        if self._tool is not None:
            self._tool.put_down()

    def _try(self, act: Callable[[], None]) -> bool:
        """Perform an action and remember why it was refused, if it was."""
        try:
            act()
        except FoldingError as error:
            self._refusal = sentence(error, self.language)
        else:
            self._refusal = ""
        return not self._refusal


def _named(language: Language, verb: str, step: str | None) -> str:
    """Return a button's label with the name of the step that it takes, if there is one."""
    if step is None:
        return say(language, verb)
    return say(language, f"{verb}_named", step=translated(language, step))
