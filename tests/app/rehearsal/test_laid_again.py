"""An edge that a fold has left short of its place is seen there, and pulled to its place by the top layers alone."""

from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.camera_world import CameraWorld
from app.rehearsal.eyes import Eyes
from app.rehearsal.judge import Gate, carry
from app.rehearsal.laid_again import SHORT_M, laid_again
from app.rehearsal.laid_edge import LaidEdge, _is_on_edge, laid_edges
from app.rehearsal.perform import REPAIRS_MAX, Performer
from app.rehearsal.physics.fabric import Resolution
from app.rehearsal.physics.physics_world import PhysicsWorld
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.step_motions import step_motions
from app.rehearsal.step_seen import StepSeen
from app.rehearsal.vision.first_edge import first_edges
from app.rehearsal.world import LAY, StepMotion, Truth
from planner.cloth.garment import Garment
from planner.folds.fold_sequence import replayed
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray
from planner.geometry.woven_mesh import woven_mesh
from tests.app.rehearsal.flat_cloth import FlatCloth, home, no_plan
from tests.app.rehearsal.towel import FABRIC, towel_plan

FINE = Resolution(edge_m=0.022, step_s=0.008)
DEPTH_M = 0.15
"""How far from the fold line the edge of the towel lies."""


def folded_short(pattern: FloatArray, short_m: float) -> FloatArray:
    """Return the points of a towel whose upper layer is evenly shorter, so that its edge is that far short."""
    plan = towel_plan()
    state = plan.steps[-1].after
    points = planned_positions(plan.sequence, pattern, state.done, state.placement, plan.scene.table, FABRIC.layer_m)
    is_upper = points[:, 2] > FABRIC.layer_m
    line = Isometry.rotation(state.placement.yaw_rad, state.placement.x_m, state.placement.y_m)
    crease_x = line.apply_point(plan.sequence.folds[0].line.start)[0]
    points[is_upper, 0] = crease_x + (1.0 - short_m / DEPTH_M) * (points[is_upper, 0] - crease_x)
    return points


def seen_step() -> StepSeen:
    plan = towel_plan()
    return StepSeen(plan, plan.steps[-1], step_motions(plan)[-1])


def edges_of(seen: StepSeen) -> dict[str, LaidEdge]:
    return {edge.arm: edge for edge in laid_edges(seen)}


class LaidShort(FlatCloth):
    """A towel whose fold leaves its edge short of its place, and what has been laid down again as it should be."""

    def __init__(self, short_m: float, repairs: int) -> None:
        super().__init__(0.0, 0.0)
        self._short_m, self._repairs = short_m, repairs

    def truth(self) -> Truth:
        pattern, triangles = woven_mesh(towel_plan().garment.pattern, 0.02, 1)
        if not any(motion.is_fold for motion in self.asked):
            return self._truth
        again = sum(motion.kind == LAY for motion in self.asked)
        return Truth(pattern, folded_short(pattern, self._short_m if again < self._repairs else 0.0), triangles)


@pytest.mark.parametrize("short_m", [0.0, 0.026, 0.05])
def test_an_edge_is_seen_as_far_short_of_its_place_as_it_is(short_m: float) -> None:
    world = CameraWorld(LaidShort(short_m, 9), towel_plan().task, home(), 3)
    world.perform(step_motions(towel_plan())[-1])
    world.perform(StepMotion(0, "withdraw", 0.0, ends=home()))
    seen = world.observe()
    assert seen.image is not None and seen.camera is not None
    image, hidden = np.ascontiguousarray(seen.image[..., ::-1]), np.zeros(seen.image.shape[:2], bool)
    for edge in laid_edges(seen_step()):
        found = first_edges(image, seen.camera, hidden, edge.starts, edge.ends, edge.height_m)
        assert edge.short_m(found) == pytest.approx(short_m, abs=0.003)
        assert edge.short_m(first_edges(image, seen.camera, ~hidden, edge.starts, edge.ends, edge.height_m)) is None
        # No ray crosses an edge on which another part lies that the same fold has turned over.
        rays = edge.starts[:0]
        under = replace(edge, starts=rays, ends=rays, lengths_m=edge.lengths_m[:0])
        assert under.short_m(first_edges(image, seen.camera, hidden, rays, rays, edge.height_m)) is None


@pytest.mark.parametrize("off_m", [-0.01, 0.01])
def test_an_edge_that_should_lie_on_another_is_seen_as_far_short_of_that_wherever_the_stack_is_thought_to_lie(
    off_m: float,
) -> None:
    plan, seen = towel_plan(), seen_step()
    after = plan.steps[-1].after
    world = CameraWorld(LaidShort(0.026, 9), plan.task, home(), 3)
    world.perform(step_motions(plan)[-1])
    world.perform(StepMotion(0, "withdraw", 0.0, ends=home()))
    eyes = Eyes(plan.task)
    sight = eyes.sight(world.observe(), plan.sequence, after.folds_done, after.placement, home())
    assert sight is not None and sight.stack is not None
    stack = replace(sight.stack, row=sight.stack.row + np.array([off_m, 0.0, 0.0, 0.0, 0.0, 0.0]))
    there = replace(seen, carried=carry(after.placement, stack.placement))
    for edge in laid_edges(there, stack):
        assert edge.is_on_edge
        assert eyes.short_m(edge) == pytest.approx(0.026, abs=0.004)
    assert not any(edge.is_on_edge for edge in laid_edges(there))


@pytest.mark.parametrize(("line_m", "is_on_edge"), [(0.15, True), (0.14, False), (0.155, False)])
def test_an_edge_lies_on_another_where_the_cloth_below_it_ends_ahead_of_it_not_beside_it(
    line_m: float, *, is_on_edge: bool
) -> None:
    # A towel of 40 x 30 cm, seen at the corner that the fold lays down at a side of what is below.
    fold = {"name": "over", "kind": "blue", "start": [0.4, line_m], "end": [0.0, line_m]}
    towel = {"name": "towel", "outline": [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]], "folds": [fold]}
    stack = replayed(Garment.from_dict(towel)).folded(0, 0).cloth
    assert _is_on_edge(stack, np.array([0.4, 2.0 * line_m]), np.array([0.0, 1.0])) == is_on_edge


def test_hands_pull_an_edge_to_its_place_by_as_many_layers_as_the_fold_has_laid_down() -> None:
    seen = seen_step()
    edges = edges_of(seen)
    motion = laid_again(seen, edges, dict.fromkeys(edges, 0.02))
    assert motion is not None and motion.kind == LAY and not motion.is_fold and not motion.is_drag
    for grip, planned in zip(motion.grips, seen.planned.grips, strict=True):
        way = np.subtract(planned.points[-1], planned.points[0])[:2]
        gone = np.subtract(grip.points[-1], grip.points[0])[:2]
        assert gone == pytest.approx(0.02 * way / np.hypot(*way), abs=1e-6)
        assert grip.layers == 1 and grip.closes and grip.opens


@pytest.mark.parametrize(
    ("short_m", "further_m"),
    [({"left": SHORT_M, "right": SHORT_M}, 0.0), ({"left": 0.02}, 0.0), ({}, 0.0), ({"left": 0.02, "right": 0.0}, 0.5)],
)
def test_an_edge_is_left_alone_that_is_near_or_out_of_reach_or_that_was_not_seen(
    short_m: dict[str, float], further_m: float
) -> None:
    seen = replace(seen_step(), carried=Isometry.rotation(0.0, further_m, 0.0))
    assert laid_again(seen, edges_of(seen), short_m) is None


def test_the_lower_layer_stays_while_the_upper_one_is_pulled() -> None:
    plan, seen = towel_plan(), seen_step()
    world = PhysicsWorld(plan.task, FABRIC, FINE, seed=1)
    pattern = world.truth().pattern
    world.simulation.put(folded_short(pattern, 0.02))
    edges = edges_of(seen)
    motion = laid_again(seen, edges, dict.fromkeys(edges, 0.02))
    assert motion is not None and not world.perform(motion).missing
    off = (world.truth().positions - folded_short(pattern, 0.0))[:, 0]
    is_edge = pattern[:, 1] < 0.01  # it lands at the other one, y = .3 m
    assert np.abs(off[is_edge]).mean() < 0.006
    assert np.abs(off[pattern[:, 1] > DEPTH_M + 0.02]).mean() < 0.004


@pytest.mark.parametrize(("repairs", "made"), [pytest.param(1, 1, marks=pytest.mark.long), (9, REPAIRS_MAX)])
def test_what_a_fold_has_left_short_is_laid_down_again_until_it_is_seen_in_its_place_or_twice(
    repairs: int, made: int
) -> None:
    cloth = LaidShort(0.018, repairs)
    done = Performer(towel_plan(), CameraWorld(cloth, towel_plan().task, home(), 3), Gate(), no_plan).performed()
    assert not done.reason
    assert [decision.code for decision in done.decisions].count("laid_again") == made
    assert sum(motion.kind == LAY for motion in cloth.asked) == made
    assert len(done.steps) == 1  # judged when it has been laid down again


def test_several_layers_are_not_pulled_far() -> None:
    seen, short_m = seen_step(), {"left": 0.05, "right": 0.05}
    edges = edges_of(seen)
    assert laid_again(seen, {arm: replace(edge, layers=1) for arm, edge in edges.items()}, short_m) is not None
    assert laid_again(seen, {arm: replace(edge, layers=2) for arm, edge in edges.items()}, short_m) is None
