"""The robot in the 3D view: one scene node for each link, moved by its joint."""

import viser

from app.ui.colours import Palette, Rgb
from app.ui.lighting import paint
from app.ui.robot_model import Link, load_robot_model
from app.ui.rotation import yaw
from planner.geometry.pose import Pose2
from planner.robots.card import RobotCard

ROOT = "/robot"

_DARK_PARTS = ("wheel", "finger", "laser", "stereo", "high_def", "imu", "head_plate")
_GREY_PARTS = ("caster", "wrist", "gripper", "elbow", "forearm_roll", "upper_arm_roll", "torso", "head")


class RobotView:
    """Shows a robot with its meshes; its base drives on the floor.

    Attributes:
        hands: the node between the fingertips of each arm, by the arm's name; nodes below it move along.
    """

    def __init__(self, server: viser.ViserServer, card: RobotCard, floor_z_m: float) -> None:
        """Build the nodes, every joint at zero and the base at the origin.

        Args:
            server: where to build them.
            card: the robot.
            floor_z_m: the floor's height in the table frame (m), negative.
        """
        self._floor_z_m = floor_z_m
        self._root = server.scene.add_frame(ROOT, show_axes=False, position=(0.0, 0.0, floor_z_m))
        self._base: tuple[Pose2, float] | None = None
        self._shown: dict[str, float] = {}
        self._moved: dict[str, list[tuple[Link, viser.FrameHandle]]] = {}
        self._painted: list[tuple[str, viser.MeshHandle]] = []
        nodes: dict[str, str] = {}
        for link in load_robot_model(card.urdf_path, card.package_dir):
            nodes[link.name] = ROOT + link.node
            handle, meshes = _add_link(server, link)
            self._painted.extend((link.name, mesh) for mesh in meshes)
            if link.joint is not None:
                self._moved.setdefault(link.joint, []).append((link, handle))
        self.hands = {arm.name: nodes[arm.tool_frame] for arm in card.arms}

    def remove(self) -> None:
        """Remove the robot."""
        self._root.remove()

    def stand_on(self, floor_z_m: float) -> None:
        """Set the floor's height (m), from the next pose on."""
        self._floor_z_m = floor_z_m

    def recolour(self, palette: Palette) -> None:
        """Change to other colours."""
        for link_name, mesh in self._painted:
            mesh.color = paint(link_colour(link_name, palette))

    def pose(self, base: Pose2, joints: dict[str, float]) -> None:
        """Set the base's pose (table frame) and the joints (rad, m); ignore unknown names."""
        if self._base != (base, self._floor_z_m):
            self._base = (base, self._floor_z_m)
            self._root.position = (base.x_m, base.y_m, self._floor_z_m)
            self._root.wxyz = yaw(base.yaw_rad)
        for name, value in joints.items():
            if name in self._moved and self._shown.get(name) != value:
                self._shown[name] = value
                for link, handle in self._moved[name]:
                    if link.is_prismatic:
                        handle.position = link.pose_at(value).position
                    else:
                        handle.wxyz = link.pose_at(value).wxyz


def _add_link(server: viser.ViserServer, link: Link) -> tuple[viser.FrameHandle, list[viser.MeshHandle]]:
    node = ROOT + link.node
    origin = link.origin
    handle = server.scene.add_frame(node, show_axes=False, position=origin.position, wxyz=origin.wxyz)
    meshes = [
        server.scene.add_mesh_simple(
            f"{node}/visual_{index}",
            visual.vertices,
            visual.triangles,
            position=visual.pose.position,
            wxyz=visual.pose.wxyz,
        )
        for index, visual in enumerate(link.visuals)
    ]
    return handle, meshes


def link_colour(link_name: str, palette: Palette) -> Rgb:
    """Return the colour of a link, by its name."""
    if any(part in link_name for part in _DARK_PARTS):
        return palette.robot_dark
    if any(part in link_name for part in _GREY_PARTS):
        return palette.robot_grey
    return palette.robot_light
