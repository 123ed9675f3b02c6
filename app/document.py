"""The document: the one object that owns the mutable state. It knows neither viser nor FastAPI.

REST, page and 3D view are thin layers over it: they call its methods and are notified of changes. Its state is one
immutable value (`app.document_state`), and so is what becomes of it. A change of the drawing is on the disk before
anyone sees it.
"""

import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

from app.document_state import DocumentState, VersionPlan
from app.drawing.draft import Draft
from app.drawing.drawing import Drawing
from app.drawing.edit import Edit, OvertakenError, StaleVersionError
from app.held_folds import FoldCheck, FoldChecks
from app.language import Language
from app.observable import Listener, Observable
from app.playback import Playback
from app.rehearsal.trace import RunTrace
from planner.errors import FoldingError
from planner.task.plan import Plan
from planner.task.task import Task
from planner.task.world_state import WorldState

if TYPE_CHECKING:
    from app.store.document_reader import KeptDocument

STOPPED = "planning was stopped; the next change is planned again"

Keep = Callable[[int, Draft], None]
KeepStart = Callable[[WorldState | None], None]


class EndedDocumentError(FoldingError):
    """The document has been closed or removed."""

    def __str__(self) -> str:
        return "the document has been closed"


class Played(ABC):
    """What has a playback: its controls, for any thread."""

    _clock: Callable[[], float]

    @property
    @abstractmethod
    def state(self) -> DocumentState:
        """The current state."""

    @abstractmethod
    def _change_playback(self, change: Callable[[Playback], Playback]) -> None:
        """Put what a function makes of the playback in its place."""

    @property
    def t_s(self) -> float:
        """The current time in the plan (s)."""
        return self.state.playback.at(self._clock())

    def play(self) -> None:
        """Start playing; without a solved plan, do nothing."""
        self._change_playback(lambda playback: playback.played(self._clock()))

    def pause(self) -> None:
        """Stop playing."""
        self._change_playback(lambda playback: playback.paused(self._clock()))

    def seek(self, t_s: float) -> None:
        """Go to a time in the plan (s)."""
        self._change_playback(lambda playback: playback.sought(self._clock(), t_s))

    def set_speed(self, speed: float) -> None:
        """Set the playback's speed."""
        self._change_playback(lambda playback: playback.sped(self._clock(), speed))

    def stop_at_end(self) -> None:
        """Pause if the plan has been played to its end."""
        playback = self.state.playback
        if playback.is_playing and playback.has_ended(self._clock()):
            self.pause()


class Document(Played):
    """A drawing with its history, the answer to it, and the playback of that answer."""

    def __init__(
        self,
        draft: Draft,
        *,
        version: int = 1,
        start: WorldState | None = None,
        keep: Keep = lambda _version, _draft: None,
        keep_start: KeepStart = lambda _start: None,
        reread: "Callable[[], KeptDocument] | None" = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Start with a drawing that has no plan yet.

        Args:
            draft: the drawing and its history.
            version: the first version number.
            start: the world state from which to plan; None for the state before all folds, as drawn.
            keep: saves a draft under its new version, without a start; called before anyone sees the change. An
                exception cancels it.
            keep_start: saves the world state from which the drawing is planned, in the same way.
            reread: reads the document as another server has saved it, once `keep` has raised `OvertakenError`.
            clock: the wall clock (s).
        """
        self._clock = clock
        self._keep = keep
        self._keep_start = keep_start
        self._reread = reread
        self._edits = threading.Lock()
        self._has_ended = False
        self._state = Observable(DocumentState(version, draft, start=start))

    @property
    def state(self) -> DocumentState:
        """The current state."""
        return self._state.value

    def subscribe(self, listener: Listener) -> Callable[[], None]:
        """Call a function after every change, in the thread that made it; return the function that unsubscribes it."""
        return self._state.subscribe(listener)

    def edit(self, edit: Edit) -> DocumentState:
        """Change the drawing; return the new state.

        Raises:
            StaleVersionError: the change is based on a version that is no longer current.
            EndedDocumentError: the document has been closed.
        """
        return self._redraw(lambda draft: draft.edited(edit, self._clock()), edit.base_version)

    def undo(self, base_version: int | None = None) -> DocumentState:
        """Undo the last step, or a gesture in progress as a whole; raise `StaleVersionError`."""
        return self._redraw(Draft.undone, base_version)

    def redo(self, base_version: int | None = None) -> DocumentState:
        """Redo the step undone last; raise `StaleVersionError`."""
        return self._redraw(Draft.redone, base_version)

    def end(self, remove: Callable[[], None] = lambda: None) -> None:
        """Refuse all further changes of the drawing.

        Args:
            remove: called first, while nothing can change; if it raises, the document stays usable.
        """
        with self._edits:
            remove()
            self._has_ended = True

    def settle(self, version: int, task: Task, plan: Plan, plan_id: str, *, is_final: bool = True) -> None:
        """Store the plan for a task given at a version, and play it; drop it if it is late."""

        def change(state: DocumentState) -> DocumentState:
            belongs_to = state.version if state.task == task else version
            is_late = state.answer is not None and belongs_to < state.answer.version
            is_from_elsewhere = version == state.version and state.task not in (None, task)
            if is_late or is_from_elsewhere:  # another start was chosen for the same drawing meanwhile
                return state
            answer = VersionPlan(belongs_to, task, plan, plan_id, is_final)
            answered = state.answered(answer)
            return answered if state.task is None else answered.showing(answer, self._clock())

        self._state.change(change)

    def put_checks(self, drawing: Drawing, folds: tuple[FoldCheck, ...]) -> None:
        """Store the grips that the folds of a drawing need; ignore them if the drawing has changed."""

        def change(state: DocumentState) -> DocumentState:
            return replace(state, checks=FoldChecks(state.version, folds)) if state.drawing == drawing else state

        self._state.change(change)

    def fail(self, version: int, failure: str) -> None:
        """Store why a version has no answer."""
        self._state.change(lambda state: replace(state, failure=failure) if version == state.version else state)

    def prepare(self, share: float | None) -> None:
        """Store the progress of the robot's reach maps (0 to 1), in steps of 0.01; None when they are complete."""
        prepared = None if share is None else round(share, 2)
        self._state.change(lambda state: state if state.prepared == prepared else replace(state, prepared=prepared))

    def compile(self, *, is_compiling: bool) -> None:
        """Store whether the planner is being compiled, at its first use."""
        self._state.change(lambda state: replace(state, is_compiling=is_compiling))

    def stop_planning(self) -> None:
        """Stop waiting for an answer to this version, or for a better one."""
        self._state.change(lambda state: state.stopped(STOPPED))

    def plan_again(self) -> None:
        """Request an answer to a version for which planning was stopped or failed."""
        self._state.change(lambda state: replace(state, failure=None) if state.failure else state)

    def plan_from(self, start_of: Callable[[DocumentState], WorldState | None]) -> None:
        """Plan the same drawing from another world state, None for its own start; it is saved before anyone sees it.

        Raises:
            RequestError: the drawing cannot be planned from there.
        """
        with self._edits:
            if self._has_ended:
                raise EndedDocumentError
            start = start_of(self.state)
            if start != self.state.start:
                with self._unless_overtaken():
                    self._keep_start(start)
            self._state.change(lambda state: state.started_at(start, self._clock()))

    def look_longer(self) -> None:
        """Request more search for this version, if that may improve its answer."""

        def change(state: DocumentState) -> DocumentState:
            if state.answer is None or not state.may_look_longer:
                return state
            kept = replace(state.answer, is_final=False) if state.answer.plan.is_solved else None
            return replace(state, answer=kept, is_thorough=True)

        self._state.change(change)

    def rewind(self) -> None:
        """Stop playing and go to the start."""
        self._change_playback(lambda playback: playback.paused(self._clock()).sought(self._clock(), 0.0))

    def set_theme(self, *, is_dark: bool) -> None:
        """Set whether the background is dark."""
        self._state.change(lambda state: replace(state, is_dark=is_dark))

    def set_language(self, language: Language) -> None:
        """Set the language of what is exported for people: instruction sheet, recording, films."""
        self._state.change(lambda state: replace(state, language=language))

    def set_effort(self, work_s: float | None) -> None:
        """Set the work of each search from the next one on, None for the usual (s, see `planner.planning.budget`)."""
        self._state.change(lambda state: replace(state, work_s=work_s))

    def preview(self, plan: Plan | None) -> None:
        """Show the plan of a change in the 3D view while it is pointed at; None shows the document's own plan."""
        self._state.change(lambda state: state.previewing(plan))

    def show_trace(self, trace: RunTrace | None) -> None:
        """Have the 3D view show the cloth of a rehearsed run along with the plan on show; None: no more."""
        self._state.change(lambda state: state.tracing(trace))

    def _redraw(self, change: Callable[[Draft], Draft], base_version: int | None) -> DocumentState:
        """Change the draft; the lock `_edits` allows one change at a time, and only this method makes new versions."""
        with self._edits:
            if self._has_ended:
                raise EndedDocumentError
            version, draft = self.state.version, self.state.draft
            if base_version not in (None, version):
                raise StaleVersionError(base_version, version)
            after = change(draft)
            if after is draft:
                return self.state
            with self._unless_overtaken():
                self._keep(version + 1, after)
            return self._state.change(lambda state: state.redrawn(after, self._clock()))

    @contextmanager
    def _unless_overtaken(self) -> Iterator[None]:
        """Where another server was quicker, take its document over, and say that the change came too late."""
        try:
            yield
        except OvertakenError:
            version = self.state.version
            self._take_over()
            raise StaleVersionError(version, self.state.version) from None

    def _take_over(self) -> None:
        if self._reread is None:
            return
        saved = self._reread()

        def change(state: DocumentState) -> DocumentState:
            current = replace(state, version=max(state.version, saved.version - 1))
            return current.redrawn(saved.draft, self._clock()).started_at(saved.start, self._clock())

        self._state.change(change)

    def _change_playback(self, change: Callable[[Playback], Playback]) -> None:
        self._state.change(lambda state: replace(state, playback=change(state.playback)))
