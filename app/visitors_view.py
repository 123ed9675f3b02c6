"""A document as those see it who have a link to it: they play its plan by a clock of their own, and change nothing."""

import time
from collections.abc import Callable
from dataclasses import replace

from app.document import Document
from app.document_state import DocumentState
from app.observable import Listener, Observable
from app.playback import Playback


class VisitorsView:
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
            playback = self._change(lambda now: now.lasting(self._clock(), duration_s))
        return replace(state, playback=playback, preview=None)

    @property
    def t_s(self) -> float:
        """The time in the plan (s)."""
        return self.state.playback.at(self._clock())

    def subscribe(self, listener: Listener) -> Callable[[], None]:
        """Call a function after every change of the document or the playback; return the one that ends that."""
        ends = self._document.subscribe(listener), self._playback.subscribe(listener)

        def unsubscribe() -> None:
            for end in ends:
                end()

        return unsubscribe

    def play(self) -> None:
        """Play the plan, from its start if it was played to its end."""
        self._change(lambda playback: playback.played(self._clock()))

    def pause(self) -> None:
        """Stop at the current time."""
        self._change(lambda playback: playback.paused(self._clock()))

    def seek(self, t_s: float) -> None:
        """Go to a time in the plan (s)."""
        self._change(lambda playback: playback.sought(self._clock(), t_s))

    def set_speed(self, speed: float) -> None:
        """Set the playback's speed."""
        self._change(lambda playback: playback.sped(self._clock(), speed))

    def stop_at_end(self) -> None:
        """Pause if the plan has been played to its end."""
        playback = self._playback.value
        if playback.is_playing and playback.has_ended(self._clock()):
            self.pause()

    def _change(self, change: Callable[[Playback], Playback]) -> Playback:
        return self._playback.change(change)
