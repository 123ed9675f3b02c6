"""Writes a plan's animation as one glTF file: the robot, the table and the cloth, for any viewer of 3-D models.

Cloth is cut anew wherever it bends, so that its triangles change from moment to moment and no morph target could follow
them: there is a mesh for each of its shapes, all in one place, of which an animated scale shows one at a time.
"""

import math

import numpy as np

from app.files.gltf_writer import GltfWriter
from app.files.scene_animation import add_table_and_robot
from app.ui.colours import LIGHT
from app.ui.robot_model import Pose3
from app.ui.thick_cloth import ThickCloth
from planner.deadline import ShouldStop
from planner.motion.cloth_surface import ClothSurface
from planner.motion.timeline import Timeline
from planner.task.plan import Plan

CLOTH_HZ = 15.0
"""The most shapes of the cloth in a second."""

_UPRIGHT = Pose3(wxyz=(math.sqrt(0.5), -math.sqrt(0.5), 0.0, 0.0))
"""Turns z up, as robots have it, to y up, as glTF has it."""


def animation_glb(plan: Plan, should_stop: ShouldStop) -> bytes:
    """Return a solved plan's animation as a binary glTF file; empty if stopped before the end.

    Raises:
        UnsolvedPlanError: the plan is not solved.
    """
    timeline = Timeline.of(plan)
    writer = GltfWriter(plan.garment.title)
    world = writer.node("table frame", None, _UPRIGHT)
    add_table_and_robot(writer, world, plan, timeline.trajectory)
    if not _cloth(writer, world, timeline, should_stop):
        return b""
    return writer.file()


def _cloth(writer: GltfWriter, world: int, timeline: Timeline, should_stop: ShouldStop) -> bool:
    """Add each shape of the cloth for the time in which it is seen; return False if stopped."""
    root = writer.node("cloth", world)
    front, back = writer.material("cloth front", LIGHT.cloth_front), writer.material("cloth back", LIGHT.cloth_back)
    shapes: list[tuple[float, ClothSurface]] = []
    for sample in timeline.samples(CLOTH_HZ):
        if should_stop():
            return False
        if not shapes or shapes[-1][1] is not sample.cloth:
            shapes.append((sample.t_s, sample.cloth))
    ends = [t_s for t_s, _ in shapes[1:]] + [math.inf]
    for number, ((start_s, cloth), end_s) in enumerate(zip(shapes, ends, strict=True)):
        shape = ThickCloth(cloth, timeline.plan.garment.layer_m)
        mesh = writer.two_sided(shape.vertices, shape.normals, shape.triangles, front, back)
        seen = [(start_s, 1.0)] if start_s == 0.0 else [(0.0, 0.0), (start_s, 1.0)]
        seen += [(end_s, 0.0)] if math.isfinite(end_s) else []
        scale = (seen[0][1],) * 3
        node = writer.node(f"cloth {number}", root, scale=scale, mesh=mesh)
        if len(seen) > 1:
            times_s, scales = np.array(seen).T
            writer.animate(node, "scale", times_s, np.tile(scales[:, None], 3), "STEP")
    return True
