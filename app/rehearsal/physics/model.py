"""The MuJoCo model of a cloth on a table: a mass at each vertex of the mesh, a flex between them, sockets for grips.

Small spheres on the vertices touch the table, and the triangles of other layers: triangles against triangles would be
four times as many contacts, and take four times as long. The table's edges are round, and triangles touch them too: at
a sharp edge a row that came near was pulled down upon the top, and stayed there however much cloth hung beyond it.
A socket is a body without dynamics, tied to a vertex while a grip holds it.
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.fingers import FingerSize
from planner.geometry.pose import FloatArray
from planner.geometry.table import Table

SOCKETS = 64
"""The largest number of vertices that all grips hold together."""

_TABLE_M = 0.05
"""The thickness of the table's top (m)."""

_CLOTH, _BOARD, _FINGER = 2, 1, 4
"""Contact classes of triangles, table and fingers; a vertex touches all, but not the triangles it is a corner of."""

FREE, IN_HAND = _BOARD | _FINGER, _BOARD
"""What a vertex touches besides triangles; one held in a hand is between its fingers."""

_STIFF = 'solref="0.01 1" solimp="0.99 0.99 0.001"'
_STIFFER = 'solref="0.01 1" solimp="0.99 0.9995 0.0007"'
_NEAR_M = 0.0015
"""Layers nearer to each other than that have contacts that are the stiffer the deeper (m).

Half of that is about what cloth falls in a time step that has lost a contact, and beyond half it is on the far side.
"""

HELD = 'solref="0.01 1" solimp="0.9999 0.9999 0.001"'
"""Grips must be stiffer than contacts: softer ones let the cloth lag by 12 to 18 mm."""

_BALLS, _CLOSED_M = 3, 0.001
"""The balls at the end of a finger, and by how much they are thinner than it on each side (m)."""


def model_xml(
    rest: FloatArray,
    pattern: FloatArray,
    triangles: NDArray[np.int64],
    fabric: Fabric,
    resolution: Resolution,
    table: Table | None,
    fingers: Sequence[FingerSize] = (),
    sockets: int = SOCKETS,
) -> str:
    """Return the model as MJCF.

    Args:
        rest: the vertices of the flat cloth, shape (n, 3), m.
        pattern: the vertices in the frame of warp and weft, shape (n, 2), m.
        triangles: shape (m, 3).
        fabric: the cloth.
        resolution: the time step and the solver's effort.
        table: the table; None for none.
        fingers: the size of each hand's two fingers.
        sockets: how many vertices grips can hold.
    """
    ball, contact = 0.5 * fabric.layer_m, _contact(fabric)
    masses = fabric.density_kg_m2 * vertex_areas(rest, triangles)
    vertices = "".join(
        f'<body name="v{i}" pos="{x:.9g} {y:.9g} {z:.9g}">{_joints(mass * fabric.drag_per_s)}'
        f'<geom type="sphere" size="{ball}" mass="{mass:.9g}" contype="{_CLOTH}" conaffinity="{FREE}" condim="3" '
        f'friction="{fabric.friction} 0 0" {contact}/><site name="p{i}"/></body>'
        for i, ((x, y, z), mass) in enumerate(zip(rest.tolist(), masses.tolist(), strict=True))
    )
    holders = "".join(f'<body name="s{i}" mocap="true" pos="0 0 -9"/>' for i in range(sockets))
    ties = "".join(f'<connect body1="s{i}" body2="v0" anchor="0 0 0" active="false" {HELD}/>' for i in range(sockets))
    return f"""<mujoco>
<compiler autolimits="true" boundmass="1e-9"/>
<option timestep="{resolution.step_s}" integrator="discrete" solver="CG" iterations="{resolution.iterations}"
 tolerance="{resolution.tolerance}" cone="elliptic" impratio="10"/>
<size memory="400M"/>
<worldbody>{"" if table is None else _board(table, fabric, resolution)}{vertices}{holders}{_boxes(fingers)}</worldbody>
<deformable><flex name="cloth" dim="2" radius="{ball}" body="{" ".join(f"v{i}" for i in range(len(rest)))}"
 element="{" ".join(map(str, triangles.ravel().tolist()))}">
<contact contype="0" conaffinity="{_CLOTH}" condim="3" friction="{fabric.self_friction} 0 0" {contact} priority="1"
 selfcollide="none"/>
<elasticity young="{fabric.young_pa}" poisson="0" damping="{fabric.damping_s}"
 thickness="{fabric.shell_thickness_m}" elastic2d="both"/></flex></deformable>
<equality>{ties}</equality>
</mujoco>"""


def vertex_areas(points: FloatArray, triangles: NDArray[np.int64]) -> FloatArray:
    """Return a third of the area of each vertex's triangles, shape (n,), m^2."""
    first, second = (points[triangles[:, i]] - points[triangles[:, 0]] for i in (1, 2))
    areas = np.linalg.norm(np.cross(first, second), axis=1) / 2.0
    return np.asarray(np.bincount(triangles.ravel(), np.repeat(areas / 3.0, 3), len(points)))


def _contact(fabric: Fabric) -> str:
    """Return how stiff the contacts of a cloth are."""
    return _STIFFER if fabric.layer_m < _NEAR_M else _STIFF


def _joints(damping: float) -> str:
    return "".join(
        f'<joint type="slide" axis="{axis}" damping="{damping:.9g}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1")
    )


def _board(table: Table, fabric: Fabric, resolution: Resolution) -> str:
    """Return the table: its top, its sides, and edges rounded by half a row of the mesh.

    Vertices go round capsules. Triangles touch neither these nor boxes, so rows of balls keep them from cutting edges.
    """
    radius = min(0.5 * resolution.edge_m, 0.5 * _TABLE_M)
    x, y = table.depth_m / 2.0, table.width_m / 2.0
    low = (_TABLE_M - radius) / 2.0
    shapes = [(_BOARD, _box(x - radius, y - radius, radius, -radius)), (_BOARD, _box(x, y, low, -radius - low))]
    round_about = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)])
    corners = np.column_stack([round_about * (x - radius, y - radius), np.full(5, -radius)])
    for start, end in itertools.pairwise(corners):
        shapes.append((_BOARD, f'type="capsule" size="{radius}" fromto="{_numbers(start)} {_numbers(end)}"'))
        places = np.linspace(start, end, math.ceil(float(np.linalg.norm(end - start)) / radius), endpoint=False)
        shapes += [(_CLOTH, f'type="sphere" size="{radius}" pos="{_numbers(place)}"') for place in places]
    touch = f'conaffinity="0" condim="3" friction="{fabric.friction} 0 0" {_contact(fabric)} priority="2"'
    return "".join(f'<geom {shape} contype="{contype}" {touch}/>' for contype, shape in shapes)


def _boxes(fingers: Sequence[FingerSize]) -> str:
    """Return two bodies for each hand, without friction, out of the way.

    Triangles do not touch boxes: rows of balls keep them from cutting the fingers' ends, where cloth turns over.
    """
    touch = 'conaffinity="0" condim="1" priority="3"'
    return "".join(
        f'<body name="f{hand}_{finger}" mocap="true" pos="0 0 -9"><geom type="box" '
        f'size="{size.length_m / 2.0} {size.width_m / 2.0} {size.thickness_m / 2.0}" '
        f'contype="{_FINGER}" {touch} {_STIFF}/>{_finger_end(size, f"{touch} {_STIFF}")}</body>'
        for hand, size in enumerate(fingers)
        for finger in range(2)
    )


def _finger_end(size: FingerSize, touch: str) -> str:
    """Return balls across the end of a finger that triangles touch, a little thinner than it: it is closed on them."""
    radius = size.thickness_m / 2.0 - _CLOSED_M
    places = np.linspace(radius - size.width_m / 2.0, size.width_m / 2.0 - radius, _BALLS).tolist()
    ball = f'<geom type="sphere" size="{radius}" contype="{_CLOTH}" {touch}'
    return "".join(f'{ball} pos="{size.length_m / 2.0 - radius} {place} 0"/>' for place in places)


def _box(x: float, y: float, z: float, at_z: float) -> str:
    return f'type="box" size="{x} {y} {z}" pos="0 0 {at_z}"'


def _numbers(point: FloatArray) -> str:
    return " ".join(f"{value:.9g}" for value in point.tolist())
