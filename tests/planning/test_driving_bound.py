"""The bound on driving for loose folds: consistent, never too high, and close to the true cost."""

import math
from collections.abc import Iterator
from dataclasses import replace

import pytest

from bench.growth_cases import tabs_on_two_sides
from planner import make_plan
from planner.cloth.garment import Garment
from planner.cloth.garment_files import load_garment
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.pose import Pose2
from planner.planning.driving_bound import DrivingBound
from planner.planning.heuristic import arm_time
from planner.primitives.base_move import BaseMove
from planner.primitives.context import Context
from planner.primitives.fold_query import FoldQueries, FoldStands
from planner.primitives.g_drag import GDrag
from planner.primitives.g_fold import GFold
from planner.primitives.primitive import Primitive, Step
from planner.primitives.site_map import Service
from planner.primitives.state import State
from planner.robots.load_robot import load_robot
from planner.search.a_star import Edge, Outcome, a_star
from planner.task.scene import Scene
from tests.planning.test_edges import edges_of
from tests.sweep import sweep

SCENE = Scene()
START = State(0, (0.0, 0.0), 0, 0)


def work_of(cloth: Garment, scene: Scene = SCENE) -> Context:
    robot = load_robot("pr2")
    reach = robot.reach(scene.torso_m, 0.03)
    return Context(FoldSequence.of(cloth), scene, reach, cloth.placement, robot.card.base_radius_m)


@sweep("name", ["tabs", "t-shirt", "tie", "scarf"], ("tabs", "t-shirt"))
def test_no_edge_lowers_the_bound_by_more_than_it_costs(name: str) -> None:
    cloth = tabs_on_two_sides(4) if name == "tabs" else load_garment(name)
    context = work_of(cloth)
    kinds: list[Primitive] = [GFold(context), GDrag(context), BaseMove(context)]
    bound, goal = DrivingBound(context, START), (1 << len(context.sequence.folds)) - 1

    def successors(state: State, _cost_s: float) -> Iterator[Edge[State, Step]]:
        for step in (step for kind in kinds for step in kind.successors(state)):
            assert bound(state) <= step.duration_s + bound(step.after) + 1e-9, step.details
            yield Edge(step, step.duration_s, step.after)

    *_, found = a_star(START, successors, lambda s: s.done == goal, bound, 100_000)
    *_, without = a_star(START, successors, lambda s: s.done == goal, arm_time(context), 100_000)
    assert found.outcome is without.outcome is Outcome.SOLVED
    assert found.cost == pytest.approx(without.cost, abs=1e-6)
    assert found.expanded <= without.expanded


def test_tabs_opposite_need_a_drag_and_the_way_back_however_many_there_are() -> None:
    # 40 cm: 3 s for the hands, 1.6 s of driving, .5 s to speed up and slow down; the tabs are then in reach from 5 cm,
    # 35 cm nearer: 1.4 s.
    context = work_of(tabs_on_two_sides(12))
    assert DrivingBound(context, START)(START) == pytest.approx(12 * 9.0 + 6.5)
    assert DrivingBound(context, START)(State((1 << 12) - 1, (0.0, 0.0), 0, 0)) == 0.0


def test_folds_that_can_be_done_from_nowhere_are_left_to_the_search() -> None:
    # 1.2 m from the only station and nothing to drag towards it by: no tab is ever in reach.
    far = replace(tabs_on_two_sides(8), placement=Pose2(0.3, 0.4, -math.pi / 2))
    front = Scene(stations=(("front", Pose2(-0.95, 0.0, 0.0)),), back_off_max_m=0.0)
    context = work_of(far, front)
    assert DrivingBound(context, START)(START) == 8 * 9.0


def test_twelve_loose_folds_on_two_sides_are_proven_joint_paths_and_all() -> None:
    # Hands that drag have a second less for coming than hands that fold; those that fold before leave sooner.
    plan = make_plan(tabs_on_two_sides(12), time_limit_s=60.0)
    assert plan.cost_s == pytest.approx(12 * 9.0 + 6.5)
    assert plan.is_proven
    assert plan.statistics.expanded < 30


def test_of_tabs_near_and_far_a_drag_only_holds_near_ones() -> None:
    assert Service(work_of(tabs_on_two_sides(8))).folds[0] == {0, 1, 2, 3}


@pytest.mark.parametrize("done", [0b0, 0b1, 0b1010, 0b110000])
def test_from_where_a_fold_is_begun_is_known_whatever_other_folds_are_done(done: int) -> None:
    context = work_of(tabs_on_two_sides(8))
    questions, stands = context.kept(FoldQueries), FoldStands(context)
    for offset in ((0.0, 0.0), (-0.2, 0.0), (-0.4, 0.0)):
        for fold in (2, 7):
            for standoff in (0, 3, 8):
                state = State(done, offset, 0, standoff)
                ends, _ = questions.of(state, fold).ends(questions.begun(state), 0, IMPOSSIBLE)
                asked = min((end.steps for end in ends), default=IMPOSSIBLE)
                assert stands.least(fold, offset, 0)[standoff] == asked, (offset, fold, standoff)


@pytest.mark.long
def test_forty_loose_folds_on_two_sides_take_a_state_for_each_fold_and_a_few_for_drags() -> None:
    context = work_of(tabs_on_two_sides(40))
    edges, bound = edges_of(context), DrivingBound(context, START)
    *_, found = a_star(START, edges.leaving, lambda s: s.done == (1 << 40) - 1, bound, 1_000)
    assert found.outcome is Outcome.SOLVED
    assert found.cost == pytest.approx(40 * 9.0 + 6.5)
    assert found.expanded < 60
