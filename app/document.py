"""The document: the one object that owns what can change. It knows neither viser nor FastAPI.

REST, page and stage are skins over it: they call its methods, and are told when it has changed. Its state is
a value that is swapped under a lock, so a reader takes one and never sees half a change.
"""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from app.playback import Playback
from planner.cloth.garment import Garment
from planner.plan.plan import Plan
from planner.plan.timeline import Timeline
from planner.primitives.scene import Scene

Listener = Callable[[], None]


@dataclass(frozen=True, slots=True)
class DocumentState:
    """A document at one instant.

    Attributes:
        version: grows with every change of what is to be planned.
        garment: the garment, its folds and its placement.
        scene: the scene it lies in.
        plan: the answer for this version; None while it is being worked out or when that failed.
        plan_id: the name under which the plan can be read, with the plan.
        timeline: the plan's timeline, when it is solved.
        problem: why there can be no answer at all (a fold that is not legal), or None.
        playback: the clock.
        is_dark: whether it is shown on a dark ground; of several pages, the last one to say decides.
    """

    version: int
    garment: Garment
    scene: Scene
    plan: Plan | None = None
    plan_id: str | None = None
    timeline: Timeline | None = None
    problem: str | None = None
    playback: Playback = Playback()
    is_dark: bool = False

    @property
    def is_planning(self) -> bool:
        """Whether the answer is still being worked out."""
        return self.plan is None and self.problem is None


class Document:
    """A garment in a scene, its plan, and the playback of that plan."""

    def __init__(self, garment: Garment, scene: Scene, clock: Callable[[], float] = time.monotonic) -> None:
        """A document that wants a plan.

        Args:
            garment: what is to be folded.
            scene: where.
            clock: the wall clock (s).
        """
        self._clock = clock
        self._lock = threading.Lock()
        self._state = DocumentState(version=1, garment=garment, scene=scene)
        self._listeners: list[Listener] = []

    @property
    def state(self) -> DocumentState:
        """The document now."""
        return self._state

    @property
    def t_s(self) -> float:
        """The time in the plan now (s)."""
        return self._state.playback.at(self._clock())

    def subscribe(self, listener: Listener) -> Callable[[], None]:
        """Have a function called after every change, by whatever thread made it; returns the way out."""
        with self._lock:
            self._listeners.append(listener)

        def unsubscribe() -> None:
            with self._lock:
                self._listeners.remove(listener)

        return unsubscribe

    def choose(self, garment: Garment) -> None:
        """Take another garment; its plan is wanted from now on."""

        def change(state: DocumentState) -> DocumentState:
            playback = Playback(speed=state.playback.speed)
            return DocumentState(state.version + 1, garment, state.scene, playback=playback, is_dark=state.is_dark)

        self._change(change)

    def settle(self, version: int, plan: Plan, plan_id: str, timeline: Timeline | None) -> None:
        """Put in the answer for a version; one that comes too late is dropped."""
        duration_s = timeline.duration_s if timeline else 0.0

        def change(state: DocumentState) -> DocumentState:
            playback = Playback(duration_s=duration_s, speed=state.playback.speed)
            return replace(state, plan=plan, plan_id=plan_id, timeline=timeline, playback=playback)

        self._change(change, only_version=version)

    def fail(self, version: int, problem: str) -> None:
        """Put in that a version has no answer at all."""
        self._change(lambda state: replace(state, problem=problem), only_version=version)

    def play(self) -> None:
        """Let time run; without a solved plan nothing happens."""
        self._change_playback(lambda playback: playback.played(self._clock()))

    def pause(self) -> None:
        """Stop time."""
        self._change_playback(lambda playback: playback.paused(self._clock()))

    def seek(self, t_s: float) -> None:
        """Go to a time in the plan (s)."""
        self._change_playback(lambda playback: playback.sought(self._clock(), t_s))

    def set_speed(self, speed: float) -> None:
        """Let time run faster or slower."""
        self._change_playback(lambda playback: playback.sped(self._clock(), speed))

    def set_theme(self, *, is_dark: bool) -> None:
        """Show the document on a dark ground or on a light one."""
        self._change(lambda state: replace(state, is_dark=is_dark))

    def stop_at_end(self) -> None:
        """Pause if the plan has been played to its end."""
        playback = self._state.playback
        if playback.is_playing and playback.has_ended(self._clock()):
            self.pause()

    def _change_playback(self, change: Callable[[Playback], Playback]) -> None:
        self._change(lambda state: replace(state, playback=change(state.playback)))

    def _change(self, change: Callable[[DocumentState], DocumentState], only_version: int | None = None) -> None:
        with self._lock:
            if only_version not in (None, self._state.version):
                return
            self._state = change(self._state)
            listeners = tuple(self._listeners)
        for listener in listeners:
            listener()
