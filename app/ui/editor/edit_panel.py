"""The panel that sets what the pointer does: viser's own controls, one folder, for one visitor."""

from collections.abc import Callable

import viser

from app.ui.editor.editor import Editor
from app.ui.editor.mode import FoldKind, Mode

LABEL = "Edit on the table"

OnEditor = Callable[[Callable[[Editor], None]], None]


class EditPanel:
    """Mode, kind of fold, undo, redo, and a line of text."""

    def __init__(self, client: viser.ClientHandle, on_editor: OnEditor) -> None:
        """Build the folder.

        Args:
            client: who sees it.
            on_editor: called with an action for the visitor's editor; must not block.
        """
        self._on_editor = on_editor
        self._shown: tuple[str, ...] = ()
        gui = client.gui
        self._folder = gui.add_folder(LABEL)
        with self._folder:
            self._mode = gui.add_dropdown("Mode", tuple(mode.value for mode in Mode))
            self._kind = gui.add_dropdown("Fold", tuple(kind.value for kind in FoldKind), visible=False)
            self._says = gui.add_markdown("")
            self._undo = gui.add_button("Undo", disabled=True)
            self._redo = gui.add_button("Redo", disabled=True)
        self._mode.on_update(self._mode_chosen)
        self._kind.on_update(self._kind_chosen)
        self._undo.on_click(self._undo_pressed)
        self._redo.on_click(self._redo_pressed)

    def show(self, editor: Editor) -> None:
        """Show an editor's state."""
        wanted = (editor.mode, editor.says, editor.undo_label, editor.redo_label)
        if wanted == self._shown:
            return
        self._shown = wanted
        self._kind.visible = editor.mode is Mode.DRAW_FOLD
        self._says.content = _escaped(editor.says)
        self._undo.label, self._redo.label = editor.undo_label, editor.redo_label
        self._undo.disabled, self._redo.disabled = editor.undo_label == "Undo", editor.redo_label == "Redo"

    async def _mode_chosen(self, event: viser.GuiEvent[viser.GuiDropdownHandle[str]]) -> None:
        mode = Mode(event.target.value)
        self._on_editor(lambda editor: editor.choose(mode))

    async def _kind_chosen(self, event: viser.GuiEvent[viser.GuiDropdownHandle[str]]) -> None:
        kind = FoldKind(event.target.value)
        self._on_editor(lambda editor: editor.choose_kind(kind))

    async def _undo_pressed(self, _: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        self._on_editor(Editor.undo)

    async def _redo_pressed(self, _: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        self._on_editor(Editor.redo)


def _escaped(text: str) -> str:
    """Return a text escaped so that Markdown shows it unchanged; names come from people."""
    return "".join(f"\\{letter}" if letter in r"\`*_{}[]<>()#+-.!|~&$" else letter for letter in text)
