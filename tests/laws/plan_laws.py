"""How far the plans of one task and of a changed one are from what a law says of them."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from random import Random
from typing import Unpack

from planner import Plan, make_plan
from tests.builders import SceneFields
from tests.laws.images import mirrored, redrawn, reordered, turned
from tests.laws.scenes import Problem

SAME_S = 1e-5
"""The tolerance of costs that joints decide (s)."""

REDRAWN_SHARE = 1e-3
"""The tolerance for another frame: cloth lies up to half a micrometre aside, and joint times follow it."""


@dataclass(frozen=True)
class Differences:
    """The plan of a task, and by how much its images and variants break the laws.

    Attributes:
        plan: the plan.
        by_law: for each law the largest difference (s); 0 if it holds, infinite if one task has a plan and the other a
            proven "no".
    """

    plan: Plan
    by_law: dict[str, float]

    @property
    def gap_s(self) -> float:
        """How far the plan is above its lower bound (s); NaN without a plan."""
        bound_s = self.plan.statistics.bound_s
        return math.nan if self.plan.cost_s is None or bound_s is None else self.plan.cost_s - bound_s


Broken = Callable[[Problem, Plan, Random], float]
"""By how much a law is broken (s)."""


def cost_s(plan: Plan) -> float:
    return math.inf if plan.cost_s is None else plan.cost_s


def _apart_s(one: Plan, other: Plan) -> float:
    if one.cost_s is None and other.cost_s is None:
        return 0.0
    apart_s = abs(cost_s(one) - cost_s(other))
    return 0.0 if apart_s <= SAME_S else apart_s


def _dearer_s(wide: Plan, narrow: Plan) -> float:
    """Return by how much a task with more freedom costs more (s)."""
    if narrow.cost_s is None:
        return 0.0
    dearer_s = cost_s(wide) - cost_s(narrow)
    return 0.0 if dearer_s <= SAME_S else dearer_s


def _image(of: Callable[[Problem], Problem]) -> Broken:
    return lambda problem, plan, _: _apart_s(plan, of(problem).plan())


def _redrawn(problem: Problem, plan: Plan, rng: Random) -> float:
    image = redrawn(problem, rng.uniform(-math.pi, math.pi), (rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0)))
    apart_s = _apart_s(plan, image.plan())
    return 0.0 if apart_s <= REDRAWN_SHARE * (plan.cost_s or 0.0) else apart_s


def _reordered(problem: Problem, plan: Plan, rng: Random) -> float:
    return _apart_s(plan, reordered(problem, rng).plan())


def _uninformed(problem: Problem, plan: Plan, _: Random) -> float:
    """Compare with the search without a lower bound, where that ends by itself."""
    other = problem.plan("zero")
    return 0.0 if other.statistics.is_cut_short else _apart_s(plan, other)


def _tails(_: Problem, plan: Plan, rng: Random) -> float:
    """Return by how much the rest after a step, planned anew, costs more than it does in the plan (s).

    Cloth in the hands takes how it came there, so that the rest is planned after steps that leave none.
    """
    free = [step for step in range(len(plan.steps) - 1) if not plan.state_after(step).held]
    left = [
        (step, (plan.cost_s or 0.0) - plan.steps[step].end_s)
        for step in sorted({*free[:1], *rng.sample(free, min(1, len(free)))})
    ]
    rests = [(make_plan(replace(plan.task, start=plan.state_after(step))), left_s) for step, left_s in left]
    return max((dearer for rest, left_s in rests if (dearer := cost_s(rest) - left_s) > SAME_S), default=0.0)


def _narrower(*narrow: Callable[[Problem], Problem]) -> Broken:
    return lambda problem, plan, _: max(_dearer_s(plan, less(problem).plan()) for less in narrow)


def _wider(wide: Callable[[Problem], Problem]) -> Broken:
    return lambda problem, plan, _: _dearer_s(wide(problem).plan(), plan)


def _front_alone(problem: Problem) -> Problem:
    front = tuple((name, pose) for name, pose in problem.scene.stations if name == problem.start)
    return replace(problem, scene=replace(problem.scene, stations=front))


def _in_scene(**fields: Unpack[SceneFields]) -> Callable[[Problem], Problem]:
    return lambda problem: replace(problem, scene=replace(problem.scene, **fields))


LAWS: dict[str, Broken] = {
    "mirror": _image(mirrored),
    "turn": _image(turned),
    "redraw": _redrawn,
    "order": _reordered,
    "tail": _tails,
    "h=0": _uninformed,
    "comfort": _wider(lambda problem: replace(problem, comfort_m=0.0)),
    "friction": _narrower(_in_scene(friction=0.5)),
    "cone": _narrower(_in_scene(approach_cone_rad=0.7)),
    "standoff": _narrower(_in_scene(back_off_max_m=0.4)),
    "stations": _narrower(_front_alone),
}
"""The laws of plans by name."""


def differences(problem: Problem, seed: int, laws: tuple[str, ...] = tuple(LAWS)) -> Differences:
    """Return the plan of a task and how it and its variants keep the laws; the seed chooses among the variants."""
    plan = problem.plan()
    return Differences(plan, {name: LAWS[name](problem, plan, Random(seed)) for name in laws})
