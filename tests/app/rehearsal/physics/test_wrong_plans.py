"""Plans that are wrong for reasons the planner knows: physics must not let them pass."""

import math

import numpy as np
import pytest

from app.rehearsal.judge import Gate, StepVerdict, judged
from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.physics_world import PhysicsWorld
from app.rehearsal.world import GripMotion, StepMotion
from planner import Task
from planner.folds.fold_path import FoldPath
from planner.folds.fold_sequence import replayed
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2, Pose2
from planner.geometry.segment import Segment
from planner.geometry.table import Table, TableTop
from planner.task.world_state import WorldState
from tests.builders import fold, garment, rectangle_points

LONG, WIDE = 0.4, 0.3
HALF = fold((LONG, WIDE / 2.0), (0.0, WIDE / 2.0), name="half")
QUARTER = fold((LONG / 2.0, WIDE / 2.0), (LONG / 2.0, WIDE), name="quarter")
DURATION_S = 2.5


def verdict_on(world: PhysicsWorld, task: Task, done: tuple[int, ...]) -> StepVerdict:
    state = WorldState(done, task.start.placement, task.start.base)
    return judged(world.truth(), 0, replayed(task.garment), state, Isometry(), task.scene.table, Gate(), ())


def folding(line: Segment, *grips: Point2) -> StepMotion:
    """Return the motion of a fold by grips at given places, as a plan would make it."""
    top = TableTop.of(Table())
    path = FoldPath(line, float(line.left_distances(np.array(grips)).max()), top, top)
    points = path.tool_paths(np.array(grips), np.linspace(0.0, 2.0, 11))
    times = tuple(np.linspace(0.0, DURATION_S, 11).tolist())
    hands = (GripMotion(("left", "right")[i], times, tuple(map(tuple, one.tolist()))) for i, one in enumerate(points))
    return StepMotion(0, "fold", DURATION_S, tuple(hands))


def hung(beyond: float, friction: float, edge_m: float) -> tuple[PhysicsWorld, Task]:
    """Return a strip that hangs over the table's edge by a share of its length, and its task."""
    length = 0.4
    edge_x = -Table().depth_m / 2.0
    towel = garment(rectangle_points(length, 0.2), placement=Pose2(edge_x - beyond * length, 0.0, 0.0))
    task = Task.of(towel)
    return PhysicsWorld(
        task, Fabric(friction=friction), Resolution(edge_m, settle_s=0.7)
    ), task  # it is still there then


@pytest.mark.parametrize(("beyond", "friction", "holds"), [(0.2, 0.5, True), (0.5, 0.3, False)])
def test_cloth_hung_beyond_friction_slides_off_the_table_and_less_of_it_stays(
    beyond: float, friction: float, *, holds: bool
) -> None:
    # By the model friction / (1 + friction) of it may hang: a third and .23. The edge itself holds a little more.
    world, task = hung(beyond, friction, 0.04)
    world.simulation.run(1.0)
    assert verdict_on(world, task, ()).held == holds


@pytest.mark.parametrize(("friction", "slides"), [(0.4, True), (0.55, False)])
def test_half_of_a_strip_holds_the_other_half_where_friction_holds_a_rope_round_a_corner(
    friction: float, *, slides: bool
) -> None:
    # Round the edge the pull grows by e^(mu pi / 2): half of a strip holds the other if mu e^(mu pi / 2) > 1, so from
    # a friction of .474 on.
    assert (friction * math.exp(friction * math.pi / 2.0) < 1.0) == slides
    world, _ = hung(0.5, friction, 0.02)
    before = world.simulation.positions
    world.simulation.run(0.4)
    slid_m = float((before - world.simulation.positions)[before[:, 2] > 0.0, 0].mean())
    assert slid_m > 0.02 if slides else slid_m < 0.002, f"{1e3 * slid_m:.1f} mm"


@pytest.mark.long
def test_folds_made_out_of_order_are_lost() -> None:
    lies = Pose2(-LONG / 2.0, -WIDE / 2.0, 0.0)
    task = Task.of(garment(rectangle_points(LONG, WIDE), HALF, QUARTER, placement=lies))
    left, right, low = -LONG / 2.0, LONG / 2.0, -WIDE / 2.0
    half = folding(Segment((right, 0.0), (left, 0.0)), (left, low), (right, low))
    quarter = folding(Segment((0.0, low), (0.0, -low)), (left, 0.0), (left, -low))
    in_order, out_of_order = (_folded(task, *motions) for motions in ((half, quarter), (quarter, half)))
    assert not out_of_order.held
    assert out_of_order.p95_mm > 2.0 * in_order.p95_mm


def _folded(task: Task, *motions: StepMotion) -> StepVerdict:
    world = PhysicsWorld(task, Fabric(), Resolution(0.02), seed=2)
    for motion in motions:
        world.perform(motion)
    return verdict_on(world, task, (0, 1))
