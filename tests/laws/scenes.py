"""Random planning problems that are small enough to be searched exhaustively many times."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from hypothesis import assume
from hypothesis import strategies as st

from planner import Plan, Task, find_plan
from planner.cloth.garment import Garment
from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Pose2
from planner.geometry.tolerance import AREA_M2
from planner.planning.driving_bound import DrivingBound
from planner.planning.edges import Edges
from planner.planning.heuristic import HEURISTICS, Heuristic
from planner.primitives.context import Context
from planner.primitives.primitive import Primitive, Step
from planner.primitives.primitive_set import PRIMITIVES
from planner.primitives.state import State
from planner.robots.load_robot import load_robot
from planner.search.a_star import Edge, Outcome, a_star
from planner.task.scene import DEFAULT_STATIONS, Scene
from planner.task.task import HeuristicName
from tests.builders import rectangle_points
from tests.laws.drawings import folded
from tests.laws.outlines import Outline, outlines
from tests.unjudged import Unjudged

MOST_STATES = 100_000
"""The budget of states, which no search of a small scene exhausts: the laws are about costs."""

WORK_S = 10.0
"""The work allowed for a plan, unless its time limit is shorter (s, see `Limits`)."""

FOLDABLE = tuple(name for name in shipped_garment_names() if not name.endswith("-halved"))
"""The shipped garments that can be folded."""

Kinds = Sequence[Callable[[Context], Primitive]]
Bound: TypeAlias = HeuristicName | Literal["driving"]
BOUNDS: tuple[Bound, ...] = (*HEURISTICS, "driving")
"""The heuristics that requests name, and the one that replaces the arms' time if many folds are loose."""


@dataclass(frozen=True)
class Problem:
    """A garment on a table, and a robot at one of the stations.

    Attributes:
        garment: with the folds wanted; its placement is kept.
        scene: the scene.
        start: where the robot stands at the start.
        comfort_m: the comfort radius (m).
    """

    garment: Garment
    scene: Scene
    start: str
    comfort_m: float = 0.0

    @property
    def context(self) -> Context:
        """A fresh planning context of the problem."""
        robot = load_robot("pr2")
        reach = robot.reach(self.scene.torso_m, self.comfort_m)
        return Context(
            FoldSequence.of(self.garment), self.scene, reach, self.garment.placement, robot.card.base_radius_m
        )

    @property
    def first_state(self) -> State:
        return State(0, (0.0, 0.0), [name for name, _ in self.scene.stations].index(self.start), 0)

    def plan(self, heuristic: str = "arm_time", time_limit_s: float = 60.0, *, with_reasons: bool = False) -> Plan:
        """Return the planner's plan, with joint paths; mostly work, the same every time, ends a long search."""
        task = Task.of(
            self.garment,
            self.scene,
            start_station=self.start,
            comfort_radius_m=self.comfort_m,
            heuristic=heuristic,
            time_limit_s=time_limit_s,
            work_limit_s=min(time_limit_s, WORK_S),
        )
        return find_plan(task, with_reasons=with_reasons).plan

    def lean_cost_s(self) -> float:
        """Return the cost by the planner's own edges, which leave out those that are redundant or no cheaper."""
        context, state = self.context, self.first_state
        if context.stability_violation(state.done, state.offset) is not None:
            return math.inf
        edges = Edges(context, Unjudged())
        everything = (1 << len(self.garment.folds)) - 1
        bound = HEURISTICS["arm_time"](context)
        *_, found = a_star(state, edges.leaving, lambda s: s.done == everything, bound, MOST_STATES)
        assert found.outcome is not Outcome.BUDGET_EXCEEDED, "this is no small scene"
        return found.cost

    def cost_s(self, heuristic: Bound = "arm_time", kinds: Kinds = PRIMITIVES) -> float:
        """Return the cost of the cheapest sequence of primitives (s); infinite if there is none."""
        context, state = self.context, self.first_state
        if context.stability_violation(state.done, state.offset) is not None:
            return math.inf
        primitives = [kind(context) for kind in kinds]

        def successors(state: State, _cost_s: float) -> Iterator[Edge[State, Step]]:
            for primitive in primitives:
                for step in primitive.successors(state):
                    yield Edge(step, step.duration_s, step.after)

        everything = (1 << len(self.garment.folds)) - 1
        bound = bound_of(heuristic, context, state)
        *_, found = a_star(state, successors, lambda s: s.done == everything, bound, MOST_STATES)
        assert found.outcome is not Outcome.BUDGET_EXCEEDED, "this is no small scene"
        return found.cost


def bound_of(name: Bound, context: Context, start: State) -> Heuristic:
    return DrivingBound(context, start) if name == "driving" else HEURISTICS[name](context)


@st.composite
def problems(draw: st.DrawFn, most_folds: int = 3, most_stations: int = 3, standoffs: int = 9) -> Problem:
    """Return a small garment in front of the first station, one to a few folds, some of the five stations."""
    wanted = draw(st.sampled_from(range(1, most_folds + 1)))
    cloth = draw(folded(draw(_small_outlines()), wanted, least_folds=wanted))
    assume(cloth.folds and not _is_borderline(cloth))
    cloth = replace(cloth, placement=draw(_placements(cloth.outline)))
    count = draw(st.sampled_from(range(most_stations)))
    others = draw(st.lists(st.sampled_from(list(DEFAULT_STATIONS)[1:]), min_size=count, max_size=count, unique=True))
    stations = tuple((name, DEFAULT_STATIONS[name]) for name in ("front", *others))
    scene = Scene(
        stations=stations,
        friction=draw(st.sampled_from((0.2, 0.5, 1.0))),
        support_angle_rad=draw(st.sampled_from((0.0, math.radians(5.0), math.radians(60.0)))),
        approach_cone_rad=draw(st.sampled_from((math.radians(75.0), math.pi))),
        back_off_max_m=0.05 * draw(st.sampled_from(range(standoffs))),
    )
    return Problem(cloth, scene, draw(st.sampled_from(stations))[0], draw(st.sampled_from((0.0, 0.03))))


def _is_borderline(cloth: Garment) -> bool:
    """Return whether rounding decides what is a sliver and what is cloth, so that another frame may differ."""
    final = FoldSequence.of(cloth).final
    areas = [*(layer.area for layer in final.layers), *final.slivers]
    return any(math.isclose(area, AREA_M2, rel_tol=0.01) for area in areas)


def _small_outlines() -> st.SearchStrategy[Outline]:
    side = st.integers(4, 14).map(lambda n: n * 0.05)
    t_shirt = tuple((0.7 * x, 0.7 * y) for x, y in load_garment("t-shirt").outline)
    return st.one_of(st.builds(rectangle_points, side, side), st.just(t_shirt), outlines(most=8, largest_m=0.6))


@st.composite
def _placements(draw: st.DrawFn, outline: Outline) -> Pose2:
    """Return a pose with the outline's middle within reach of the front, upright or askew, maybe over an edge."""
    middle = [(min(c) + max(c)) / 2 for c in zip(*outline, strict=True)]
    yaw = draw(st.one_of(st.sampled_from([i * math.pi / 2 for i in range(4)]), st.floats(-math.pi, math.pi)))
    x, y = draw(st.floats(-0.6, -0.1)), draw(st.floats(-0.25, 0.25))
    cos, sin = math.cos(yaw), math.sin(yaw)
    return Pose2(x - cos * middle[0] + sin * middle[1], y - sin * middle[0] - cos * middle[1], yaw)
