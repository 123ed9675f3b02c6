"""The map of placements as a job: the cost of the plan wherever the garment could be laid."""

from app import searches
from app.api.messages import PlacementsRequest
from app.api.request_parsing import TimeLimit, requested_places
from app.jobs.job_kind import JobKind, Stores, as_it_is
from planner.task.task import Task


def _prepare(stores: Stores, wanted: PlacementsRequest) -> tuple[Task, float]:
    return requested_places(stores, wanted, TimeLimit(wanted.time_limit_s)), wanted.step_m


PLACEMENTS = JobKind(
    name="placements",
    does="Plan a garment wherever it could be laid, as `POST /api/placements` does, as a job.",
    body=PlacementsRequest,
    example={"garment": "hand-towel", "step_m": 0.5, "time_limit_s": 2.0},
    prepare=_prepare,
    work=searches.whole_map,
    finish=as_it_is,
    about=lambda asked: asked[0].garment.title,
    may_begin_anew=True,
)
