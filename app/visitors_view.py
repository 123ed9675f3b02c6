"""A document as those see it who have a link to it: they play its plan by a clock of their own, and change nothing."""

import time
from collections.abc import Callable
from dataclasses import replace

from app.document import Document, Played
from app.document_state import DocumentState
from app.observable import Listener, Observable
from app.playback import Playback


class VisitorsView(Played):
    """The view that all visitors of one document share; safe to use from any thread."""

    def __init__(self, document: Document, clock: Callable[[], float] = time.monotonic) -> None:
        """Begin at the plan's start, paused."""
        self._document = document
        self._clock = clock
        self._playback = Observable(Playback())

    @property
    def state(self) -> DocumentState:
        """The document's state with the visitors' playback, and without what its owner only points at."""
        state = self._document.state
        playback, duration_s = self._playback.value, state.playback.duration_s
        if playback.duration_s != duration_s:
            playback = self._playback.change(lambda now: now.lasting(self._clock(), duration_s))
        return replace(state, playback=playback, preview=None)

    def subscribe(self, listener: Listener) -> Callable[[], None]:
        """Call a function after every change of the document or the playback; return the one that ends that."""
        ends = self._document.subscribe(listener), self._playback.subscribe(listener)

        def unsubscribe() -> None:
            for end in ends:
                end()

        return unsubscribe

    def _change_playback(self, change: Callable[[Playback], Playback]) -> None:
        self._playback.change(change)
