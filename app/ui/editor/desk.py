"""All visitors of one stage, and their pending actions.

viser calls back in a thread of its own, which must never wait: the callbacks only put actions into a tray. The thread
that writes on the stage empties the tray, changes the document, and draws. So a single thread edits and draws, in the
order of the visitors' actions, without a lock and without half-made changes.
"""

import logging
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import viser

from app.document import Document
from app.document_state import DocumentState
from app.ui.editor.seat import Seat
from app.ui.viewpoint import Viewpoint

_log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class _Asked:
    """A pending action.

    Attributes:
        visitor: whose it is.
        act: the action.
        is_passing: whether a later passing action of the same visitor may replace it.
    """

    visitor: int
    act: Callable[[], None]
    is_passing: bool

    def done(self) -> None:
        """Perform the action; log what goes wrong, so that other visitors are not affected."""
        try:
            self.act()
        except Exception:
            _log.exception("what a visitor of a stage asked for could not be done")

    def replaces(self, other: "_Asked") -> bool:
        """Return whether the other action need not be performed any more."""
        return self.is_passing and self.visitor == other.visitor


class Desk:
    """The seats of all visitors: each has a mode, panels, drawing aids and a camera of their own."""

    def __init__(self, document: Document, server: viser.ViserServer, opening: Viewpoint) -> None:
        """Wait for visitors.

        Args:
            document: the document that is edited.
            server: the stage's server.
            opening: the opening viewpoint.
        """
        self._document = document
        self._server = server
        self._opening = opening
        self._tray: deque[_Asked] = deque()
        self._seats: dict[int, Seat] = {}
        self._ring: Callable[[], object] = lambda: None
        server.on_client_connect(self._came)
        server.on_client_disconnect(self._went)

    def on_asked(self, ring: Callable[[], object]) -> None:
        """Set the function to call when actions are pending; any thread may call it."""
        self._ring = ring
        ring()

    def work(self) -> None:
        """Perform the pending actions, but only the latest of a drag."""
        while self._tray:
            asked = self._tray.popleft()
            following = self._tray[0] if self._tray else None
            if not (asked.is_passing and following is not None and following.replaces(asked)):
                asked.done()

    def show(self, state: DocumentState) -> None:
        """Update the panels and aids of all visitors who are still there."""
        here = self._server.get_clients()
        for visitor, seat in tuple(self._seats.items()):
            if visitor in here:
                seat.show(state)

    def _ask(self, visitor: int, act: Callable[[], None], is_passing: bool) -> None:
        self._tray.append(_Asked(visitor, act, is_passing))
        self._ring()

    async def _came(self, client: viser.ClientHandle) -> None:
        self._ask(client.client_id, lambda: self._sit_down(client), False)

    async def _went(self, client: viser.ClientHandle) -> None:
        self._ask(client.client_id, lambda: self._get_up(client), False)

    def _sit_down(self, client: viser.ClientHandle) -> None:
        def ask(act: Callable[[], None], is_passing: bool) -> None:
            self._ask(client.client_id, act, is_passing)

        if client.client_id in self._server.get_clients():
            self._seats[client.client_id] = Seat(client, self._document, self._opening, ask)

    def _get_up(self, client: viser.ClientHandle) -> None:
        seat = self._seats.pop(client.client_id, None)
        if seat is not None:
            seat.leave()
