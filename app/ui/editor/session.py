"""One visitor's session in the 3D view: editor, panels, aids, and the surface that catches the pointer."""

import math
from collections.abc import Callable

import numpy as np
import viser

from app.document import Document
from app.document_state import DocumentState
from app.drawing.ring import ring_of
from app.language import say
from app.shown_robot import shown_robot
from app.ui.colours import DARK, LIGHT
from app.ui.editor.aids_view import AidsView
from app.ui.editor.aim import Aim, pixel_angle
from app.ui.editor.camera_panel import CameraPanel
from app.ui.editor.edit_panel import EditPanel
from app.ui.editor.editor import Editor
from app.ui.editor.following import Following, work_of
from app.ui.editor.ground import Ground, on_table
from app.ui.editor.pointer_capture import PointerCapture, Touch
from app.ui.editor.presets import Preset, robots_eye, side, top
from app.ui.grip_view import ROOT as MARKS
from app.ui.opening import opening as opening_of
from app.ui.viewpoint import Viewpoint
from app.ui.viser_patches import PANEL
from planner.geometry.pose import Pose2

_PANEL_PX = 250
_PANEL_GAP_PX = 15
_ZOOM_STEP = 1.2

Enqueue = Callable[[Callable[[], None], bool], None]
"""Hands an action to the 3D view's own thread; a passing action may be replaced by a later one."""


class Session:
    """The parts of one visitor; the 3D view's own thread makes and uses them, viser's thread only adds actions."""

    def __init__(self, client: viser.ClientHandle, document: Document, opening: Viewpoint, enqueue: Enqueue) -> None:
        """Build panels and aids; the panels are closed at first, and lie where there is mostly no cloth.

        Args:
            client: the visitor.
            document: the document that is edited.
            opening: the opening viewpoint.
            enqueue: the function that hands an action to the 3D view's own thread.
        """
        self._client = client
        self._document = document
        self._enqueue = enqueue
        self._editor = Editor(document, f"view3d.{client.client_id}")
        self._zoom = 0
        self._is_dark = document.state.is_dark
        self._is_from_right = False
        self._robot = document.state.drawing.robot
        self._following: Following | None = None
        self._language = language = document.state.language
        with client.atomic():
            client.gui.set_panel_label(say(language, PANEL))
            client.gui.main_panel.float(x=-_PANEL_GAP_PX, y=-_PANEL_GAP_PX, width=_PANEL_PX)
            client.gui.main_panel.minimize()
            self._edit_panel = EditPanel(client, language, lambda act: enqueue(lambda: act(self._editor), False))
            self._camera_panel = CameraPanel(
                client, language, opening, lambda preset: enqueue(lambda: self._look(preset), False)
            )
            self._aids = AidsView(client, DARK if self._is_dark else LIGHT)
            self._capture = PointerCapture(client, self._touched)
            self._marks = client.scene.add_frame(MARKS, show_axes=False)
        self._open()
        client.camera.on_update(self._camera_changed)

    def show(self, state: DocumentState) -> None:
        """Update panels, aids and camera."""
        self._zoom = self._zoom_now
        with self._client.atomic():
            if state.is_dark != self._is_dark:
                self._is_dark = state.is_dark
                self._aids.recolour(DARK if state.is_dark else LIGHT)
            self._capture.catch(is_on=self._editor.is_drawing)
            if self._marks.visible == self._editor.is_drawing:
                self._marks.visible = not self._editor.is_drawing
            self._aids.show(self._editor.aids, _ZOOM_STEP**self._zoom)
            self._edit_panel.show(self._editor)
            if state.language != self._language:
                self._language = state.language
                self._client.gui.set_panel_label(say(state.language, PANEL))
                self._camera_panel.speak(state.language)
            self._follow(state)
        self._client.flush()

    def leave(self) -> None:
        """End the visitor's editing."""
        self._editor.leave()

    def _touched(self, touch: Touch, aim: Aim | None) -> None:
        editor = self._editor
        act = {"press": editor.press, "drag": editor.drag, "release": editor.release, "tap": editor.tap}[touch]
        self._enqueue(lambda: act(aim), touch == "drag")

    def _open(self) -> None:
        """Show table and robot whole, whatever the picture's shape, until the visitor moves the camera."""
        state = self._document.state
        scene, panel = state.drawing.scene, self._camera_panel
        base, card = self._starting_base(state), shown_robot(state.drawing.robot)
        panel.open_on(opening_of(scene, panel.lens.aspect, base, is_from_right=self._is_from_right, card=card))

    def _follow(self, state: DocumentState) -> None:
        """Move the camera with the robot's head, or to the side of the table where the robot does not stand."""
        if self._camera_panel.is_riding:
            self._camera_panel.ride(self._moving_view(state))
            return
        if state.drawing.robot != self._robot:
            self._robot = state.drawing.robot
            self._open()
        aside_m, beside_m = self._base(state).y_m, state.drawing.scene.table.width_m / 2
        if abs(aside_m) > beside_m and self._is_from_right != (aside_m > 0.0):
            self._is_from_right = aside_m > 0.0
            self._open()

    def _look(self, preset: Preset) -> None:
        panel, state = self._camera_panel, self._document.state
        scene = state.drawing.scene
        match preset:
            case Preset.FREE:
                panel.go_back()
            case Preset.TOP:
                panel.go_to(top(Ground.of(state.drawing), panel.lens))
            case Preset.SIDE:
                panel.go_to(side(panel.lens, scene.table))
            case Preset.ROBOT | Preset.FOLLOW:
                self._following = Following() if preset is Preset.FOLLOW else None
                panel.ride(self._moving_view(state))

    def _moving_view(self, state: DocumentState) -> Viewpoint:
        """Return where the camera that follows the work, or that rides on the robot's head, is now."""
        if self._following is None:
            return self._robots_eye(state)
        points = on_table(state.drawing, ring_of(state.drawing.outline).points) or state.drawing.scene.table.corners
        x, y = np.array(points).mean(axis=0)
        work = (float(x), float(y)) if state.shown is None else work_of(state.shown, self._document.t_s)
        return self._following.view(self._base(state), work, self._camera_panel.lens)

    def _robots_eye(self, state: DocumentState) -> Viewpoint:
        """Return the view from the robot's head where it stands now."""
        scene, aspect, card = state.drawing.scene, self._camera_panel.lens.aspect, shown_robot(state.drawing.robot)
        points = on_table(state.drawing, ring_of(state.drawing.outline).points) or scene.table.corners
        return robots_eye(card, self._base(state), points, aspect, scene.torso_m, -scene.table.height_m)

    def _base(self, state: DocumentState) -> Pose2:
        """Return where the robot stands now."""
        if state.shown is not None:
            return state.shown.timeline.base_at(self._document.t_s)
        return self._starting_base(state)

    @staticmethod
    def _starting_base(state: DocumentState) -> Pose2:
        """Return where the robot waits before a plan begins."""
        stations = dict(state.drawing.scene.stations)
        return stations.get(state.drawing.start_station) or next(iter(stations.values()))

    async def _camera_changed(self, _: viser.CameraHandle) -> None:
        if self._camera_panel.is_opening:
            self._enqueue(self._open, False)
        if self._editor.is_drawing and self._zoom_now != self._zoom:
            self._enqueue(lambda: None, False)

    @property
    def _zoom_now(self) -> int:
        """The size of a pixel in the middle of the table, in coarse steps, so that handles change only now and then."""
        camera = self._client.camera
        x, y, z = camera.position
        pixel_m = math.hypot(x, y, z) * pixel_angle(camera.fov, camera.image_height)
        return round(math.log(max(pixel_m, 1e-6), _ZOOM_STEP))
