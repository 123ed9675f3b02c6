"""A comparison of robots as a job: who can fold a garment, how quickly, how tightly, and what it would take."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field

from app.api.messages import GarmentField, TimeLimit
from app.api.request_parsing import requested_garment
from app.comparison import compared
from app.jobs.job_kind import JobKind, Progress, Stores, as_it_is
from planner.cloth.garment import Garment
from planner.errors import RequestError
from planner.robots.known_robots import require_name, robot_names
from planner.strict_model import StrictModel
from planner.task.task import DEFAULT_ROBOT, Limits

_ROBOTS_MAX = 32


class ComparisonRequest(StrictModel):
    """A request for a garment's plans for several robots, each at its own table; without robots, for all of them."""

    garment: GarmentField
    robots: (
        Annotated[
            list[Annotated[str, Field(json_schema_extra={"minLength": 1})]], Field(min_length=1, max_length=_ROBOTS_MAX)
        ]
        | None
    ) = None
    time_limit_s: TimeLimit = 10.0


@dataclass(frozen=True, slots=True)
class ComparisonTask:
    """A garment, and the robots to compare.

    Attributes:
        garment: the garment.
        robots: their names.
        limits: the limits of each plan.
    """

    garment: Garment
    robots: Sequence[str]
    limits: Limits


def _prepare(stores: Stores, wanted: ComparisonRequest) -> ComparisonTask:
    robots = tuple(robot_names()) if wanted.robots is None else tuple(wanted.robots)
    for number, robot in enumerate(robots):
        try:
            require_name(robot)
        except RequestError as error:
            raise RequestError(f"robots[{number}]", error.message) from None
    return ComparisonTask(requested_garment(stores, wanted.garment), robots, Limits(time_limit_s=wanted.time_limit_s))


def compare(asked: ComparisonTask, progress: Progress) -> dict[str, Any]:
    """Return the comparison of each robot as JSON, in the order asked; the work of the job."""
    found = []
    progress(0.0, f"0 of {len(asked.robots)} robots")
    for one in compared(asked.garment, asked.robots, asked.limits):
        found.append(one.to_dict())
        progress(len(found) / len(asked.robots), f"{len(found)} of {len(asked.robots)} robots")
    return {"robots": found}


COMPARISONS = JobKind(
    name="comparisons",
    does="Plan a garment for several robots: who can fold it, how quickly, and what it would take otherwise, as a job.",
    body=ComparisonRequest,
    example={"garment": "hand-towel", "robots": [DEFAULT_ROBOT], "time_limit_s": 2.0},
    prepare=_prepare,
    work=compare,
    finish=as_it_is,
    about=lambda asked: asked.garment.title,
    path="/api/comparisons",
    may_begin_anew=True,
)
