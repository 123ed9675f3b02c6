"""The big towel can only be folded because cloth may hang: drags leave a part beyond the edge, folds bring it back.

It is 0.686 x 1.321 m, and lies with its near edge at x = -0.75; the table ends at x = -0.8. Its near third comes over
the line 0.4403 m from that edge; then what is double goes on over the far third, over the line at 0.8807 m. The hands
hold on after the drags that serve these folds, so what hangs once they let go is held out level until then.
"""

from collections.abc import Iterator

import numpy as np
import pytest

from planner import Plan, Scene, Task, find_plan, load_garment, make_plan
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.motion.timeline import Timeline
from planner.planning import edges
from planner.planning import path_search as planning
from planner.primitives.base_move import BaseMove
from planner.primitives.context import Context
from planner.primitives.drag_step import DragStep
from planner.primitives.fold_step import FoldStep
from planner.primitives.g_drag import GDrag
from planner.primitives.g_fold import GFold
from planner.primitives.state import State
from planner.task.plan import PlanStep
from planner.task.reason import Code
from tests.builders import context, fold, garment, rectangle_points
from tests.replay.planned import shipped_plan

EDGE_X_M = -0.8
NEAR_X_M = -0.75
LINES_M = (0.4403, 0.8807)


class LyingDrag(GDrag):
    """Drags that leave all of the garment on the table."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._problem = context

    def successors(self, state: State) -> Iterator[DragStep]:
        for step in super().successors(state):
            if not hanging_m(self._problem, step.after):
                yield step


def hanging_m(context: Context, state: State) -> float:
    """Return how deep the deepest point of the cloth hangs in a state of the search, let go (m)."""
    corners = context.sequence.cloth(state.done).silhouette.coordinates
    return deepest_m(context.scene.table, context.placed(state.offset).to_outer(corners))


def hanging_after_m(plan: Plan, step: PlanStep) -> float:
    """Return how deep the deepest point of the cloth hangs after a step of a plan, let go (m)."""
    corners = plan.sequence.cloth(step.after.done).silhouette.coordinates
    return deepest_m(plan.scene.table, step.after.placement.to_outer(corners))


def deepest_m(table: Table, corners: FloatArray) -> float:
    """Return how far the furthest of points of the unrolled plane, table frame, shape (n, 2), is beyond an edge (m)."""
    half = np.array([table.depth_m, table.width_m]) / 2
    return max(0.0, float((np.abs(corners) - half).max()))


def dragged_x_m(plan: Plan, step: PlanStep) -> float:
    """Return how far the cloth lies from its start, after a step (m along the table's x)."""
    return step.after.placement.x_m - plan.task.start.placement.x_m


@pytest.fixture
def towel() -> Plan:
    return shipped_plan("big-towel")


@pytest.fixture
def without_hanging(monkeypatch: pytest.MonkeyPatch) -> None:
    """Allow only drags that leave nothing hanging, and a "no" only once all states are exhausted."""
    monkeypatch.setattr(edges, "PRIMITIVES", (GFold, LyingDrag, BaseMove))
    monkeypatch.setattr(planning, "LOOK_ALONE_AFTER", 1_000_000_000)


def drag_and_fold(plan: Plan, index: int) -> tuple[PlanStep, PlanStep]:
    """Return the step that performs a fold, and the one before it."""
    at = [step.fold for step in plan.steps].index(index)
    return plan.steps[at - 1], plan.steps[at]


@pytest.mark.parametrize("index", [0, 1])
def test_a_drag_takes_a_part_beyond_the_edge_and_the_fold_brings_it_back(towel: Plan, index: int) -> None:
    dragged, folded = drag_and_fold(towel, index)
    assert dragged.kind == "drag" and dragged.after.held
    # After the first fold the near edge is its line: over the first line, then over the second.
    start = 0.0 if index == 0 else LINES_M[0]
    near = NEAR_X_M + dragged_x_m(towel, dragged) + start
    assert near < EDGE_X_M - 0.1
    assert hanging_after_m(towel, dragged) == pytest.approx(EDGE_X_M - near)
    assert near + LINES_M[index] - start > EDGE_X_M
    assert hanging_after_m(towel, folded) == 0.0


@pytest.mark.parametrize("index", [0, 1])
def test_it_is_taken_over_from_where_the_drag_holds_it_out(towel: Plan, index: int) -> None:
    dragged, folded = drag_and_fold(towel, index)
    start = 0.0 if index == 0 else LINES_M[0]
    near = NEAR_X_M + dragged_x_m(towel, dragged) + start
    depth = LINES_M[index] - start
    for grip, y in zip(folded.grips, (0.343, -0.343), strict=True):
        assert grip.pick == pytest.approx((near, y, 0.02), abs=1e-4)
        assert grip.apex == pytest.approx((near + depth, y, 0.02 + depth), abs=1e-4)
        assert grip.place == pytest.approx((near + 2 * depth, y, 0.02), abs=1e-4)


def test_in_the_3d_view_it_is_held_out_level_and_lies_on_the_table_afterwards(towel: Plan) -> None:
    dragged, folded = drag_and_fold(towel, 0)
    near = NEAR_X_M + dragged_x_m(towel, dragged)
    out = Timeline.of(towel).at(folded.start_s - 1e-6).cloth.vertices
    assert out[:, 0].min() == pytest.approx(near, abs=1e-3)
    assert out[:, 2].min() >= 0.0
    back = Timeline.of(towel).at(folded.start_s + folded.duration_s).cloth.vertices
    assert back[:, 0].min() > EDGE_X_M and back[:, 2].min() >= 0.0


@pytest.mark.long
def test_without_drags_that_leave_cloth_hanging_there_is_no_plan(without_hanging: None) -> None:
    answer = make_plan(load_garment("big-towel"), time_limit_s=60.0)
    assert answer.status == "infeasible"
    assert (answer.reasons[0].fold, answer.reasons[0].code) == (0, Code.OUT_OF_REACH)


def status_of_big_towel(scene: Scene | None = None) -> str:
    return find_plan(Task.of(load_garment("big-towel"), scene, time_limit_s=60.0), with_reasons=False).plan.status


def test_on_a_table_so_smooth_that_nothing_may_hang_there_is_no_plan() -> None:
    assert status_of_big_towel(Scene(friction=0.0)) == "infeasible"


def test_without_drags_there_is_no_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(edges, "PRIMITIVES", (GFold, BaseMove))
    assert status_of_big_towel() == "infeasible"


@pytest.mark.parametrize(
    ("friction", "status"), [(0.467, "solved"), pytest.param(0.463, "infeasible", marks=pytest.mark.long)]
)
def test_there_is_a_plan_as_long_as_friction_holds_what_must_hang(friction: float, status: str) -> None:
    # The second line, 0.8807 m from the near edge as it lay, is in reach after drags by 0.7 m in all and not
    # after 0.6 m. Then the first line, 0.4403 m from that edge, is at x = -0.75 - 0.7 + 0.4403: 0.2097 m beyond
    # the table's, and two layers. Of 1.321 m of cloth, layers counted, 0.4194 m hang: mu >= 0.4194 / 0.9016 =
    # 0.4652.
    assert status_of_big_towel(Scene(friction=friction)) == status


# A tablecloth 0.81 x 0.81 m in thirds, far over, then near over, for a robot that reaches everything.
THIRD_M = 0.27
TABLECLOTH = garment(
    rectangle_points(0.81, 0.81),
    fold((0.0, 0.54), (0.81, 0.54), name="far over"),
    fold((0.81, 0.27), (0.0, 0.27), name="near over"),
    placement=Pose2(NEAR_X_M, 0.405, -np.pi / 2),
)


def test_a_drag_may_let_go_of_cloth_that_then_hangs_and_a_fold_take_it_up_from_there() -> None:
    # By 0.3 m: the near edge goes from x = -0.75 to -1.05, and hangs 0.25 m deep; 0.56 m lie. The far third comes over.
    problem = context(TABLECLOTH)
    drags = [s for s in GDrag(problem).successors(State(0, (0.0, 0.0), 0, 0)) if not s.after.held]
    drag = next(s for s in drags if s.distance_m == pytest.approx(0.3))
    assert hanging_m(problem, drag.after) == pytest.approx(0.25)
    far = _without_driving(problem, drag.after)
    for grip, y in zip(far.grips, (0.405, -0.405), strict=True):
        assert grip.pick == pytest.approx((-1.05 + 0.81, y, 0.02))
        assert grip.place == pytest.approx((-1.05 + THIRD_M, y, 0.02))
    assert hanging_m(problem, far.after) == pytest.approx(0.25)
    # The near corners hang straight down from the edge, the tool 0.02 m over them and 0.03 m outside. They rise beside
    # the edge from 0.25 m below to as much above, go in over the line, 0.27 m high, and come down on its other side.
    near = _without_driving(problem, far.after)
    for grip, y in zip(near.grips, (0.405, -0.405), strict=True):
        assert grip.pick == pytest.approx((EDGE_X_M - 0.03, y, 0.02 - 0.25))
        assert grip.apex == pytest.approx((-1.05 + THIRD_M, y, 0.02 + THIRD_M))
        assert grip.place == pytest.approx((-1.05 + 2 * THIRD_M, y, 0.02))
    assert hanging_m(problem, near.after) == 0.0


def _without_driving(problem: Context, state: State) -> FoldStep:
    """Return the one fold whose base stays; the others end where the base can leave for another station sooner."""
    fold, *others = GFold(problem).successors(state)
    assert fold.after.standoff == state.standoff
    assert all(other.after.standoff != state.standoff for other in others)
    return fold


def test_cloth_that_hangs_is_not_dragged_further_over_its_edge() -> None:
    problem = context(TABLECLOTH)
    drag = next(s for s in GDrag(problem).successors(State(0, (0.0, 0.0), 0, 0)) if not s.after.held)
    assert hanging_m(problem, drag.after) > 0.0
    assert list(GDrag(problem).successors(drag.after)) == []
