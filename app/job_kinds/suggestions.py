"""Suggestions as a job: the smallest changes that give a plan."""

from typing import Any

from app import searches
from app.api.messages import PlanRequest
from app.api.request_parsing import TimeLimit, requested_task
from app.jobs.job_kind import JobKind, Stores
from planner.task.plan import Plan
from planner.task.task import Task


def _prepare(stores: Stores, wanted: PlanRequest) -> tuple[Task, Plan | None]:
    return requested_task(stores, wanted, TimeLimit(wanted.time_limit_s)), None


def _finish(stores: Stores, answer: tuple[list[searches.Suggested], bool]) -> dict[str, Any]:
    found, is_complete = answer
    suggestions = [{**one.body, "plan_id": stores.plans.add(one.plan)} for one in found]
    return {"suggestions": suggestions, "complete": is_complete}


SUGGESTIONS = JobKind(
    name="suggestions",
    does="Find the smallest changes that give a plan, as `POST /api/suggestions` does, as a job.",
    body=PlanRequest,
    example={"garment": "hand-towel", "time_limit_s": 2.0},
    prepare=_prepare,
    work=searches.all_suggestions,
    finish=_finish,
    about=lambda asked: asked[0].garment.title,
    may_begin_anew=True,
)
