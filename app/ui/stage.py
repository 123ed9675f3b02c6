"""The stage: shows the frames of a timeline on a viser server of its own.

There may be several, one for each open document. A stage is written to by one thread at a time; the browser
follows. It knows nothing of clocks: whoever owns it says which frame to show.
"""

import numpy as np

from app.ui.cloth_view import ClothView
from app.ui.colours import LIGHT, Palette
from app.ui.fold_view import FoldView
from app.ui.grip_view import GripView
from app.ui.private_viser import start_private_viser
from app.ui.progress import Stint, stints
from app.ui.robot_view import RobotView
from app.ui.table_view import TableView
from planner.cloth.garment import Garment
from planner.geometry.pose import Pose2
from planner.plan.frame import ClothSurface, Frame
from planner.plan.plan import Plan
from planner.primitives.scene import Scene
from planner.robot.card import RobotCard

CAMERA_FROM = (1.05, 1.55, 1.45)
CAMERA_TO = (-0.45, 0.0, 0.1)
CAMERA_FOV_RAD = 0.72
LIGHT_INTENSITY = 0.7

_AT_REST_M = 0.05


class Stage:
    """A 3-D view of one scene with its robot.

    Attributes:
        scene: the scene that is shown.
        port: the loopback port of its viser server.
        secret: what that port wants to hear (see `app.ui.private_viser`).
    """

    def __init__(self, card: RobotCard, scene: Scene, palette: Palette = LIGHT) -> None:
        """Start a server and build everything that is always there; about half a second the first time."""
        self.scene = scene
        self._card = card
        self._server, self.secret = start_private_viser()
        self.port = self._server.get_port()
        self._look(palette)
        floor_z_m = -scene.table.height_m
        with self._server.atomic():
            TableView(self._server, scene, palette)
            self._cloth = ClothView(self._server, palette)
            self._folds = FoldView(self._server, scene.table, palette)
            self._grips = GripView(self._server, [arm.name for arm in card.arms], floor_z_m, palette)
            self._robot = RobotView(self._server, card, floor_z_m, palette)
        self._stints: tuple[Stint, ...] = ()
        self._primitive: int | None = None
        self._height_m = 0.0

    @property
    def has_watchers(self) -> bool:
        """Whether any browser shows this stage now."""
        return bool(self._server.get_clients())

    def show_garment(self, garment: Garment, cloth: ClothSurface, base: Pose2) -> None:
        """Show a garment that lies there and has no plan, and the robot waiting at a station."""
        with self._server.atomic():
            self._begin(garment, ())
            self._robot.pose(base, self._waiting_joints())
            self._cloth.show(cloth)
            self._grips.show(None)
            self._folds.place(garment.placement, _top_at_rest(cloth), frozenset(), None)
        self._server.flush()

    def show_plan(self, plan: Plan) -> None:
        """Take up another plan; `show` then shows its frames."""
        with self._server.atomic():
            primitives = [primitive.to_dict() for primitive in plan.primitives]
            self._begin(plan.garment, stints(plan.garment.placement, primitives))

    def show(self, frame: Frame) -> None:
        """Show one moment of the plan."""
        with self._server.atomic():
            self._robot.pose(frame.base, frame.joints)
            self._cloth.show(frame.cloth)
            if self._stints:
                self._show_stint(frame)
        self._server.flush()

    def close(self) -> None:
        """Stop the server; whoever watches is cut off."""
        self._server.stop()

    def _look(self, palette: Palette) -> None:
        self._server.gui.configure_theme(show_logo=False, show_share_button=False)
        self._server.scene.configure_environment_map("city", environment_intensity=LIGHT_INTENSITY)
        camera = self._server.initial_camera
        camera.position, camera.look_at = CAMERA_FROM, CAMERA_TO
        camera.fov = CAMERA_FOV_RAD

    def _waiting_joints(self) -> dict[str, float]:
        homes = [np.array(arm.home) for arm in self._card.arms]
        return self._card.joint_values(self.scene.torso_m, homes, [0.0] * len(homes))

    def _begin(self, garment: Garment, plan: tuple[Stint, ...]) -> None:
        self._stints = plan
        self._primitive = None
        self._folds.show_garment(garment)

    def _show_stint(self, frame: Frame) -> None:
        stint = self._stints[frame.primitive]
        if frame.primitive != self._primitive:
            self._primitive = frame.primitive
            self._height_m = _top_at_rest(frame.cloth)
            self._grips.show(stint.primitive)
        is_last_moment = frame.t_s >= stint.primitive["start_s"] + stint.primitive["duration_s"]
        done = stint.done_after if is_last_moment else stint.done
        self._folds.place(stint.placement_with(frame.base), self._height_m, done, stint.fold)


def _top_at_rest(cloth: ClothSurface) -> float:
    """How high the cloth that lies is stacked (m), parts in the air left out."""
    heights = cloth.vertices[:, 2]
    lying = heights[heights < _AT_REST_M]
    return float(np.max(lying, initial=0.0))
