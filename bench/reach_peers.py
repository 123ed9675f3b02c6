"""Other libraries' inverse kinematics, for the same arm and the same limits.

pytracik and eaik are extras, pinned in ``requirements-bench.txt``; damped least squares is written here on pinocchio.
Each has the settings with which it does best: a precision far finer than what counts as a miss, and a stop at its first
good answer.
"""

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any, TypeAlias

import numpy as np
import pinocchio as pin

from bench.pin_arm import TORSO_M, pin_arm
from bench.reach_method import Answering, Joints, Method
from bench.reach_queries import Queries
from planner.geometry.pose import FloatArray
from planner.robots.pr2.arm import read_arm
from planner.robots.pr2.description import read_model, urdf_path

Solve: TypeAlias = Callable[[FloatArray, FloatArray], FloatArray | None]
"""A solver: from a tool's position (m), shape (3,), and rotation, shape (3, 3), to seven joints (rad), or None."""

PRECISION = 1e-7
"""Precision at which a numerical method may stop (m, rad)."""

PANS = 16
"""Number of pans at which eaik is tried."""

STEPS, DAMPING = 100, 1e-3
"""Number of steps after which damped least squares gives up, and its damping (m, rad)."""

SEED = 7


def _trac_ik(timeout_s: float) -> Solve:
    """Return TRAC-IK: two numerical methods race, with restarts, until one succeeds or the time runs out."""
    trac_ik: Any = import_module("trac_ik")
    solver = trac_ik.TracIK("torso_lift_link", "l_gripper_tool_frame", str(urdf_path()), timeout_s, PRECISION)
    low, high = solver.joint_limits
    arm = pin_arm()
    # TRAC-IK reads the URDF's limits as zeros, but knows those of endless joints.
    low, high = np.where(np.isfinite(arm.low), arm.low, low), np.where(np.isfinite(arm.high), arm.high, high)
    solver.joint_limits = (low.tolist(), high.tolist())
    model = read_model()
    down = model.frames[model.getFrameId("torso_lift_link")]
    torso = model.jointPlacements[down.parentJoint].translation + down.placement.translation + (0.0, 0.0, TORSO_M)

    def solve(point: FloatArray, rotation: FloatArray) -> FloatArray | None:
        found = solver.ik(point - torso, rotation, arm.middle)
        return None if found is None else np.asarray(found)

    return solve


def _eaik() -> Solve:
    """Return EAIK: in closed form for six joints, so the pan is locked at one sample after another."""
    eaik: Any = import_module("eaik.pybindings.EAIK")
    shape, arm = read_arm(read_model()), pin_arm()
    axes = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]] * 3)
    links = np.zeros((7, 3))
    links[[2, 4, 6], 0] = shape.upper, shape.fore, shape.tool
    robot = eaik.Robot(axes.T, links.T, np.eye(3), [], True)
    shoulder = np.array([shape.shoulder_x, shape.shoulder_y, shape.shoulder_z + TORSO_M])
    width = (shape.pan.high - shape.pan.low) / PANS
    pans = shape.pan.low + width * (np.arange(PANS) + 0.5)
    backs = [np.array([[np.cos(p), np.sin(p), 0], [-np.sin(p), np.cos(p), 0], [0, 0, 1]]) for p in pans]
    ends = np.array([shape.offset, 0.0, 0.0])
    low, high = arm.low[1:], arm.high[1:]
    turns_from = np.where(np.isfinite(low), low, 0.0)

    def solve(point: FloatArray, rotation: FloatArray) -> FloatArray | None:
        pose, from_shoulder = np.eye(4), point - shoulder
        for pan, back in zip(pans, backs, strict=True):
            pose[:3, :3], pose[:3, 3] = back @ rotation, back @ from_shoulder - ends
            found = robot.calculate_IK(pose)
            if found.num_solutions() == 0:
                continue
            solutions = np.asarray(found.Q)
            solutions = turns_from + np.mod(solutions - turns_from, 2.0 * np.pi)
            is_good = np.all(solutions <= high, axis=1) & ~np.asarray(found.is_LS, dtype=bool)
            if is_good.any():
                return np.array([pan, *solutions[is_good.argmax()]])
        return None

    return solve


def _least_squares(starts: int) -> Solve:
    """Return damped least squares from the middle of the joints' ranges, then from `starts` - 1 random joints."""
    arm = pin_arm()
    random = np.random.default_rng(SEED)

    def solve(point: FloatArray, rotation: FloatArray) -> FloatArray | None:
        target = pin.SE3(rotation, point)
        for start in range(starts):
            joints = arm.middle if start == 0 else arm.random_joints(random, 1)[0]
            for _ in range(STEPS):
                tool, jacobian = arm.tool_and_jacobian(joints)
                error = pin.log6(tool.actInv(target)).vector
                if np.abs(error).max() <= PRECISION:
                    return np.asarray(joints)
                square = jacobian @ jacobian.T
                square.flat[::7] += DAMPING**2
                joints = arm.clamped(joints + jacobian.T @ np.linalg.solve(square, error))
        return None

    return solve


PEERS: Mapping[str, Callable[[], Solve]] = {
    "pytracik, 1 ms": lambda: _trac_ik(0.001),
    "pytracik, 5 ms": lambda: _trac_ik(0.005),
    f"eaik, {PANS} pans": _eaik,
    "least squares, 1 start": lambda: _least_squares(1),
    "least squares, 20 starts": lambda: _least_squares(20),
}


def peer_methods() -> dict[str, Method | None]:
    """Return the peers by name; None for a peer that is not installed."""
    return {name: _method(name, load) for name, load in PEERS.items()}


def _method(name: str, load: Callable[[], Solve]) -> Method | None:
    try:
        solve = load()
    except ImportError:
        return None
    return Method(name, lambda queries: _one_by_one(solve, queries), is_slow=True)


def _one_by_one(solve: Solve, queries: Queries) -> Answering:
    def answer() -> Callable[[], Joints]:
        found = [solve(point, rotation) for point, rotation in zip(queries.points, queries.rotations, strict=True)]
        return lambda: found

    return answer
