"""The distance of a point from the comfort radius of an arm that has a reach map. Compiled.

As for a closed form (`planner.robots.pr2.nearest_comfort`) the search goes outwards in shells, along all directions and
approaches and from all places of the base at once, and ends in the first shell that has a place within the radius.
Shells are thicker here, because each query takes longer, and what the arm's length rules out is not asked.
"""

import math

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.mapped_comfort import MappedArms, first_of, is_held_round, mapped_query, mapped_space
from planner.robots.newton import solve
from planner.robots.reach_map import cell_of, decode

_SHELL_M, _WIDENING = 0.01, 0.06
"""Thickness of a shell (m), or as a fraction of its distance where that is more."""

_FINEST_M = 0.001
"""Precision at which the bisection ends (m)."""

_AT_LIMIT_RAD = 1e-3


@kernel
def nearest_place(
    arms: MappedArms,
    labels: NDArray[np.int64],
    points: FloatArray,
    directions: FloatArray,
    comfort: float,
    furthest: float,
    queries_max: int,
) -> tuple[float, int, int, int, int]:
    """Return the smallest displacement that brings a tool point within the comfort radius.

    Args:
        arms: the arms.
        labels: the labels of one arm's approaches that are allowed, shape (k,).
        points: the point as seen from the arm's root, from each place of the base, shape (n, 3), m.
        directions: unit vectors, shape (m, 3).
        comfort: the comfort radius (m).
        furthest: the furthest displacement searched (m).
        queries_max: the most queries; then what is known counts.

    Returns:
        The displacement (m), rounded up to a millimetre; the point; the approach; the direction; queries made.
        Infinity, -1, -1, -1 where there is none.
    """
    space, at = mapped_space(arms), np.empty(3)
    best, best_place, best_approach, best_direction, queries = math.inf, -1, -1, -1, 0
    inner = 0.0
    while inner < furthest and best_place < 0 and queries < queries_max:
        limit = outer = inner + max(_SHELL_M, _WIDENING * inner)
        for approach in range(len(labels)):
            ask = mapped_query(arms, labels[approach], comfort)
            for place in range(len(points)):
                beyond = math.sqrt((points[place] ** 2).sum()) - ask.length
                if beyond >= limit:
                    continue
                for direction in range(len(directions)):
                    near, far = inner, limit
                    if far <= near:
                        break
                    at[:] = points[place] + far * directions[direction]
                    if math.sqrt((at**2).sum()) > ask.length:
                        continue
                    queries += 1
                    if not is_held_round(ask, space, at):
                        continue
                    while far - near > _FINEST_M:
                        middle = 0.5 * (near + far)
                        at[:] = points[place] + middle * directions[direction]
                        queries += 1
                        if is_held_round(ask, space, at):
                            far = middle
                        else:
                            near = middle
                    best, best_place, best_approach, best_direction = far, place, approach, direction
                    limit = far - _FINEST_M
        inner = outer
    return best, best_place, best_approach, best_direction, queries


@kernel
def widest_circle(
    arms: MappedArms, labels: NDArray[np.int64], points: FloatArray, comfort: float
) -> tuple[float, int, int]:
    """Return the radius of the largest circle, up to `comfort` (m), on which the tool is still within reach.

    Returns:
        The radius (m), rounded down to a millimetre; the point; the approach. 0, -1, -1 where no point is within reach.
    """
    space = mapped_space(arms)
    best, best_place, best_approach = 0.0, -1, -1
    for approach in range(len(labels)):
        for place in range(len(points)):
            near, far = best, comfort
            if best_place >= 0 and far - near <= _FINEST_M:
                break
            if not is_held_round(mapped_query(arms, labels[approach], near), space, points[place].copy()):
                continue
            while far - near > _FINEST_M:
                middle = 0.5 * (near + far)
                if is_held_round(mapped_query(arms, labels[approach], middle), space, points[place].copy()):
                    near = middle
                else:
                    far = middle
            best, best_place, best_approach = near, place, approach
    return best, best_place, best_approach


@kernel
def joint_at_limit(arms: MappedArms, label: int, point: FloatArray) -> int:
    """Return the joint that keeps the tool from a point: at its limit where Newton's method gets no nearer; -1 if none.

    Among the postures of the point's cell, that of the first which ends at a limit.
    """
    ask = mapped_query(arms, label, 0.0)
    space, count = mapped_space(arms), len(ask.chain.low)
    joints, cell = space.middle[:count], cell_of(ask.known.grid, point)
    if cell < 0:
        return -1
    entry = cell * len(ask.known.grid.rotations) + ask.approach
    for number in range(ask.known.starts[entry], ask.known.starts[entry + 1]):
        decode(ask.known.grid, ask.known.postures[number], joints)
        solve(ask.chain, point, ask.rotation, ask.chain.rows, joints, first_of(space.newton, count))
        for i in range(count):
            nearest = min(joints[i] - ask.chain.low[i], ask.chain.high[i] - joints[i])
            if not ask.chain.turns[i] and nearest <= _AT_LIMIT_RAD:
                return i
    return -1
