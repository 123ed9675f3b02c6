"""A rehearsal as a job: a plan performed in simulated physics, every step judged."""

from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field

from app.files.import_file import LARGEST_PLAN_FILE
from app.jobs.job_kind import JobKind, Progress, Stores
from app.rehearsal.noise import NOISE
from app.rehearsal.rehearse import RUNS_MAX, RehearsalOptions, rehearse, require_physics
from planner.errors import FieldError, UnsolvedPlanError
from planner.json_form import STRICT
from planner.task.plan import Plan

TRACED = 10
"""The number of the first runs of which a trace is kept."""


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
    runs: Annotated[int, Field(json_schema_extra={"minimum": 1, "maximum": RUNS_MAX})] = 1
    seed: int = 0
    noise: Annotated[str, Field(json_schema_extra={"enum": list(NOISE)})] = "none"
    feedback: bool = True


def solved_plan(stores: Stores, given: str | dict[str, Any]) -> Plan:
    """Return the plan of a request's field `plan`, by id or as a plan file's content; it is solved.

    Raises:
        UnknownPlanError: there is no such plan.
        FieldError: the content is no plan.
        UnsolvedPlanError: the plan is not solved.
    """
    if isinstance(given, str):
        plan = stores.plans.plan(given)
    else:
        try:
            plan = Plan.from_dict(given)
        except FieldError as error:
            raise error.within("plan") from None
    if not plan.is_solved:
        raise UnsolvedPlanError(plan.status)
    return plan


def _prepare(stores: Stores, wanted: RehearsalRequest) -> tuple[Plan, RehearsalOptions]:
    options = RehearsalOptions(wanted.runs, wanted.seed, wanted.noise, wanted.feedback, traced=TRACED)
    plan = solved_plan(stores, wanted.plan)
    require_physics()
    return plan, options


def _work(asked: tuple[Plan, RehearsalOptions], progress: Progress) -> tuple[dict[str, Any], list[bytes]]:
    """Return the result as JSON, and the traces of the first runs."""
    plan, options = asked
    result = rehearse(plan, options, lambda share: progress(share, "rehearsing"))
    return result.to_dict(), [run.trace.packed() for run in result.runs if run.trace is not None]


def _finish(stores: Stores, answer: tuple[dict[str, Any], list[bytes]]) -> dict[str, Any]:
    result, traces = answer
    kept = [stores.traces.add(trace) for trace in traces]
    for number, run in enumerate(result["runs"]):
        run["trace"] = kept[number] if number < len(kept) else None
    return result


REHEARSALS = JobKind(
    name="rehearsals",
    does="Perform a plan in simulated physics, and say of every step whether it holds.",
    body=RehearsalRequest,
    example={"plan": "0123456789abcdef", "runs": 1, "noise": "none"},
    prepare=_prepare,
    work=_work,
    finish=_finish,
    about=lambda asked: asked[0].garment.title,
    path="/api/rehearsals",
    largest_body=LARGEST_PLAN_FILE,
    may_begin_anew=True,
)
