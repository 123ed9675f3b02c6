"""The player: shows a document on its 3D view, 30 times a second while it plays and someone watches."""

import logging
import threading
import time

from app.document import Document
from app.document_state import DocumentState, ShownPlan, shown_robot
from app.ui.view_3d import View3D
from app.ui.viewpoints.sessions import Sessions
from app.ui.withdrawal import LASTS_S, withdrawn
from app.visitors_view import VisitorsView
from planner.cloth.garment import Garment
from planner.geometry.pose import Pose2
from planner.motion.cloth_surface import ClothAlone, spread_cloth
from planner.task.plan import Plan
from planner.task.scene import Scene

UPDATES_PER_S = 30.0
"""Updates of a 3D view that someone watches (1/s)."""

_UNWATCHED_PERIOD_S = 0.25
"""Period of the updates while nobody watches (s)."""

PATIENCE_S = 0.3
"""Time for which the 3D view waits for the plan of a changed drawing, to show both at once (s).

Drawing the 3D view is the most expensive work of a browser, and the board comes first.
"""

REST_S = 0.4
"""Pause in a gesture after which a 3D view drawn by software follows it (s)."""

PREVIEW_S = 6.0
"""Time in which the plan of a change that is pointed at is shown (s)."""

_CLOSING_S = 1.0
"""Time to wait for the thread to end (s)."""

_log = logging.getLogger(__name__)


class Player:
    """A thread with exclusive access to a 3D view.

    It also handles the requests of the 3D view's visitors, before it draws.
    """

    def __init__(self, document: Document | VisitorsView, view: View3D, sessions: Sessions | None = None) -> None:
        """Start showing at once; `close` ends it.

        Args:
            document: the document, or the view of it that visitors have.
            view: the 3D view.
            sessions: the cameras of those who look at it.
        """
        self._document = document
        self._view = view
        self._sessions = sessions
        self._changed = threading.Event()
        self._is_closed = False
        self._due_s = 0.0
        self._waits_until_s: float | None = None
        self._moved: tuple[int, float] | None = None
        self._shown: DocumentState | None = None
        self._plan: Plan | None = None
        self._spread: Garment | None = None
        self._bare: tuple[str, Pose2] | None = None
        self._preview: tuple[ShownPlan | ClothAlone, float] | None = None
        self._is_previewing = True
        self._over_s: float | None = None
        self._is_withdrawing = False
        self._changed.set()
        self._unsubscribe = document.subscribe(self._changed.set)
        if sessions is not None:
            sessions.on_queued(self._changed.set)
        self._thread = threading.Thread(target=self._run, name="player", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop showing."""
        self._unsubscribe()
        self._is_closed = True
        self._changed.set()
        self._thread.join(_CLOSING_S)

    def _run(self) -> None:
        """Update the 3D view in a loop; after a failure redraw everything once, then at the next change."""
        has_failed = False
        while True:
            self._changed.wait(self._period_s())
            if self._is_closed:
                return
            self._changed.clear()
            try:
                self._update()
            except Exception:
                _log.exception("the 3D view could not be brought up to date")
                self._shown = self._plan = self._spread = self._bare = None
                if not has_failed:
                    self._changed.set()
                has_failed = True
            else:
                has_failed = False

    def _period_s(self) -> float | None:
        """Return the time to wait if nothing changes (s); None for no limit."""
        now_s = time.monotonic()
        state = self._document.state
        is_moving = state.playback.is_playing or self._is_withdrawing
        if not (self._is_previewing if state.preview is not None else is_moving):
            return None if self._waits_until_s is None else max(0.0, self._waits_until_s - now_s)
        period_s = 1.0 / UPDATES_PER_S if self._view.has_watchers else _UNWATCHED_PERIOD_S
        self._due_s = max(self._due_s + period_s, now_s)
        return self._due_s - now_s

    def _update(self) -> None:
        if self._sessions is not None:
            self._sessions.work()
        state = self._document.state
        self._show(state)
        if self._sessions is not None:
            self._sessions.show(state)

    def _show(self, state: DocumentState) -> None:
        shown, self._shown = self._shown, state
        over_s, self._over_s = self._over_s, None
        self._is_withdrawing = False
        if shown is None or shown.is_dark != state.is_dark:
            self._view.set_theme(is_dark=state.is_dark)
        if state.preview is not None:
            self._show_preview(state, state.preview)
            return
        self._preview, self._is_previewing = None, True
        if self._is_to_rest(state):
            return
        if state.shown is None or self._has_left(state, state.shown):
            self._show_spread(state)
            return
        if self._plan is not state.shown.plan:
            self._plan = state.shown.plan
            self._set(state.shown.plan.task.robot, state.shown.plan.scene)
            self._view.show_plan(state.shown.plan)
        self._spread = self._bare = self._waits_until_s = None
        frame = state.shown.timeline.at(self._document.t_s)
        if 0.0 < state.shown.timeline.duration_s <= frame.t_s:
            now_s = time.monotonic()
            self._over_s = now_s if over_s is None else over_s
            self._is_withdrawing = now_s < self._over_s + LASTS_S
            frame = withdrawn(shown_robot(state.shown.plan.task.robot), frame, now_s - self._over_s)
        self._view.show(frame, state.trace)
        self._document.stop_at_end()

    def _show_preview(self, state: DocumentState, shown: ShownPlan | ClothAlone) -> None:
        """Show a change that is pointed at, in a few seconds from its start; it stays at its end."""
        now_s = time.monotonic()
        if self._preview is None or self._preview[0] is not shown:
            self._preview, self._is_previewing = (shown, now_s), True
            self._plan = self._spread = self._bare = self._waits_until_s = None
            if isinstance(shown, ShownPlan):
                self._plan = shown.plan
                self._set(shown.plan.task.robot, shown.plan.scene)
                self._view.show_plan(shown.plan)
            else:
                self._set(state.drawing.robot, state.drawing.scene)
        share = min((now_s - self._preview[1]) / PREVIEW_S, 1.0)
        self._is_previewing = share < 1.0
        if isinstance(shown, ShownPlan):
            self._view.show(shown.timeline.at(share * shown.timeline.duration_s))
        else:
            cloth, done = shown.at(share)
            self._view.show_garment(shown.sequence.garment, cloth, state.waiting_base, done)

    def _is_to_rest(self, state: DocumentState) -> bool:
        """Return whether to leave the 3D view as it is, because drawing it would slow down a gesture."""
        if state.draft.gesture is None or not self._view.is_drawn_by_software:
            if self._moved is not None:
                self._moved = self._waits_until_s = None
            return False
        now_s = time.monotonic()
        if self._moved is None or self._moved[0] != state.version:
            self._moved = (state.version, now_s)
        rests_at_s = self._moved[1] + REST_S
        self._waits_until_s = rests_at_s if now_s < rests_at_s else None
        return now_s < rests_at_s

    def _has_left(self, state: DocumentState, shown: ShownPlan) -> bool:
        """Return whether the drawing has changed while the plan stands at its start: then show the cloth as drawn."""
        return shown.version != state.version and not state.playback.is_playing and self._document.t_s == 0.0

    def _show_spread(self, state: DocumentState) -> None:
        """Show the garment spread out; while the drawing is invalid, leave the 3D view as it is."""
        spread, scene, base = state.solution.spread, state.drawing.scene, state.waiting_base
        if spread is None:
            if not state.drawing.outline or (self._plan is None and self._spread is None):
                self._show_bare(state.drawing.robot, scene, base)
            return
        if spread is self._spread or self._is_to_wait(state):
            return
        self._spread, self._plan, self._bare, self._waits_until_s = spread, None, None, None
        self._set(state.drawing.robot, scene)
        self._view.show_garment(spread, spread_cloth(spread, scene.table), base)

    def _show_bare(self, robot: str, scene: Scene, base: Pose2) -> None:
        """Show the robot at a table without cloth, for an empty or still invalid drawing."""
        if (robot, base) != self._bare:
            self._spread, self._plan, self._bare, self._waits_until_s = None, None, (robot, base), None
            self._set(robot, scene)
            self._view.show_bare(base)

    def _set(self, robot: str, scene: Scene) -> None:
        """Set the 3D view with a robot and a scene; both stay where they are the same."""
        self._view.show_scene(scene)
        self._view.show_robot(shown_robot(robot))

    def _is_to_wait(self, state: DocumentState) -> bool:
        """Return whether a plan for the drawing will come soon, and the 3D view has something to show until then."""
        answer = state.answer if state.is_answered else None
        has_plan_soon = state.is_planning or (answer is not None and answer.plan.is_solved)
        if not has_plan_soon or (self._spread is None and self._plan is None):
            return False
        now_s = time.monotonic()
        self._waits_until_s = self._waits_until_s or now_s + PATIENCE_S
        return now_s < self._waits_until_s
