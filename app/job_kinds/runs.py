"""A run as a job: a plan performed by the simulated driver in real time. Hardware is driven from the command line."""

from dataclasses import dataclass
from typing import Annotated, Any

from annotated_types import Interval
from pydantic import Field

from app.drivers.run import Leg, Recording, run_plan
from app.drivers.simulated import SimulatedDriver
from app.files.import_file import LARGEST_PLAN_FILE
from app.files.slowed import SPEEDS, require_speed
from app.job_kinds.rehearsals import solved_plan
from app.jobs.job_kind import JobKind, Progress, Stores, as_it_is
from planner.errors import RequestError
from planner.geometry.tolerance import TIME_S
from planner.json_form import STRICT
from planner.planning.way_to_step import require_beginning
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan


@dataclass(frozen=True, slots=True)
class RunRequest:
    """A request to perform a plan in real time with a simulated robot.

    Attributes:
        plan: the id of a plan, or a plan file's content.
        from_step: the first step to perform. The robot stands as the steps before it leave it; before the first, at
            home.
        until_step: the step before which the run is done; null: it goes on to the plan's end.
        speed: the share of the planned speed.
    """

    __pydantic_config__ = STRICT

    plan: str | dict[str, Any]
    from_step: Annotated[int, Field(json_schema_extra={"minimum": 0})] = 0
    until_step: int | None = None
    speed: Annotated[float, Interval(ge=SPEEDS[0], le=SPEEDS[1])] = 1.0


@dataclass(frozen=True, slots=True)
class RunTask:
    """A plan, and which steps of it are performed how quickly; see `RunRequest`."""

    plan: Plan
    from_step: int
    until_step: int | None
    speed: float


def _prepare(stores: Stores, wanted: RunRequest) -> RunTask:
    require_speed(wanted.speed)
    plan = solved_plan(stores, wanted.plan)
    require_beginning(plan, wanted.from_step)
    count = len(plan.steps)
    if wanted.until_step is not None and not wanted.from_step < wanted.until_step <= count:
        raise RequestError("until_step", f"{wanted.until_step} is not between {wanted.from_step + 1} and {count}")
    return RunTask(plan, wanted.from_step, wanted.until_step, wanted.speed)


def _work(asked: RunTask, progress: Progress) -> dict[str, Any]:
    """Return how the run ended as JSON. Its progress is how far the whole plan is, wherever it began."""
    plan, first = asked.plan, asked.from_step
    path = require_beginning(plan, first)
    starts_s = [step.start_s for step in plan.steps] or [0.0]
    card = load_robot(plan.task.robot).card
    driver = SimulatedDriver(card, at=path.joints_at(starts_s[first]) if first else None)

    def tell(leg: Leg, t_s: float) -> None:
        at_s = starts_s[first] if leg.step is None else starts_s[leg.step] + t_s * asked.speed
        progress(at_s / max(path.duration_s, TIME_S), leg.what)

    ended = run_plan(plan, card, driver, lambda _leg: True, tell, Recording(card), first, asked.speed, asked.until_step)
    return {"ended": ended.how, "done": ended.done, "why": ended.why}


RUNS = JobKind(
    name="runs",
    does="Perform a plan in real time with a simulated robot, as `pleat run` does; its progress is that of the plan.",
    body=RunRequest,
    example={"plan": "0123456789abcdef", "from_step": 0, "speed": 0.5},
    prepare=_prepare,
    work=_work,
    finish=as_it_is,
    about=lambda asked: asked.plan.garment.title,
    path="/api/runs",
    largest_body=LARGEST_PLAN_FILE,
)
