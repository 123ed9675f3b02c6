"""Writes a plan's animation as a USD stage: robot, table and cloth, for Isaac Sim, Omniverse, Blender and their like.

Unlike in glTF, where cloth is a mesh for each of its shapes, here it is one mesh whose points move: those of the mesh
that a rehearsal simulates, the triangles always the same.
"""

import tempfile
from itertools import count
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdShade, Vt

from app.files.scene_animation import AT_PARENT, FULL_SIZE, Moved, add_table_and_robot
from app.rehearsal.physics.fabric import Resolution
from app.ui.colours import LIGHT, Rgb, linear
from app.ui.robot_model import Pose3
from planner.deadline import ShouldStop
from planner.geometry.pose import FloatArray, Point3
from planner.geometry.woven_mesh import woven_mesh
from planner.motion.cloth_surface import ClothPoints
from planner.motion.timeline import Timeline
from planner.task.plan import Plan

CLOTH_HZ = 15.0
"""The samples of the cloth in a second."""

CODES_PER_S = 60.0
"""The stage's time codes in a second."""

_ROOT = Sdf.Path("/World")
_ROUGHNESS = 0.8


def usd_scene(plan: Plan, should_stop: ShouldStop) -> bytes:
    """Return a solved plan's animation as a binary USD file; empty if stopped before the end.

    Raises:
        UnsolvedPlanError: the plan is not solved.
    """
    timeline = Timeline.of(plan)
    writer = _UsdWriter(plan.garment.title, timeline.duration_s)
    add_table_and_robot(writer, None, plan, timeline.trajectory)
    pattern, triangles = woven_mesh(plan.garment.pattern, Resolution.of(plan.garment.pattern.area).edge_m)
    points = ClothPoints(plan.sequence, pattern)
    cloth = writer.cloth("cloth", pattern, triangles)
    for sample in timeline.samples(CLOTH_HZ):
        if should_stop():
            return b""
        cloth.GetPointsAttr().Set(_vectors(points.at(timeline.cloth_at(sample.t_s))), sample.t_s * CODES_PER_S)
    return writer.file()


class _UsdWriter:
    """A stage being built; a `SceneWriter` whose nodes, meshes and materials are indices into lists of prims."""

    def __init__(self, title: str, duration_s: float) -> None:
        self._stage = Usd.Stage.CreateInMemory()
        self._stage.SetMetadata("comment", title)
        UsdGeom.SetStageUpAxis(self._stage, UsdGeom.Tokens.z)
        UsdGeom.SetStageMetersPerUnit(self._stage, 1.0)
        self._stage.SetTimeCodesPerSecond(CODES_PER_S)
        self._stage.SetStartTimeCode(0.0)
        self._stage.SetEndTimeCode(duration_s * CODES_PER_S)
        self._stage.SetDefaultPrim(UsdGeom.Xform.Define(self._stage, _ROOT).GetPrim())
        self._nodes: list[UsdGeom.Xform] = []
        self._meshes: list[UsdGeom.Mesh] = []
        self._materials: dict[tuple[str, Rgb], UsdShade.Material] = {}

    def material(self, name: str, rgb: Rgb) -> int:
        if (name, rgb) in self._materials:
            return list(self._materials).index((name, rgb))
        material = UsdShade.Material.Define(self._stage, self._free(_ROOT.AppendChild("materials"), name))
        shader = UsdShade.Shader.Define(self._stage, material.GetPath().AppendChild("surface"))
        shader.CreateIdAttr("UsdPreviewSurface")
        shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(*linear(rgb)))
        shader.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(_ROUGHNESS)
        material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
        self._materials[name, rgb] = material
        return len(self._materials) - 1

    def mesh(
        self, vertices: FloatArray, triangles: NDArray[np.int64], material: int, normals: FloatArray | None = None
    ) -> int:
        # A class is not shown itself, only where a prim refers to it.
        path = self._free(_ROOT.AppendChild("meshes"), f"mesh_{len(self._meshes)}")
        self._stage.CreateClassPrim(path.GetParentPath())
        mesh = self._mesh(path, triangles, material)
        mesh.CreatePointsAttr(_vectors(vertices))
        mesh.CreateExtentAttr(_vectors(np.array([vertices.min(axis=0), vertices.max(axis=0)])))
        if normals is not None:
            mesh.CreateNormalsAttr(_vectors(normals))
            mesh.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
        self._meshes.append(mesh)
        return len(self._meshes) - 1

    def node(
        self, name: str, parent: int | None, pose: Pose3 = AT_PARENT, scale: Point3 = FULL_SIZE, mesh: int | None = None
    ) -> int:
        path = self._free(_ROOT if parent is None else self._nodes[parent].GetPath(), name)
        node = UsdGeom.Xform.Define(self._stage, path)
        node.AddTranslateOp().Set(Gf.Vec3d(*pose.position))
        node.AddOrientOp().Set(Gf.Quatf(*map(float, pose.wxyz)))
        node.AddScaleOp().Set(Gf.Vec3f(*scale))
        if mesh is not None:
            shown = self._stage.DefinePrim(path.AppendChild("mesh"))
            shown.GetReferences().AddInternalReference(self._meshes[mesh].GetPath())
        self._nodes.append(node)
        return len(self._nodes) - 1

    def animate(self, node: int, what: Moved, times_s: FloatArray, values: FloatArray) -> None:
        translate, orient, scale = self._nodes[node].GetOrderedXformOps()
        for t_s, row in zip(times_s.tolist(), values.tolist(), strict=True):
            if what == "rotation":
                x, y, z, w = row
                orient.Set(Gf.Quatf(w, x, y, z), t_s * CODES_PER_S)
            elif what == "translation":
                translate.Set(Gf.Vec3d(*row), t_s * CODES_PER_S)
            else:
                scale.Set(Gf.Vec3f(*row), t_s * CODES_PER_S)

    def cloth(self, name: str, pattern: FloatArray, triangles: NDArray[np.int64]) -> UsdGeom.Mesh:
        """Add a mesh that is seen from both sides, without points yet; textured by the pattern (m)."""
        mesh = self._mesh(self._free(_ROOT, name), triangles, self.material("cloth front", LIGHT.cloth_front))
        mesh.CreateDoubleSidedAttr(True)
        primvars = UsdGeom.PrimvarsAPI(mesh)
        st = primvars.CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.vertex)
        st.Set(Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(pattern, dtype=np.float32)))
        return mesh

    def file(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scene.usd"
            self._stage.GetRootLayer().Export(str(path))
            return path.read_bytes()

    def _mesh(self, path: Sdf.Path, triangles: NDArray[np.int64], material: int) -> UsdGeom.Mesh:
        mesh = UsdGeom.Mesh.Define(self._stage, path)
        mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
        mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(triangles), 3, dtype=np.int32)))
        mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(triangles.reshape(-1).astype(np.int32)))
        (_, rgb), prim = list(self._materials.items())[material]
        mesh.CreateDisplayColorAttr([Gf.Vec3f(*linear(rgb))])
        UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(prim)
        return mesh

    def _free(self, parent: Sdf.Path, name: str) -> Sdf.Path:
        """Return a path below a prim for a name, made an identifier that no sibling has."""
        wanted = Tf.MakeValidIdentifier(name)
        names = (f"{wanted}_{number}" if number else wanted for number in count())
        return next(path for path in map(parent.AppendChild, names) if not self._stage.GetPrimAtPath(path))


def _vectors(rows: FloatArray) -> Vt.Vec3fArray:
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(rows, dtype=np.float32))
