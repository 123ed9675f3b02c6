"""A rehearsal as a job: a plan performed in simulated physics, every step judged."""

from dataclasses import dataclass
from typing import Any

from app.files.import_file import LARGEST_PLAN_FILE
from app.jobs.job_kind import JobKind, Progress, Stores, as_it_is
from app.rehearsal.rehearse import RehearsalOptions, rehearse, require_physics
from planner.errors import FieldError, UnsolvedPlanError
from planner.json_form import STRICT
from planner.task.plan import Plan


@dataclass(frozen=True, slots=True)
class RehearsalRequest:
    """A request to rehearse a plan.

    Attributes:
        plan: the id of a plan, or a plan file's content.
        runs: how often it is performed.
        seed: the seed of the first run; each after it has the next.
        noise: the errors of robot, cloth and camera: "none" or "real".
        feedback: whether the robot looks before each step and corrects it.
    """

    __pydantic_config__ = STRICT

    plan: str | dict[str, Any]
    runs: int = 1
    seed: int = 0
    noise: str = "none"
    feedback: bool = True


def _prepare(stores: Stores, wanted: RehearsalRequest) -> tuple[Plan, RehearsalOptions]:
    options = RehearsalOptions(wanted.runs, wanted.seed, wanted.noise, wanted.feedback)
    if isinstance(wanted.plan, str):
        plan = stores.plans.plan(wanted.plan)
    else:
        try:
            plan = Plan.from_dict(wanted.plan)
        except FieldError as error:
            raise error.within("plan") from None
    if not plan.is_solved:
        raise UnsolvedPlanError(plan.status)
    require_physics()
    return plan, options


def _work(asked: tuple[Plan, RehearsalOptions], progress: Progress) -> dict[str, Any]:
    plan, options = asked
    return rehearse(plan, options, lambda share: progress(share, "rehearsing")).to_dict()


REHEARSALS = JobKind(
    name="rehearsals",
    does="Perform a plan in simulated physics, and say of every step whether it holds.",
    body=RehearsalRequest,
    example={"plan": "0123456789abcdef", "runs": 1, "noise": "none"},
    prepare=_prepare,
    work=_work,
    finish=as_it_is,
    path="/api/rehearsals",
    largest_body=LARGEST_PLAN_FILE,
    may_begin_anew=True,
)
