"""The interface of the 3D view's tools; there is one tool for each mode in which the pointer draws."""

from abc import ABC, abstractmethod

from app.document_state import DocumentState
from app.ui.editor.aids import Aids
from app.ui.editor.aim import Aim


class Tool(ABC):
    """Takes what the pointer does, and changes the document.

    A drag is `press`, any number of `drag`, `release`; a click is `tap`. An aim of None means that the pointer is not
    on the plane of the cloth. An action that cannot be done raises a `FoldingError` and changes nothing.
    """

    @abstractmethod
    def hint(self) -> str:
        """Return what to do now."""

    @abstractmethod
    def press(self, aim: Aim) -> None:
        """Begin a drag."""

    @abstractmethod
    def drag(self, aim: Aim | None) -> None:
        """Go on with a drag."""

    @abstractmethod
    def release(self, aim: Aim | None) -> None:
        """End a drag."""

    @abstractmethod
    def tap(self, aim: Aim) -> None:
        """Handle a click: the pointer went down and up in one place."""

    @abstractmethod
    def put_down(self) -> None:
        """Forget everything that is not in the document yet, and end the current gesture."""

    @abstractmethod
    def aids(self, state: DocumentState) -> Aids:
        """Return what is drawn over the cloth."""

    def last(self) -> str | None:
        """Return the label of what `take_back` would take back; None when there is nothing."""
        return None

    def take_back(self) -> None:
        """Take back the last thing that is not in the document yet; by default, that is everything."""
        self.put_down()
