"""The sessions of all visitors of one 3D view, and the queue of their actions.

viser calls back in a thread of its own, which must never wait: the callbacks only put actions into a queue. The thread
that writes in the 3D view empties the queue, changes the document, and draws. So a single thread edits and draws, in
the order of the visitors' actions, without a lock and without half-made changes.
"""

import logging
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import viser

from app.document import Document
from app.document_state import DocumentState
from app.ui.editor.session import Session
from app.ui.viewpoint import Viewpoint

_log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class _Action:
    """A pending action.

    Attributes:
        visitor: whose it is.
        act: the action.
        is_passing: whether a later passing action of the same visitor may replace it.
    """

    visitor: int
    act: Callable[[], None]
    is_passing: bool

    def perform(self) -> None:
        """Perform the action; log what goes wrong, so that other visitors are not affected."""
        try:
            self.act()
        except Exception:
            _log.exception("an action of a visitor of the 3D view failed")

    def replaces(self, other: "_Action") -> bool:
        """Return whether the other action need not be performed any more."""
        return self.is_passing and self.visitor == other.visitor


class Sessions:
    """The sessions of all visitors: each has a mode, panels, drawing aids and a camera of their own."""

    def __init__(self, document: Document, server: viser.ViserServer, opening: Viewpoint) -> None:
        """Wait for visitors.

        Args:
            document: the document that is edited.
            server: the 3D view's server.
            opening: the opening viewpoint.
        """
        self._document = document
        self._server = server
        self._opening = opening
        self._queue: deque[_Action] = deque()
        self._sessions: dict[int, Session] = {}
        self._notify: Callable[[], object] = lambda: None
        server.on_client_connect(self._connected)
        server.on_client_disconnect(self._disconnected)

    def on_pending(self, notify: Callable[[], object]) -> None:
        """Set the function to call when actions are pending; any thread may call it."""
        self._notify = notify
        notify()

    def perform(self) -> None:
        """Perform the pending actions, but only the latest of a drag."""
        while self._queue:
            action = self._queue.popleft()
            following = self._queue[0] if self._queue else None
            if not (action.is_passing and following is not None and following.replaces(action)):
                action.perform()

    def show(self, state: DocumentState) -> None:
        """Update the panels and aids of all visitors who are still there."""
        here = self._server.get_clients()
        for visitor, session in tuple(self._sessions.items()):
            if visitor in here:
                session.show(state)

    def _enqueue(self, visitor: int, act: Callable[[], None], is_passing: bool) -> None:
        self._queue.append(_Action(visitor, act, is_passing))
        self._notify()

    async def _connected(self, client: viser.ClientHandle) -> None:
        self._enqueue(client.client_id, lambda: self._open_session(client), False)

    async def _disconnected(self, client: viser.ClientHandle) -> None:
        self._enqueue(client.client_id, lambda: self._close_session(client), False)

    def _open_session(self, client: viser.ClientHandle) -> None:
        def enqueue(act: Callable[[], None], is_passing: bool) -> None:
            self._enqueue(client.client_id, act, is_passing)

        if client.client_id in self._server.get_clients():
            self._sessions[client.client_id] = Session(client, self._document, self._opening, enqueue)

    def _close_session(self, client: viser.ClientHandle) -> None:
        session = self._sessions.pop(client.client_id, None)
        if session is not None:
            session.leave()
