"""The panel that sets what the pointer does: viser's own controls, one folder, for one visitor."""

from collections.abc import Callable
from enum import StrEnum
from typing import TypeVar

import viser

from app.language import Language, say
from app.ui.editor.editor import Editor
from app.ui.editor.mode import FoldKind, Mode

Chosen = TypeVar("Chosen", bound=StrEnum)

OnEditor = Callable[[Callable[[Editor], None]], None]


class EditPanel:
    """Mode, kind of fold, undo, redo, and a line of text."""

    def __init__(self, client: viser.ClientHandle, language: Language, on_editor: OnEditor) -> None:
        """Build the folder.

        Args:
            client: who sees it.
            language: the language that it speaks.
            on_editor: called with an action for the visitor's editor; must not block.
        """
        self._on_editor = on_editor
        self._shown: tuple[str, ...] = ()
        self._language = language
        gui = client.gui
        self._folder = gui.add_folder(say(language, "panel.edit"))
        with self._folder:
            self._mode = gui.add_dropdown(say(language, "panel.mode"), _labels(language, Mode))
            self._kind = gui.add_dropdown(say(language, "strip.fold"), _labels(language, FoldKind), visible=False)
            self._says = gui.add_markdown("")
            self._undo = gui.add_button(say(language, "history.undo"), disabled=True)
            self._redo = gui.add_button(say(language, "history.redo"), disabled=True)
        self._mode.on_update(self._mode_chosen)
        self._kind.on_update(self._kind_chosen)
        self._undo.on_click(self._undo_pressed)
        self._redo.on_click(self._redo_pressed)

    def show(self, editor: Editor) -> None:
        """Show an editor's state."""
        self._speak(editor)
        wanted = (editor.mode, editor.says, editor.undo_label, editor.redo_label)
        if wanted == self._shown:
            return
        self._shown = wanted
        self._kind.visible = editor.mode is Mode.DRAW_FOLD
        self._says.content = _escaped(editor.says)
        self._undo.label, self._redo.label = editor.undo_label, editor.redo_label
        self._undo.disabled, self._redo.disabled = (
            editor.undo_label == say(editor.language, "history.undo"),
            editor.redo_label == say(editor.language, "history.redo"),
        )

    def _speak(self, editor: Editor) -> None:
        """Take over another language; what is chosen stays."""
        language = editor.language
        if language == self._language:
            return
        self._language = language
        self._folder.label = say(language, "panel.edit")
        self._mode.label, self._kind.label = say(language, "panel.mode"), say(language, "strip.fold")
        mode, kind = editor.mode, editor.kind  # other options choose the first one
        self._mode.options, self._kind.options = _labels(language, Mode), _labels(language, FoldKind)
        # To type checkers viser shows no setter of a handle's value.
        self._mode.value = say(language, mode)  # type: ignore[misc]
        self._kind.value = say(language, kind)  # type: ignore[misc]

    async def _mode_chosen(self, event: viser.GuiEvent[viser.GuiDropdownHandle[str]]) -> None:
        mode = _chosen(Mode, self._language, event.target.value)
        self._on_editor(lambda editor: editor.choose(mode))

    async def _kind_chosen(self, event: viser.GuiEvent[viser.GuiDropdownHandle[str]]) -> None:
        kind = _chosen(FoldKind, self._language, event.target.value)
        self._on_editor(lambda editor: editor.choose_kind(kind))

    async def _undo_pressed(self, _: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        self._on_editor(Editor.undo)

    async def _redo_pressed(self, _: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        self._on_editor(Editor.redo)


def _labels(language: Language, keys: type[StrEnum]) -> tuple[str, ...]:
    return tuple(say(language, key) for key in keys)


def _chosen(keys: type[Chosen], language: Language, label: str) -> Chosen:
    return next(key for key in keys if say(language, key) == label)


def _escaped(text: str) -> str:
    """Return a text escaped so that Markdown shows it unchanged; names come from people."""
    return "".join(f"\\{letter}" if letter in r"\`*_{}[]<>()#+-.!|~&$" else letter for letter in text)
