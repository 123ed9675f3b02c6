"""The MuJoCo model of a cloth on a table: a mass at each vertex of the mesh, a flex between them, sockets for grips.

Small spheres on the vertices touch the table, and the triangles of other layers: triangles against triangles would be
four times as many contacts, and take four times as long. The table's edges are those of a box, over which cloth hangs.
A socket is a body without dynamics, tied to a vertex while a grip holds it.
"""

import mujoco
import numpy as np
from numpy.typing import NDArray

from app.physics.fabric import Fabric, Resolution
from planner.geometry.pose import FloatArray
from planner.geometry.table import Table

SOCKETS = 64
"""The most vertices that all grips together hold."""

_TABLE_M = 0.05
"""The thickness of the table's top (m)."""

_CLOTH, _BOARD = 2, 1
"""Contact classes of triangles and of the table; a vertex touches both, but not the triangles it is a corner of."""

_STIFF = 'solref="0.01 1" solimp="0.99 0.99 0.001"'
_HELD = 'solref="0.01 1" solimp="0.9999 0.9999 0.001"'
"""Grips must be stiffer than contacts: softer ones let the cloth lag by 12 to 18 mm."""


def model_xml(
    rest: FloatArray, triangles: NDArray[np.int64], fabric: Fabric, resolution: Resolution, table: Table | None
) -> str:
    """Return the model as MJCF.

    Args:
        rest: the vertices of the flat cloth, shape (n, 3), m.
        triangles: shape (m, 3).
        fabric: the cloth.
        resolution: the time step and the solver's effort.
        table: the table; None for none.
    """
    ball = 0.5 * fabric.thickness_m
    masses = fabric.density_kg_m2 * vertex_areas(rest, triangles)
    vertices = "".join(
        f'<body name="v{i}" pos="{x:.9g} {y:.9g} {z:.9g}">{_joints(mass * fabric.drag_per_s)}'
        f'<geom type="sphere" size="{ball}" mass="{mass:.9g}" contype="{_CLOTH}" conaffinity="{_BOARD}" condim="3" '
        f'friction="{fabric.friction} 0 0" {_STIFF}/></body>'
        for i, ((x, y, z), mass) in enumerate(zip(rest.tolist(), masses.tolist(), strict=True))
    )
    sockets = "".join(f'<body name="s{i}" mocap="true" pos="0 0 -9"/>' for i in range(SOCKETS))
    ties = "".join(f'<connect body1="s{i}" body2="v0" anchor="0 0 0" active="false" {_HELD}/>' for i in range(SOCKETS))
    return f"""<mujoco>
<compiler autolimits="true" boundmass="1e-9"/>
<option timestep="{resolution.step_s}" integrator="discrete" solver="CG" iterations="{resolution.iterations}"
 tolerance="{resolution.tolerance}" cone="elliptic" impratio="10"/>
<size memory="400M"/>
<worldbody>{"" if table is None else _board(table, fabric)}{vertices}{sockets}</worldbody>
<deformable><flex name="cloth" dim="2" radius="{ball}" body="{" ".join(f"v{i}" for i in range(len(rest)))}"
 element="{" ".join(map(str, triangles.ravel().tolist()))}">
<contact contype="0" conaffinity="{_CLOTH}" condim="3" friction="{fabric.self_friction} 0 0" {_STIFF} priority="1"
 selfcollide="none"/>
<elasticity young="{fabric.young_pa}" poisson="{fabric.poisson}" damping="{fabric.damping_s}"
 thickness="{fabric.shell_thickness_m}" elastic2d="both"/></flex></deformable>
<equality>{ties}</equality>
</mujoco>"""


def compiled(xml: str) -> mujoco.MjModel:
    """Return the compiled model; its ties pull a vertex onto its socket, whatever the distance at the start was."""
    model = mujoco.MjModel.from_xml_string(xml)
    model.eq_data[:, :6] = 0.0
    return model


def vertex_areas(points: FloatArray, triangles: NDArray[np.int64]) -> FloatArray:
    """Return a third of the area of each vertex's triangles, shape (n,), m^2."""
    first, second = (points[triangles[:, i]] - points[triangles[:, 0]] for i in (1, 2))
    areas = np.linalg.norm(np.cross(first, second), axis=1) / 2.0
    return np.asarray(np.bincount(triangles.ravel(), np.repeat(areas / 3.0, 3), len(points)))


def _joints(damping: float) -> str:
    return "".join(
        f'<joint type="slide" axis="{axis}" damping="{damping:.9g}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1")
    )


def _board(table: Table, fabric: Fabric) -> str:
    size = f"{table.depth_m / 2} {table.width_m / 2} {_TABLE_M / 2}"
    return (
        f'<geom type="box" size="{size}" pos="0 0 {-_TABLE_M / 2}" contype="{_BOARD}" conaffinity="0" condim="3" '
        f'friction="{fabric.friction} 0 0" {_STIFF}/>'
    )
