"""What every tool of the stage can do; there is one for each mode in which the pointer draws."""

from abc import ABC, abstractmethod

from app.document_state import DocumentState
from app.ui.editor.aids import Aids
from app.ui.editor.aim import Aim


class Tool(ABC):
    """Takes what the pointer does, and changes the document.

    A drag is `press`, any number of `drag`, `release`; a click is `tap`. No aim means that the pointer is not on the
    plane of the cloth. What cannot be done raises a `FoldingError`, and then nothing has been changed.
    """

    @abstractmethod
    def hint(self) -> str:
        """What to do now."""

    @abstractmethod
    def press(self, aim: Aim) -> None:
        """The pointer went down and began to move."""

    @abstractmethod
    def drag(self, aim: Aim | None) -> None:
        """It moves on."""

    @abstractmethod
    def release(self, aim: Aim | None) -> None:
        """It is let go."""

    @abstractmethod
    def tap(self, aim: Aim) -> None:
        """It went down and up in one place."""

    @abstractmethod
    def put_down(self) -> None:
        """Forget everything that is not in the document yet, and end what is going on."""

    @abstractmethod
    def aids(self, state: DocumentState) -> Aids:
        """What is drawn over the cloth."""

    def last(self) -> str | None:
        """What `take_back` would take back, in words; None when there is nothing."""
        return None

    def take_back(self) -> None:
        """Take the last thing back that is not in the document yet; unless a tool knows better, that is everything."""
        self.put_down()
