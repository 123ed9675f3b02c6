"""Routes of robots: the list, one robot's card, and saving one's own."""

from functools import partial
from pathlib import Path as FilePath
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Header, Path, Query, Request, Response
from fastapi.concurrency import run_in_threadpool
from starlette.responses import JSONResponse

from app import searches
from app.api.answers import RobotEntry, RobotTaken
from app.api.asker import workspace_of
from app.api.body import JsonBody, read_bytes
from app.api.described import DescribedRoute, answering, problems
from app.api.disconnect import answer_of
from app.api.job_answers import JobAnswer
from app.api.job_routes import begun
from app.files.robot_archive import PACKED_BYTES_MAX
from app.job_kinds.robots import ROBOTS
from app.store.robot_repository import RobotRepository
from app.worker.process import ignore
from app.worker.stop import Stop
from app.worker.template import LostProcessError
from app.workspace import Workspace
from planner.errors import RobotError
from planner.robots.card_file import CardFile
from planner.robots.drafting.draft import Draft
from planner.robots.known_robots import card_of, robot_cards, robot_entry, shipped_card
from planner.task.task import DEFAULT_ROBOT

router = APIRouter(prefix="/api/robots", tags=["robots"], route_class=DescribedRoute)

_ARCHIVE = {
    "requestBody": {
        "required": True,
        "content": {
            kind: {"schema": {"type": "string", "format": "binary"}}
            for kind in ("application/zip", "application/octet-stream")
        },
    }
}

_BENCH = {**shipped_card("so101-pair").to_dict(), "name": "bench", "title": "My bench"}
CardBody = Annotated[CardFile, Depends(JsonBody(CardFile, _BENCH))]
_ASYNC = "respond-async"
Prefer = Annotated[str | None, Header(description=f"`{_ASYNC}`: import it as a job.")]
FileName = Annotated[str | None, Query(max_length=300, description="the file's name, by whose ending it is read")]
AnyName = Annotated[str, Path(examples=[DEFAULT_ROBOT])]
OwnName = Annotated[str, Path(examples=[_BENCH["name"]])]


@router.get("", response_model=list[RobotEntry])
async def list_robots() -> list[dict[str, Any]]:
    """Return all robots that are described, the shipped ones first."""
    cards = await run_in_threadpool(robot_cards)
    return [robot_entry(card) for card in cards]


@router.post(
    "/imports",
    openapi_extra=_ARCHIVE,
    responses={
        200: {"model": RobotTaken},
        201: {"model": RobotTaken},
        202: {"model": JobAnswer},
        **problems(403, 409, 413, 422, 429, 503, 507),
    },
)
async def post_robot_import(request: Request, prefer: Prefer = None, filename: FileName = None) -> JSONResponse:
    """Save or replace a robot of one's own: 201 if it is new, 200 if it existed.

    The body is a zip archive of `robot.json`, its URDF and its meshes. The errors name the card's field, and the frame,
    joint or mesh that is missing; those of the archive itself are about the field `file`. Where the robot's arms can
    reach is found when it is first planned for, which takes up to half a minute an arm.

    With the file's name as `filename` it may also be a URDF, MuJoCo's XML, or an archive of one with its meshes: then
    the card is drafted, and `draft` has what was guessed and what is not known, a sentence each.

    With `Prefer: respond-async` it is a job, answered by 202, which also finds where the arms can reach; its result has
    `robot` and `is_new`.
    """
    data = await read_bytes(request, PACKED_BYTES_MAX)
    workspace = workspace_of(request)
    if _ASYNC in (prefer or "").replace(" ", "").lower().split(","):
        return await _as_job(request, workspace.robots, data)
    work = partial(_imported, workspace, data if filename is None else searches.Described(filename, data))
    card, draft, is_new = await answer_of(request, workspace.lanes.robots, work)
    drafted = {} if draft is None else {"draft": {"guesses": draft.guesses, "unknown": draft.unknown}}
    return JSONResponse({**robot_entry(card), **drafted}, status_code=201 if is_new else 200)


@router.get("/{name}", responses=answering(CardFile, 404, 422))
async def read_robot_card(name: AnyName) -> JSONResponse:
    """Return a robot's card with every field filled in."""
    card = await run_in_threadpool(card_of, name)
    return JSONResponse(card.to_dict())


@router.get("/{name}/warnings", response_model=list[dict[str, Any]], responses=problems(404, 422, 503))
async def read_robot_warnings(request: Request, name: AnyName) -> list[dict[str, Any]]:
    """Return what of a robot's card is allowed but probably not meant, before its arms are mapped.

    Each has `code`, `message` and numbers: `part_too_large`, `part_too_small`, `arms_together`, `arms_crossed`,
    `station_faces_away`, `mount_faces_away`, `station_in_table`, `tool_off_tips`.
    """
    await run_in_threadpool(card_of, name)

    lanes = workspace_of(request).lanes

    def warned(stop: Stop) -> list[dict[str, Any]]:
        return lanes.workers.run_alone(searches.robot_warnings, stop, ignore, name)

    return await answer_of(request, lanes.files, warned)


@router.put(
    "/{name}", responses={200: {"model": CardFile}, 201: {"model": CardFile}, **problems(403, 409, 413, 422, 503, 507)}
)
async def save_robot_card(request: Request, name: OwnName, card: CardBody) -> JSONResponse:
    """Save or replace the card of a robot of one's own: 201 if it is new, 200 if it existed.

    Its URDF is in an installed package, or among the files that an import has put beside the card.
    """
    if card.name != name:
        raise RobotError("name", f"is {card.name!r}, but the address says {name!r}")
    workspace = workspace_of(request)
    is_new = await answer_of(request, workspace.lanes.robots, partial(_saved, workspace, card))
    return JSONResponse(card.to_dict(), status_code=201 if is_new else 200)


@router.delete("/{name}", status_code=204, responses=problems(403, 404, 409))
async def remove_robot(request: Request, name: OwnName) -> Response:
    """Remove a robot of one's own with its files."""
    await run_in_threadpool(workspace_of(request).robots.remove, name)
    return Response(status_code=204)


async def _as_job(request: Request, robots: RobotRepository, data: bytes) -> JSONResponse:
    folder = await run_in_threadpool(robots.new_folder)
    try:
        await run_in_threadpool(searches.put_archive, data, folder)
        answer = await begun(request, ROBOTS, {"folder": folder.name})
    except BaseException:
        robots.discard(folder)
        raise
    answer.headers["preference-applied"] = _ASYNC
    return answer


def _imported(
    workspace: Workspace, given: bytes | searches.Described, stop: Stop
) -> tuple[CardFile, Draft | None, bool]:
    with workspace.robots.beside() as unpacked:
        card, draft = _looked_at(workspace, stop, unpacked, given)
        return card, draft, workspace.robots.take(card.name, unpacked)


def _saved(workspace: Workspace, card: CardFile, stop: Stop) -> bool:
    _looked_at(workspace, stop, workspace.robots.place(card.name), card)
    return workspace.robots.save(card)


def _looked_at(
    workspace: Workspace, stop: Stop, folder: FilePath, given: bytes | searches.Described | CardFile
) -> tuple[CardFile, Draft | None]:
    """Return the card of a file, or a card as it stands in a folder, and what was drafted; raise if it is not valid."""
    try:
        return workspace.lanes.workers.run_alone(searches.read_robot, stop, ignore, folder, given)
    except LostProcessError:
        said = f"cannot be read: the program that read it has ended; {searches.READING_LIMITS}"
        raise RobotError("urdf", said) from None
