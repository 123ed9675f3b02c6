"""An open document: with its planner and, once someone views it, its 3D view and its player."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from app.document import Document
from app.document_state import shown_robot
from app.jobs.lanes import Lanes
from app.jobs.limits import CLIENT
from app.player import Player
from app.replanner import Replanner
from app.store.plan_store import PlanStore
from app.ui.view_3d import View3D
from app.ui.viewpoints.sessions import Sessions
from app.visitors_view import VisitorsView


class SharedTexts:
    """The newest text of each kind, made once by the first who needs it; safe to use from any thread."""

    def __init__(self) -> None:
        """Start with no text."""
        self._lock = threading.Lock()
        self._texts: dict[str, tuple[object, str]] = {}

    def text(self, kind: str, key: object, make: Callable[[], str]) -> str:
        """Return the text of a kind, made anew only if the key has changed; other callers wait meanwhile."""
        with self._lock:
            known = self._texts.get(kind)
            if known is None or known[0] != key:
                known = self._texts[kind] = (key, make())
            return known[1]


class OpenDocument:
    """An open document and everything that belongs to it.

    Attributes:
        id: the document's id.
        document: the document.
        opened_by: the client that had it opened, as `CLIENT` says.
        texts: what its pages are sent.
        visitors: the document as those see it who have a link to it.
    """

    def __init__(self, document_id: str, document: Document, lanes: Lanes, plans: PlanStore) -> None:
        """Open a document and start planning it."""
        self.id = document_id
        self.document = document
        self.opened_by = CLIENT.get()
        self.texts = SharedTexts()
        self.visitors = VisitorsView(document)
        self._replanner = Replanner(document, lanes.live, lanes.workers, plans)
        self._lock = threading.Lock()
        self._shown: tuple[View3D, Player] | None = None
        self._shown_to_visitors: tuple[View3D, Player] | None = None
        self._users = 0
        self._used_s = time.monotonic()
        self._goodbyes: list[Callable[[], None]] = []

    def show(self) -> View3D:
        """Return its 3D view; the first call builds it."""
        with self._lock:
            if self._shown is None:
                drawing = self.document.state.drawing
                view = View3D(shown_robot(drawing.robot), drawing.scene)
                sessions = Sessions(self.document, view.server, view.opening)
                self._shown = (view, Player(self.document, view, sessions))
            return self._shown[0]

    def show_to_visitors(self) -> View3D:
        """Return the read-only 3D view for visitors with a link; the first call builds it."""
        with self._lock:
            if self._shown_to_visitors is None:
                drawing = self.document.state.drawing
                view = View3D(shown_robot(drawing.robot), drawing.scene)
                self._shown_to_visitors = (view, Player(self.visitors, view))
            return self._shown_to_visitors[0]

    @property
    def unused_s(self) -> float:
        """The time since its last use (s); 0 while it is in use."""
        with self._lock:
            return 0.0 if self._users else time.monotonic() - self._used_s

    @contextmanager
    def in_use(self, say_goodbye: Callable[[], None] = lambda: None) -> Iterator[None]:
        """Keep the document open during this context; call `say_goodbye` if it is removed nevertheless."""
        with self._lock:
            self._users += 1
            self._goodbyes.append(say_goodbye)
        try:
            yield
        finally:
            with self._lock:
                self._users -= 1
                self._goodbyes.remove(say_goodbye)
                self._used_s = time.monotonic()

    def say_goodbye(self) -> None:
        """Tell all users that the document was removed."""
        with self._lock:
            goodbyes = tuple(self._goodbyes)
        for say_goodbye in goodbyes:
            say_goodbye()

    def touch(self) -> None:
        """Record a use."""
        with self._lock:
            self._used_s = time.monotonic()

    def close(self) -> None:
        """Close the document, its planner, its player and its 3D view."""
        with self._lock:
            shown = [one for one in (self._shown, self._shown_to_visitors) if one is not None]
            self._shown = self._shown_to_visitors = None
        self.document.end()
        self._replanner.close()
        for view, player in shown:
            player.close()
            view.close()
