"""The step of a plan that a picture shows the cloth to be at: a run that ended in the middle goes on from there.

The stack that each state of the plan would leave is looked for with the eyes of rehearsals. Of those that match what is
seen, the one that matches best is it.
"""

from dataclasses import dataclass

import numpy as np

from app.drivers.driver import Joints, LostError
from app.rehearsal.camera.calibration import Calibration, Image
from app.rehearsal.camera.posture import Posture
from app.rehearsal.camera.robot_shape import hidden, robot_shape
from app.rehearsal.vision.look_at_stack import Looker
from app.rehearsal.vision.stack_fit import StackFit
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import Pose2
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan

LEAST_OVERLAP = 0.85
"""A stack whose outline overlaps less with that of a state is in another."""

_ALIKE = 0.02
"""States whose overlaps differ by less match equally well; of these the one that lies nearest to its place is it."""

FURTHEST_M, FURTHEST_RAD = 0.02, 0.06
"""A stack further from where the plan has it would be gripped beside its points (m, rad)."""

_BESIDE_ARM_PX = 4


@dataclass(frozen=True, slots=True)
class StepSeen:
    """Where in a plan the cloth is.

    Attributes:
        step: the step that is next; the plan's length if all are done.
        overlap: how well its outline matches that of the state before the step: 0 to 1.
        off_m: how far the stack's middle is from where the plan has it (m).
        turned_rad: how far it is turned from there (rad).
    """

    step: int
    overlap: float
    off_m: float
    turned_rad: float


def step_seen(plan: Plan, image: Image, calibration: Calibration, joints: Joints) -> StepSeen:
    """Return the step of a plan that a picture shows to be next.

    Args:
        plan: the plan of a robot whose base stays where the plan begins.
        image: blue, green, red.
        calibration: the camera, in the table's frame.
        joints: the robot's joints by name; arms hide what is behind them.

    Raises:
        LostError: the picture shows none of the plan's states, or one that lies elsewhere.
        CalibrationError: the picture is not of that camera.
        UnsolvedPlanError: the plan is not solved.
    """
    if plan.trajectory is None:
        raise UnsolvedPlanError(plan.status)
    straight, camera = calibration.view(image)
    card, table = load_robot(plan.task.robot).card, plan.scene.table
    posture = Posture(
        plan.trajectory.segment_at(0.0).base_at(0.0), card.still_values(plan.trajectory.torso_m) | dict(joints)
    )
    parts = robot_shape(card, -table.height_m).parts(posture)
    looker = Looker(camera, table, hidden(parts, camera, _BESIDE_ARM_PX))
    found: dict[tuple[int, Pose2], StepSeen] = {}
    for step in range(len(plan.steps) + 1):
        world = plan.state_after(step - 1)
        key = (world.done, world.placement)
        if world.held or key in found:
            continue
        fit = looker.look(straight, plan.sequence, world.folds_done, world.placement).fit
        if fit is not None:
            found[key] = _compared(plan, step, world.placement, fit, world.done)
    best = max((one.overlap for one in found.values()), default=0.0)
    if best < LEAST_OVERLAP:
        raise LostError(
            f"the camera shows none of the plan's states: the nearest matches {best:.0%}, less than {LEAST_OVERLAP:.0%}"
        )
    alike = [one for one in found.values() if one.overlap >= best - _ALIKE]
    nearest = min(alike, key=lambda one: one.off_m / FURTHEST_M + abs(one.turned_rad) / FURTHEST_RAD)
    if nearest.off_m > FURTHEST_M or abs(nearest.turned_rad) > FURTHEST_RAD:
        raise LostError(
            f"the cloth lies {100 * nearest.off_m:.1f} cm beside and {nearest.turned_rad:.2f} rad from where the plan "
            f"has it before step {nearest.step}: move it, or plan anew"
        )
    return nearest


def _compared(plan: Plan, step: int, ought: Pose2, fit: StackFit, done: int) -> StepSeen:
    """Return how a fit compares with a state; of a stack that looks the same turned, the likeliest way round."""
    middle = plan.sequence.cloth(done).silhouette.hull.mean(axis=0)
    poses = (fit.placement, *fit.others)
    turns = [Pose2(0.0, 0.0, pose.yaw_rad - ought.yaw_rad).yaw_rad for pose in poses]
    likeliest = int(np.argmin(np.abs(turns)))
    off_m = float(np.hypot(*(poses[likeliest].to_outer(middle) - ought.to_outer(middle))))
    return StepSeen(step, fit.overlap, off_m, turns[likeliest])
