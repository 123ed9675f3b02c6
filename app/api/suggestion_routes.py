"""Routes of suggestions, sent as they are found, and of the map of placements."""

import asyncio
import time
from collections.abc import AsyncIterator
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.sse import EventSourceResponse, ServerSentEvent
from pydantic import BaseModel
from starlette.responses import JSONResponse

from app import searches
from app.api.answers import Change, Says
from app.api.asker import workspace_of
from app.api.body import JsonBody
from app.api.described import DescribedRoute, answering, event_stream, problems
from app.api.disconnect import answer_of, until
from app.api.messages import PlacementsRequest, PlanRequest
from app.api.request_parsing import TimeLimit, requested_places, requested_task, within_request
from app.jobs.job_pool import Job
from app.store.plan_store import UnknownPlanError
from app.worker.process import ignore
from app.worker.stop import LimitedStop, Stop, StoppedError
from app.workspace import Workspace
from planner.deadline import longest_wait_s
from planner.geometry.pose import Pose2
from planner.task.plan import Plan

router = APIRouter(prefix="/api", tags=["suggestions"], route_class=DescribedRoute)

PlacementsRequestBody = Annotated[
    PlacementsRequest,
    Depends(JsonBody(PlacementsRequest, {"garment": "hand-towel", "step_m": 0.5, "time_limit_s": 2.0})),
]
PlanRequestBody = Annotated[PlanRequest, Depends(JsonBody(PlanRequest, {"garment": "hand-towel", "time_limit_s": 2.0}))]


Known = Annotated[str | None, Query(description="id of the answer to this request, which then is not planned again")]


_GRACE_S = 2.0
"""Time after its limit in which a search that has begun may end by itself before its process is killed (s)."""


Kind = Literal[
    "placement",
    "fold_line",
    "split",
    "halve",
    "flip",
    "order",
    "station",
    "robot",
    "size",
    "friction",
    "grip_radius",
    "comfort_radius",
    "together",
]


class TryingEvent(BaseModel):
    """The data of an event `trying`: a change that is being planned."""

    kind: Kind
    says: Says


class SuggestionEvent(BaseModel):
    """The data of an event `suggestion`: a change that gives a plan, and the plan's id."""

    kind: Kind
    is_assumption: bool
    message: str
    says: Says
    change: Change
    size: float
    cost_s: float
    plan_id: str


class DoneEvent(BaseModel):
    """The data of the last event, `done`: how many were found, how long it took, whether all changes were tried."""

    count: int
    elapsed_s: float
    complete: bool


EVENTS = (TryingEvent, SuggestionEvent, DoneEvent)

_SHIFTED: dict[str, Any] = {"kind": "placement", "says": {"code": "place", "quarters": 0, "by": [-0.1, 0.0]}}
STREAM = event_stream(
    {
        "trying": (TryingEvent, _SHIFTED),
        "suggestion": (
            SuggestionEvent,
            {
                **_SHIFTED,
                "is_assumption": False,
                "message": "move it 10 cm",
                "change": {"placement": {"x_m": -0.5, "y_m": 0.2, "yaw_rad": 0.0}},
                "size": 0.1,
                "cost_s": 16.2,
                "plan_id": "0123456789abcdef0123456789abcdef",
            },
        ),
        "done": (DoneEvent, {"count": 1, "elapsed_s": 2.5, "complete": True}),
    },
    "Changes as they are tried and found",
)


class CellAnswer(BaseModel):
    """A placement of the garment frame (m), and the cost of the plan there (s); null: there is no plan."""

    x_m: float
    y_m: float
    cost_s: float | None


@dataclass(frozen=True)
class BestAnswer(Pose2):
    """The cheapest placement."""

    cost_s: float


class PlacementsAnswer(BaseModel):
    """The map of placements; not complete when time ran out first."""

    step_m: float
    cells: list[CellAnswer]
    best: BestAnswer | None
    complete: bool


class SuggestionSearch:
    """A search for one client, begun before the answer starts so that a bad request is answered as an error."""

    def __init__(self, workspace: Workspace, wanted: PlanRequest, known: Plan | None) -> None:
        """Prepare the search; plan nothing yet. `known` is the answer to the request, if there is one."""
        self._workspace = workspace
        self._known = known
        self._wanted = wanted
        self._limit = TimeLimit(wanted.time_limit_s)
        self._started = time.perf_counter()
        self._loop = asyncio.get_running_loop()
        self._news: asyncio.Queue[searches.Suggested | searches.Tried | None] = asyncio.Queue()
        self._begun: Future[None] = Future()
        self._job: Job[bool] | None = None

    async def begin(self, request: Request) -> None:
        """Plan the request itself; raises an error for a bad request."""
        pool = self._workspace.lanes.searches
        self._job = pool.start(self._search)
        self._job.future.add_done_callback(self._ended)
        try:
            await until(request, pool, self._job, self._begun, self._limit.limit_s)
        except BaseException:
            self._job.stop()
            raise

    async def events(self) -> AsyncIterator[ServerSentEvent]:
        """Yield the suggestions as they are found; stop the search when the client disconnects."""
        assert self._job is not None
        count = 0
        try:
            while (found := await self._news.get()) is not None:
                if isinstance(found, searches.Tried):
                    yield ServerSentEvent(event="trying", data=found.body)
                    continue
                count += 1
                plan_id = self._workspace.plans.add(found.plan)
                yield ServerSentEvent(event="suggestion", data={**found.body, "plan_id": plan_id})
            if not self._job.future.cancelled():
                yield self._done(count, is_complete=self._job.future.result())
        finally:
            self._job.stop()

    def _search(self, stop: Stop) -> bool:
        task = requested_task(self._workspace, self._wanted, self._limit)
        known = self._known
        if known is not None and replace(known.task, limits=task.limits) != task:
            known = None
        with LimitedStop(stop, longest_wait_s(self._limit.limit_s) + _GRACE_S) as limited, within_request():

            def hear(news: searches.Suggested | searches.Tried | None) -> None:
                if news is None:
                    limited.begin()
                self._hear(news)

            try:
                return self._workspace.lanes.background.run(searches.suggest, limited, hear, task, known)
            except StoppedError:
                if stop():
                    raise
                return False  # it took too long over something; what it has found by then is sent

    def _hear(self, news: searches.Suggested | searches.Tried | None) -> None:
        if news is None:
            self._begun.set_result(None)
        else:
            self._tell(news)

    def _ended(self, future: Future[bool]) -> None:
        if not self._begun.done():
            if future.cancelled():
                self._begun.cancel()
            else:
                self._begun.set_exception(future.exception())
        self._tell(None)

    def _tell(self, found: searches.Suggested | searches.Tried | None) -> None:
        with suppress(RuntimeError):  # the loop has ended: nobody reads the events
            self._loop.call_soon_threadsafe(self._news.put_nowait, found)

    def _done(self, count: int, *, is_complete: bool) -> ServerSentEvent:
        elapsed_s = time.perf_counter() - self._started
        data = {"count": count, "elapsed_s": elapsed_s, "complete": is_complete}
        return ServerSentEvent(event="done", data=data)


def _still_kept(workspace: Workspace, plan_id: str) -> Plan | None:
    """Return a plan by its id; None if it was dropped because its document has a better one."""
    try:
        return workspace.plans.plan(plan_id)
    except UnknownPlanError:
        return None


async def _begun(request: Request, wanted: PlanRequestBody, known: Known = None) -> SuggestionSearch:
    """Return the search of a request that has been checked."""
    workspace = workspace_of(request)
    plan = None if known is None else await run_in_threadpool(_still_kept, workspace, known)
    search = SuggestionSearch(workspace, wanted, plan)
    await search.begin(request)
    return search


@router.post(
    "/suggestions", response_class=EventSourceResponse, responses={200: STREAM, **problems(404, 413, 422, 503)}
)
async def post_suggestions(search: Annotated[SuggestionSearch, Depends(_begun)]) -> AsyncIterator[ServerSentEvent]:
    """Find the smallest changes that give a plan, each with its plan, and return them as server-sent events.

    Each event `trying` names a change before it is planned, each event `suggestion` has one change as it is found;
    `done` then says whether all changes were tried in the time. A change replaces fields of the request. Other robots
    are tried at last, where fewer than three kinds of change help. If there is a plan already, only a better placement
    is suggested.
    """
    async for event in search.events():
        yield event


@router.post("/placements", responses=answering(PlacementsAnswer, 404, 413, 422, 503))
async def post_placements(request: Request, wanted: PlacementsRequestBody) -> JSONResponse:
    """Plan a garment wherever it could be laid on the default table, not turned, and return the costs."""
    workspace, limit = workspace_of(request), TimeLimit(wanted.time_limit_s)
    work = partial(_placements, workspace, wanted, limit)
    return JSONResponse(await answer_of(request, workspace.lanes.searches, work, limit.limit_s))


def _placements(workspace: Workspace, wanted: PlacementsRequest, limit: TimeLimit, stop: Stop) -> dict[str, Any]:
    task = requested_places(workspace, wanted, limit)
    with within_request():
        found = workspace.lanes.workers.run(searches.map_places, stop, ignore, task, wanted.step_m)
    return found.to_dict()
