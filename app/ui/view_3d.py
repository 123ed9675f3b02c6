"""The 3D view: shows the samples of a timeline on a viser server of its own.

There may be several, one for each open document. One thread at a time writes to a 3D view; the browser follows. A 3D
view knows no clock: its owner tells it which sample to show.
"""

import threading
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import viser
from viser.infra import StateSerializer

from app.rehearsal.trace import RunTrace
from app.ui.cloth_view import ClothView
from app.ui.colours import DARK, LIGHT
from app.ui.fold_view import FoldView
from app.ui.grip_view import GripView
from app.ui.lighting import add_lights
from app.ui.opening import opening
from app.ui.robot_model import waiting_box
from app.ui.robot_view import RobotView
from app.ui.simulated_view import SimulatedView
from app.ui.table_view import TableView
from app.ui.viewpoint import Viewpoint
from app.ui.viser_patches import start_private_viser
from planner.cloth.garment import Garment
from planner.geometry.pose import Pose2
from planner.geometry.table import TableTop
from planner.geometry.tolerance import TIME_S
from planner.motion.cloth_surface import ClothSurface
from planner.motion.timeline import Sample
from planner.robots.card import RobotCard
from planner.task.plan import Plan, PlanStep
from planner.task.scene import Scene

_SQUARE = 1.0
"""Aspect assumed before a browser looks; what is whole in a square is whole in every wider picture."""


class View3D:
    """A 3-D view of one scene with its robot.

    Attributes:
        card: the robot that is shown.
        scene: the scene that is shown.
        opening: the opening viewpoint of each new visitor.
        port: the loopback port of its viser server.
        secret: the secret that the port requires (see `app.ui.viser_patches`).
    """

    def __init__(self, card: RobotCard, scene: Scene) -> None:
        """Start a server and build everything that is always there; about half a second the first time."""
        self.scene = scene
        self.opening: Viewpoint = opening(scene, _SQUARE, card=card)
        self.card = card
        self._server, self.secret = start_private_viser()
        self.port = self._server.get_port()
        with self._server.atomic():
            self._look()
            self._table = TableView(self._server, self.scene)
            self._cloth = ClothView(self._server.scene)
            self._folds = FoldView(self._server)
            self._simulated = SimulatedView(self._server.scene)
            self._bring_robot()
        self._palette = LIGHT
        self._caption: viser.LabelHandle | None = None
        self._steps: tuple[PlanStep, ...] = ()
        self._marked: PlanStep | None = None
        self._layer_m = 0.0
        self._lock = threading.Lock()
        self._by_software = 0
        self.set_theme(is_dark=False)

    @property
    def server(self) -> viser.ViserServer:
        """Its viser server."""
        return self._server

    @property
    def has_watchers(self) -> bool:
        """Whether any browser shows this 3D view now."""
        return bool(self._server.get_clients())

    @property
    def is_drawn_by_software(self) -> bool:
        """Whether some browser draws the 3D view on its processor, which takes most of that processor's time."""
        return self._by_software > 0

    @contextmanager
    def drawn_by_software(self) -> Iterator[None]:
        """Mark the 3D view, within the context, as shown by a browser without a graphics card."""
        with self._lock:
            self._by_software += 1
        try:
            yield
        finally:
            with self._lock:
                self._by_software -= 1

    def set_theme(self, *, is_dark: bool) -> None:
        """Use the colours for a dark or a light background."""
        self._palette = palette = DARK if is_dark else LIGHT
        with self._server.atomic():
            self._server.gui.configure_theme(show_logo=False, show_share_button=False, dark_mode=is_dark)
            for view in (self._table, self._cloth, self._folds, self._simulated, self._robot, self._grips):
                view.recolour(palette)
        self._server.flush()

    def show_robot(self, card: RobotCard) -> None:
        """Replace the robot, which takes its place with what is shown next; it stays if it is the same."""
        if card is self.card:
            return
        self.card = card
        with self._server.atomic():
            self._grips.remove()
            self._robot.remove()
            self._bring_robot()
            self._robot.recolour(self._palette)
            self._grips.recolour(self._palette)
        self._marked = None

    def show_scene(self, scene: Scene) -> None:
        """Replace the table; robot and cloth follow with what is shown next."""
        if scene == self.scene:
            return
        self.scene = scene
        with self._server.atomic():
            self._table.remove()
            self._table = TableView(self._server, self.scene)
            self._table.recolour(self._palette)
            for view in (self._robot, self._grips):
                view.stand_on(-scene.table.height_m)

    def show_bare(self, base: Pose2) -> None:
        """Show the robot waiting at a station, and no cloth."""
        with self._server.atomic():
            self._take_up(())
            self._robot.pose(base, self._waiting_joints())
            self._cloth.set_visible(is_visible=False)
            self._folds.clear()
        self._server.flush()

    def show_garment(
        self, garment: Garment, cloth: ClothSurface, base: Pose2, done: frozenset[int] = frozenset()
    ) -> None:
        """Show a garment that has no plan, with some of its folds done, and the robot waiting at a station."""
        with self._server.atomic():
            self._begin(garment, ())
            self._robot.pose(base, self._waiting_joints())
            self._cloth.show(cloth, garment.layer_m)
            self._folds.place(garment.placement, cloth, TableTop.of(self.scene.table), done, None)
        self._server.flush()

    def show_plan(self, plan: Plan) -> None:
        """Take another plan; `show` then shows its samples."""
        with self._server.atomic():
            self._begin(plan.garment, plan.steps)

    def show(self, frame: Sample, trace: RunTrace | None = None) -> None:
        """Show one sample of the plan, and the cloth of a rehearsed run of it at that time."""
        with self._server.atomic():
            self._robot.pose(frame.base, frame.joints)
            self._cloth.show(frame.cloth, self._layer_m)
            self._simulated.show(trace, self._steps, frame.t_s)
            if self._steps:
                self._show_step(frame)
        self._server.flush()

    def caption(self, text: str) -> None:
        """Show a line of text over the table, as high as the waiting robot; an empty one shows none."""
        if self._caption is None:
            height_m = float(waiting_box(self.card, self.scene.torso_m)[1, 2]) - self.scene.table.height_m
            self._caption = self._server.scene.add_label(
                "/caption", text, position=(0.0, 0.0, height_m), font_screen_scale=1.4, anchor="center-center"
            )
        self._caption.text = text
        self._caption.visible = bool(text)

    def record(self) -> StateSerializer:
        """Return a recording of what is shown now and of all later changes; the caller inserts pauses."""
        return self._server.get_scene_serializer()

    def close(self) -> None:
        """Stop the server and disconnect its visitors."""
        self._server.stop()

    def _look(self) -> None:
        add_lights(self._server)
        camera = self._server.initial_camera
        camera.position, camera.look_at = self.opening.position, self.opening.look_at
        camera.fov = self.opening.fov_rad

    def _bring_robot(self) -> None:
        floor_z_m = -self.scene.table.height_m
        self._robot = RobotView(self._server, self.card, floor_z_m)
        self._grips = GripView(self._server, self._robot.hands, floor_z_m)

    def _waiting_joints(self) -> dict[str, float]:
        homes = [np.array(arm.home) for arm in self.card.arms]
        return self.card.joint_values(self.scene.torso_m, homes, [0.0] * len(homes))

    def _begin(self, garment: Garment, steps: tuple[PlanStep, ...]) -> None:
        self._take_up(steps)
        self._cloth.set_visible(is_visible=True)
        self._folds.show_garment(garment)
        self._layer_m = garment.layer_m

    def _take_up(self, steps: tuple[PlanStep, ...]) -> None:
        self._steps = steps
        self._marked = None
        self._grips.show(None)
        self._simulated.show(None, steps, 0.0)

    def _show_step(self, frame: Sample) -> None:
        step = self._steps[frame.primitive]
        is_over = frame.t_s >= step.end_s - TIME_S
        self._mark(None if is_over else step)
        done = frozenset((step.after if is_over else step.before).folds_done)
        self._folds.place(frame.placement, frame.cloth, frame.top, done, None if is_over else step.fold)

    def _mark(self, step: PlanStep | None) -> None:
        if step is not self._marked:
            self._marked = step
            self._grips.show(step.to_dict() if step else None)
