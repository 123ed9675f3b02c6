"""Suggestions as they are found, and the map of placements."""

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import suppress
from functools import partial
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, Request
from fastapi.sse import EventSourceResponse, ServerSentEvent
from pydantic import BaseModel
from starlette.responses import JSONResponse

from app.api.answers import PoseFile
from app.api.asked import asked_garment, asked_scene, workspace_of
from app.api.body import read_model
from app.api.described import problems, takes
from app.api.messages import PlacementsRequest, PlanRequest
from app.api.waiting import answer_of
from app.job_pool import ShouldStop
from app.workspace import Workspace
from planner.errors import FoldError, GarmentError, SceneError
from planner.geometry.pose import Pose2
from planner.plan.suggestion import Suggestion
from planner.plan.suggestion_map import placement_map
from planner.plan.suggestions import Suggestions, suggestions

router = APIRouter(prefix="/api", tags=["suggestions"])

Tell = Callable[[ServerSentEvent | None], None]


class SuggestionEvent(BaseModel):
    """The data of an event `suggestion`; the last, `done`, has `count`, `elapsed_s` and `complete`."""

    kind: Literal["placement", "fold_line", "order", "station", "friction", "grip_radius", "comfort_radius"]
    is_assumption: bool
    message: str
    says: dict[str, Any]
    change: dict[str, Any]
    size: float
    cost_s: float
    plan_id: str


class CellAnswer(BaseModel):
    """A placement of the article frame (m), and what the plan then costs (s); null: there is none."""

    x_m: float
    y_m: float
    cost_s: float | None


class BestAnswer(PoseFile):
    """The cheapest placement."""

    cost_s: float


class PlacementsAnswer(BaseModel):
    """The map of placements; not complete when time ran out first."""

    step_m: float
    cells: list[CellAnswer]
    best: BestAnswer | None
    complete: bool


class SuggestionSearch:
    """A search for one client: begun before the answer starts, so that a bad request is still told as such."""

    def __init__(self, workspace: Workspace, wanted: PlanRequest) -> None:
        """Nothing is planned yet."""
        self._workspace = workspace
        self._wanted = wanted
        self._started = time.perf_counter()
        self._is_unwanted: ShouldStop = bool
        self._found: Suggestions | None = None
        self._is_complete = False

    def begin(self, should_stop: ShouldStop) -> None:
        """Plan the request itself; raises what is wrong with it."""
        self._is_unwanted = should_stop
        wanted = self._wanted
        garment = asked_garment(self._workspace, wanted.garment)
        scene = asked_scene(wanted.scene)
        placed = wanted.placement
        try:
            self._found = suggestions(
                garment,
                scene,
                placement=Pose2(placed.x_m, placed.y_m, placed.yaw_rad) if placed else None,
                start_station=wanted.start_station,
                robot=wanted.robot,
                comfort_radius_m=wanted.comfort_radius_m,
                heuristic=wanted.heuristic,
                time_limit_s=wanted.time_limit_s,
                max_expanded=wanted.max_expanded,
                should_stop=lambda: self._is_unwanted(),
            )
        except (FoldError, GarmentError) as error:
            raise error.within("garment") from None
        except SceneError as error:
            raise error.within("scene") from None

    async def events(self) -> AsyncIterator[ServerSentEvent]:
        """The suggestions as they are found; when nobody reads them any more, the search is stopped."""
        loop = asyncio.get_running_loop()
        told: asyncio.Queue[ServerSentEvent | None] = asyncio.Queue()

        def tell(event: ServerSentEvent | None) -> None:
            with suppress(RuntimeError):  # the loop has gone
                loop.call_soon_threadsafe(told.put_nowait, event)

        job = self._workspace.pool.start(partial(self._search, tell))
        job.future.add_done_callback(lambda _: tell(None))
        try:
            while (event := await told.get()) is not None:
                yield event
            if not job.future.cancelled():
                yield self._done(job.future.result())
        finally:
            job.stop()

    def _search(self, tell: Tell, should_stop: ShouldStop) -> int:
        self._is_unwanted = should_stop
        count = 0
        for suggestion in self._all():
            count += 1
            plan_id = self._workspace.plans.add(suggestion.plan)
            tell(ServerSentEvent(event="suggestion", data={**suggestion.to_dict(), "plan_id": plan_id}))
        return count

    def _all(self) -> Iterator[Suggestion]:
        """What is found; then it is known whether all changes were tried."""
        if self._found is not None:
            self._is_complete = yield from self._found

    def _done(self, count: int) -> ServerSentEvent:
        elapsed_s = time.perf_counter() - self._started
        return ServerSentEvent(
            event="done", data={"count": count, "elapsed_s": elapsed_s, "complete": self._is_complete}
        )


async def _begun(request: Request) -> SuggestionSearch:
    """The search that a request asks for, its request found good."""
    search = SuggestionSearch(workspace_of(request), await read_model(request, PlanRequest))
    await answer_of(request, workspace_of(request).pool.start(search.begin))
    return search


@router.post(
    "/suggestions",
    response_class=EventSourceResponse,
    openapi_extra=takes(PlanRequest),
    responses={200: {"model": SuggestionEvent}, **problems(404, 413, 422)},
)
async def post_suggestions(
    search: Annotated[SuggestionSearch, Depends(_begun)],
) -> AsyncIterator[ServerSentEvent]:
    """The smallest changes that give a plan, each with the plan that proves it, as server-sent events.

    An event `suggestion` for each as it is found, then `done`, which says whether all changes were tried in the time. A
    change replaces fields of the request. Where there is a plan already, a better placement is all that is suggested.
    """
    async for event in search.events():
        yield event


@router.post(
    "/placements",
    openapi_extra=takes(PlacementsRequest),
    responses={200: {"model": PlacementsAnswer}, **problems(404, 413, 422)},
)
async def post_placements(request: Request) -> JSONResponse:
    """Plan a garment wherever it could be laid on the default table, not turned, and return what that costs."""
    wanted = await read_model(request, PlacementsRequest)
    workspace = workspace_of(request)
    job = workspace.pool.start(partial(_placements, workspace, wanted))
    return JSONResponse(await answer_of(request, job))


def _placements(workspace: Workspace, wanted: PlacementsRequest, should_stop: ShouldStop) -> dict[str, Any]:
    garment = asked_garment(workspace, wanted.garment)
    try:
        found = placement_map(garment, step_m=wanted.step_m, time_limit_s=wanted.time_limit_s, should_stop=should_stop)
    except (FoldError, GarmentError) as error:
        raise error.within("garment") from None
    return found.to_dict()
