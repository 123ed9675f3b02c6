"""Tasks made to break the planner get an answer, or one of our errors, within their time."""

from random import Random
from time import process_time

from hypothesis import given, settings
from hypothesis import strategies as st

from planner.errors import FoldingError
from planner.motion.timeline import Timeline
from planner.planning.warm_up import compile_kernels
from tests.laws.law import LONG, law
from tests.laws.tasks import rough_task
from tests.required import required

LIMITS_S = (0.05, 0.3, 1.0)
"""Time limits of a plan."""

OVERRUN_S = 0.5
"""The processor time by which a limit may be exceeded (s)."""

MOMENTS = 8


@given(st.integers(0, 2**32 - 1))
@law("rough", short=16, long=10_000)
def test_whatever_is_asked_the_answer_is_a_plan_or_a_reason_or_an_error_of_ours(seed: int) -> None:
    rng = Random(seed)
    compile_kernels()
    try:
        problem = rough_task(rng)
    except FoldingError:
        return
    limit_s = rng.choice(LIMITS_S)
    began_s = process_time()
    try:
        plan = problem.plan(time_limit_s=limit_s)
    except FoldingError:
        return
    if settings.get_current_profile_name() == LONG:
        # Only where there is time to look at a failure again: on a busy machine it may be the machine's.
        assert process_time() - began_s <= limit_s + OVERRUN_S
    plan.to_dict()
    if plan.is_solved:
        timeline = Timeline.of(plan)
        for number in range(MOMENTS):
            timeline.at(required(plan.cost_s) * number / (MOMENTS - 1))
