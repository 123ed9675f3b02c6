"""Cloth in MuJoCo: vertices that can be held, moved and let go, and time that passes."""

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from app.rehearsal.physics.bending import Hinges
from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.fingers import Box, FingerSize
from app.rehearsal.physics.model import FREE, IN_HAND, SOCKETS, model_xml
from app.rehearsal.physics.weave import Weave
from planner.geometry.pose import FloatArray
from planner.geometry.table import Table


class ClothSimulation:
    """A cloth on a table, and the vertices that grips hold."""

    def __init__(
        self,
        rest: FloatArray,
        pattern: FloatArray,
        triangles: NDArray[np.int64],
        fabric: Fabric,
        resolution: Resolution,
        table: Table | None = None,
        fingers: Sequence[FingerSize] = (),
    ) -> None:
        """Build the model, the cloth in its flat shape.

        Args:
            rest: the vertices of the flat cloth without tension, table frame, shape (n, 3), m.
            pattern: the vertices in the frame of warp and weft, shape (n, 2), m.
            triangles: shape (m, 3).
            fabric: the cloth.
            resolution: the time step and the solver's effort.
            table: the table; None for none.
            fingers: the size of each hand's two fingers.
        """
        self.triangles = triangles
        self.step_s = resolution.step_s
        self._rest = rest
        xml = model_xml(rest, pattern, triangles, fabric, resolution, table, fingers)
        self._model = mujoco.MjModel.from_xml_string(xml)
        self._model.eq_data[:, :6] = 0.0  # ties pull a vertex onto its socket, whatever the distance at the start was
        self._hinges = Hinges(self._model, rest, fabric.bend_friction_per_m)
        self._weave = Weave.of(pattern, triangles, fabric, resolution.edge_m)
        self._data = mujoco.MjData(self._model)
        self._vertex_bodies = np.array([self._model.body(f"v{i}").id for i in range(len(rest))])
        self._vertex_geoms = self._model.body_geomadr[self._vertex_bodies]
        self._held: dict[int, int] = {}
        mujoco.mj_forward(self._model, self._data)

    @property
    def positions(self) -> FloatArray:
        """The vertices, table frame, shape (n, 3), m."""
        return np.asarray(self._rest + self._data.qpos.reshape(-1, 3))

    @property
    def speeds(self) -> FloatArray:
        """The vertices' speeds, shape (n,), m/s."""
        return np.asarray(np.linalg.norm(self._data.qvel.reshape(-1, 3), axis=1))

    @property
    def held(self) -> frozenset[int]:
        """The vertices that are held."""
        return frozenset(self._held)

    def put(self, positions: FloatArray) -> None:
        """Put the vertices somewhere, at rest and bent as they have lain for long, shape (n, 3), m."""
        self._data.qpos[:] = (positions - self._rest).ravel()
        self._data.qvel[:] = 0.0
        self._hinges.rest(positions)
        mujoco.mj_forward(self._model, self._data)

    def push(self, velocity: FloatArray) -> None:
        """Set all vertices moving, shape (3,), m/s."""
        self._data.qvel.reshape(-1, 3)[:] = velocity

    def hold(self, vertices: Mapping[int, FloatArray]) -> None:
        """Hold each vertex at a place, shape (3,), m; those held already are moved there."""
        for vertex, place in vertices.items():
            socket = self._held.get(vertex)
            if socket is None:
                socket = self._free_socket()
                self._held[vertex] = socket
                self._model.eq_obj2id[socket] = self._vertex_bodies[vertex]
                self._data.eq_active[socket] = 1
                self._model.geom_conaffinity[self._vertex_geoms[vertex]] = IN_HAND
            self._data.mocap_pos[socket] = place

    def release(self, vertices: frozenset[int]) -> None:
        """Let vertices go."""
        for vertex in vertices:
            self._data.eq_active[self._held.pop(vertex)] = 0
            self._model.geom_conaffinity[self._vertex_geoms[vertex]] = FREE

    def put_fingers(self, hand: int, boxes: Sequence[Box]) -> None:
        """Put the fingers of a hand somewhere, those not named out of the way."""
        for finger in range(2):
            body = self._model.body(f"f{hand}_{finger}").mocapid[0]
            self._data.mocap_pos[body] = boxes[finger].middle if finger < len(boxes) else (0.0, 0.0, -9.0)
            if finger < len(boxes):
                mujoco.mju_mat2Quat(self._data.mocap_quat[body], np.ascontiguousarray(boxes[finger].axes).ravel())

    def solve_to(self, tolerance: float) -> None:
        """Set the improvement at which the solvers stop from now on (see `Resolution`)."""
        self._model.opt.tolerance = tolerance

    def step(self) -> None:
        """Let one time step pass.

        Raises:
            FloatingPointError: the simulation has become unstable.
        """
        positions = self.positions
        self._hinges.stiffen(self._model, positions)
        stiffness = self._weave.stiffness(positions)
        self._model.flex_stiffness.reshape(len(stiffness), -1)[:, : stiffness.shape[1]] = stiffness
        mujoco.mj_step(self._model, self._data)
        if self._data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number or not np.isfinite(self._data.qpos).all():
            raise FloatingPointError("the simulation has become unstable")

    def run(self, duration_s: float) -> None:
        """Let a time pass (s)."""
        for _ in range(round(duration_s / self.step_s)):
            self.step()

    def _free_socket(self) -> int:
        taken = set(self._held.values())
        free = next((socket for socket in range(SOCKETS) if socket not in taken), None)
        if free is None:
            raise ValueError(f"grips hold more than {SOCKETS} vertices")
        return free
