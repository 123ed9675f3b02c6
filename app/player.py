"""The player: shows a document on its stage, 30 times a second while it plays and somebody watches."""

import logging
import threading
import time

from app.document import Document, DocumentState
from app.ui.lying_cloth import lying_cloth
from app.ui.stage import Stage

UPDATES_PER_S = 30.0
_UNWATCHED_PERIOD_S = 0.25
_CLOSING_S = 1.0

_log = logging.getLogger(__name__)


class Player:
    """A thread that is the only one to write on a stage."""

    def __init__(self, document: Document, stage: Stage) -> None:
        """Start showing at once; ends with `close`."""
        self._document = document
        self._stage = stage
        self._changed = threading.Event()
        self._is_closed = False
        self._due_s = 0.0
        self._shown: DocumentState | None = None
        self._changed.set()
        self._unsubscribe = document.subscribe(self._changed.set)
        self._thread = threading.Thread(target=self._run, name="player", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop showing."""
        self._unsubscribe()
        self._is_closed = True
        self._changed.set()
        self._thread.join(_CLOSING_S)

    def _run(self) -> None:
        while True:
            self._changed.wait(self._period_s())
            if self._is_closed:
                return
            self._changed.clear()
            try:
                self._update()
            except Exception:
                _log.exception("the stage could not be brought up to date")

    def _period_s(self) -> float | None:
        """How long to wait when nothing changes (s); None: for ever."""
        if not self._document.state.playback.is_playing:
            return None
        now_s = time.monotonic()
        period_s = 1.0 / UPDATES_PER_S if self._stage.has_watchers else _UNWATCHED_PERIOD_S
        self._due_s = max(self._due_s + period_s, now_s)
        return self._due_s - now_s

    def _update(self) -> None:
        state = self._document.state
        shown, self._shown = self._shown, state
        if shown is None or shown.is_dark != state.is_dark:
            self._stage.set_theme(is_dark=state.is_dark)
        if state.timeline is None:
            if shown is None or shown.version != state.version or shown.plan is not state.plan:
                self._show_lying(state)
            return
        if shown is None or shown.plan is not state.plan:
            assert state.plan is not None
            self._stage.show_plan(state.plan)
        self._stage.show(state.timeline.at(self._document.t_s))
        self._document.stop_at_end()

    def _show_lying(self, state: DocumentState) -> None:
        base = next(iter(dict(state.scene.stations).values()))
        self._stage.show_garment(state.garment, lying_cloth(state.garment, state.scene.table), base)
