"""The sessions of all who look at one 3D view, and what they ask for.

viser calls back in a thread of its own, which must never wait: the callbacks only put requests into a queue. The thread
that draws the 3D view empties the queue, so a single thread moves cameras and draws, without a lock.
"""

import logging
from collections import deque
from collections.abc import Callable

import viser

from app.document import Document
from app.document_state import DocumentState
from app.ui.viewpoint import Viewpoint
from app.ui.viewpoints.session import Session

_log = logging.getLogger(__name__)


class Sessions:
    """One session for each browser that shows the 3D view: each has a camera of its own."""

    def __init__(self, document: Document, server: viser.ViserServer, opening: Viewpoint) -> None:
        """Wait for browsers.

        Args:
            document: the document that is shown.
            server: the 3D view's server.
            opening: the opening viewpoint.
        """
        self._document = document
        self._server = server
        self._opening = opening
        self._queue: deque[Callable[[], None]] = deque()
        self._sessions: dict[int, Session] = {}
        self._ring: Callable[[], object] = lambda: None
        server.on_client_connect(self._came)
        server.on_client_disconnect(self._went)

    def on_queued(self, ring: Callable[[], object]) -> None:
        """Set the function to call when there are requests; any thread may call it."""
        self._ring = ring
        ring()

    def work(self) -> None:
        """Do what is asked for; log what goes wrong, so that other sessions are not affected."""
        while self._queue:
            act = self._queue.popleft()
            try:
                act()
            except Exception:
                _log.exception("a request of a session of the 3D view failed")

    def show(self, state: DocumentState) -> None:
        """Update the cameras of all who are still there."""
        here = self._server.get_clients()
        for client, session in tuple(self._sessions.items()):
            if client in here:
                session.show(state)

    def _ask(self, act: Callable[[], None]) -> None:
        self._queue.append(act)
        self._ring()

    async def _came(self, client: viser.ClientHandle) -> None:
        self._ask(lambda: self._begin(client))

    async def _went(self, client: viser.ClientHandle) -> None:
        self._ask(lambda: self._end(client))

    def _begin(self, client: viser.ClientHandle) -> None:
        if client.client_id in self._server.get_clients():
            self._sessions[client.client_id] = Session(client, self._document, self._opening, self._ask)

    def _end(self, client: viser.ClientHandle) -> None:
        self._sessions.pop(client.client_id, None)
