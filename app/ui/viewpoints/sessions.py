"""The sessions of all who look at one 3D view, and what they ask for.

viser calls back in a thread of its own, which must never wait: the callbacks only put requests into a queue. The thread
that draws the 3D view empties the queue, so a single thread moves cameras and draws, without a lock.
"""

import logging
from collections import deque
from collections.abc import Callable

import numpy as np
import viser

from app.document import Document
from app.document_state import DocumentState, shown_robot
from app.drawing.ring import ring_of
from app.ui.opening import opening as opening_of
from app.ui.viewpoint import Viewpoint
from app.ui.viewpoints.following import Following, work_of
from app.ui.viewpoints.presets import Ground, Preset, on_table, robots_eye, side, top
from app.ui.viewpoints.viewpoint_choice import ViewpointChoice
from planner.geometry.pose import Pose2

_log = logging.getLogger(__name__)

Ask = Callable[[Callable[[], None]], None]
"""Hands a request to the thread that draws the 3D view."""


class Session:
    """The camera of one browser; the 3D view's own thread uses it, viser's thread only adds requests."""

    def __init__(self, client: viser.ClientHandle, document: Document, opening: Viewpoint, ask: Ask) -> None:
        """Show cloth and hands.

        Args:
            client: the browser.
            document: the document that is shown.
            opening: the opening viewpoint.
            ask: the function that hands a request to the 3D view's own thread.
        """
        self._client = client
        self._document = document
        self._ask = ask
        self._robot = document.state.drawing.robot
        self._following = Following()
        self._is_robots_eye = False
        with client.atomic():
            self._choice = ViewpointChoice(client, opening, lambda preset: ask(lambda: self._look(preset)))
        self._open()
        client.camera.on_update(self._camera_changed)

    def show(self, state: DocumentState) -> None:
        """Move the camera along with what is shown."""
        with self._client.atomic():
            self._follow(state)
        self._client.flush()

    def _open(self) -> None:
        """Show cloth and hands, or all of a bench, whatever the picture's shape, until the visitor moves the camera."""
        state, choice = self._document.state, self._choice
        card = shown_robot(state.drawing.robot)
        if card.is_fixed:
            choice.open_on(opening_of(state.drawing.scene, choice.lens.aspect, state.waiting_base, card=card))
        else:
            choice.open_on(self._view_of_work(state))

    def _follow(self, state: DocumentState) -> None:
        """Move the camera with the robot's head, or with the work; before the work begins it stands still."""
        if self._choice.is_riding:
            self._choice.ride(self._moving_view(state))
            return
        if state.drawing.robot != self._robot or (state.shown is not None and self._document.t_s > 0.0):
            self._robot = state.drawing.robot
            self._open()

    def _look(self, preset: Preset) -> None:
        choice, state = self._choice, self._document.state
        scene = state.drawing.scene
        match preset:
            case Preset.FREE:
                choice.go_back()
            case Preset.TOP:
                choice.go_to(top(Ground.of(state.drawing), choice.lens))
            case Preset.SIDE:
                choice.go_to(side(choice.lens, scene.table))
            case Preset.ROBOT | Preset.FOLLOW:
                self._is_robots_eye = preset is Preset.ROBOT
                self._following = Following()
                choice.ride(self._moving_view(state))

    def _moving_view(self, state: DocumentState) -> Viewpoint:
        """Return where the camera that follows the work, or that rides on the robot's head, is now."""
        return self._robots_eye(state) if self._is_robots_eye else self._view_of_work(state)

    def _view_of_work(self, state: DocumentState) -> Viewpoint:
        """Return the next viewpoint of the camera that follows the work."""
        points = on_table(state.drawing, ring_of(state.drawing.outline).points) or state.drawing.scene.table.corners
        x, y = np.array(points).mean(axis=0)
        shown, t_s = state.shown, self._document.t_s
        work = (float(x), float(y)) if shown is None else work_of(shown.plan, t_s)
        is_over = shown is not None and 0.0 < shown.timeline.duration_s <= t_s
        return self._following.view(self._base(state), work, self._choice.lens, is_over=is_over)

    def _robots_eye(self, state: DocumentState) -> Viewpoint:
        """Return the view from the robot's head where it stands now."""
        scene, aspect, card = state.drawing.scene, self._choice.lens.aspect, shown_robot(state.drawing.robot)
        points = on_table(state.drawing, ring_of(state.drawing.outline).points) or scene.table.corners
        return robots_eye(card, self._base(state), points, aspect, scene.torso_m, -scene.table.height_m)

    def _base(self, state: DocumentState) -> Pose2:
        """Return where the robot stands now."""
        if state.shown is not None:
            return state.shown.timeline.base_at(self._document.t_s)
        return state.waiting_base

    async def _camera_changed(self, _: viser.CameraHandle) -> None:
        if self._choice.is_opening:
            self._ask(self._open)
        elif self._choice.is_riding:
            self._ask(lambda: self._follow(self._document.state))


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
