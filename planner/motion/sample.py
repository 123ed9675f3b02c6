"""A sample of a plan, ready to be shown: the base, every joint, the cloth in space."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table_top import TableTop


@dataclass(frozen=True, slots=True, eq=False)
class ClothSurface:
    """The cloth as a triangle mesh in the table frame.

    Attributes:
        vertices: shape (n, 3), m; the layers of a stack lie a little apart.
        triangles: shape (m, 3), indices into `vertices`; seen from the front face of the cloth they run
            counter-clockwise.
        layers: shape (m,), each triangle's layer, 0 at the bottom.
        unrolled: for cloth on the table or hanging over its edges, each vertex's position in the unrolled plane and its
            layer's height above it, shape (n, 3), m; nan for all other cloth.
        pattern: each vertex's position in the pattern, shape (n, 2), m: the same on both sides of a crease.
    """

    vertices: FloatArray
    triangles: NDArray[np.int64]
    layers: NDArray[np.int64]
    unrolled: FloatArray
    pattern: FloatArray


@dataclass(frozen=True, slots=True)
class Sample:
    """The state of robot and cloth at one time.

    Attributes:
        t_s: the time (s).
        primitive: index of the current primitive.
        base: the base in the table frame.
        torso_m: the lift (m).
        joints: every actuated joint by its URDF name (rad, m for prismatic ones).
        velocities: every actuated joint's velocity just after that time (rad/s, m/s for prismatic ones).
        grippers_m: each gripper's opening by the arm's name (m).
        placement: the article frame in the table frame.
        cloth: the cloth.
        top: the table top over which the cloth does not hang, open where it is held out beyond an edge.
    """

    t_s: float
    primitive: int
    base: Pose2
    torso_m: float
    joints: dict[str, float]
    velocities: dict[str, float]
    grippers_m: dict[str, float]
    placement: Pose2
    cloth: ClothSurface
    top: TableTop

    def to_dict(self) -> dict[str, Any]:
        """Return the sample as JSON, without the cloth."""
        return {
            "t_s": self.t_s,
            "primitive": self.primitive,
            "base": self.base.to_dict(),
            "torso_m": self.torso_m,
            "joints": self.joints,
            "velocities": self.velocities,
            "grippers_m": self.grippers_m,
        }
