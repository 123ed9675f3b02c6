"""Routes of documents: the list, each one with its history, playback and overlays, and links to look at it."""

from dataclasses import asdict
from typing import Annotated, Any
from urllib.parse import urlencode

from fastapi import APIRouter, Depends, Query, Request, Response
from fastapi.concurrency import run_in_threadpool
from pydantic import BaseModel
from starlette.responses import JSONResponse

from app.api.asker import workspace_of
from app.api.body import JsonBody
from app.api.commands import Wanted, dispatch, play
from app.api.described import DescribedRoute, answering, problems
from app.api.disconnect import answer_of
from app.api.document_answers import (
    CreaseAnswer,
    DocumentAnswer,
    PlacesAnswer,
    PlaybackAnswer,
    QuickFixesAnswer,
    StepsAnswer,
    VersionAnswer,
)
from app.api.document_messages import (
    AnyCommand,
    AskOverlays,
    AskQuickFixes,
    AskSteps,
    Command,
    CreaseRequest,
    EditRequest,
    GarmentRequest,
    NewDocument,
    Redo,
    RobotRequest,
    TravelRequest,
    Undo,
)
from app.api.live_messages import document_message, document_text, playback_message
from app.api.messages import PlacesRequest
from app.api.problems import ProblemResponse
from app.api.questions import Asked, work_of
from app.api.request_parsing import requested_garment
from app.api.shared import is_shared
from app.drawing.arcs import with_arcs
from app.drawing.drawing import Drawing
from app.drawing.edit import StaleVersionError
from app.drawing.garment_drawing import blank_drawing, drawing_of
from app.open_document import OpenDocument
from app.overlays.overlays import OVERLAYS, OverlaysAnswer
from app.store.document_repository import DocumentEntry
from app.workspace import Workspace
from planner.errors import RequestError

router = APIRouter(prefix="/api/documents", tags=["documents"], route_class=DescribedRoute)

EditRequestBody = Annotated[EditRequest, Depends(JsonBody(EditRequest, {"base_version": 1, "phase": "cancel"}))]
GarmentRequestBody = Annotated[GarmentRequest, Depends(JsonBody(GarmentRequest, {"garment": "tie"}))]
TravelRequestBody = Annotated[TravelRequest, Depends(JsonBody(TravelRequest, {"base_version": 1}, may_be_empty=True))]
RobotRequestBody = Annotated[RobotRequest, Depends(JsonBody(RobotRequest, {"robot": "ur5e-pair"}))]
PlacesRequestBody = Annotated[
    PlacesRequest, Depends(JsonBody(PlacesRequest, {"step_m": 0.5, "time_limit_s": 2.0}, may_be_empty=True))
]
CreaseRequestBody = Annotated[
    CreaseRequest, Depends(JsonBody(CreaseRequest, {"after": 0, "line": {"start": [0.0, 0.2], "end": [0.4, 0.2]}}))
]
CommandBody = Annotated[Command, Depends(JsonBody(AnyCommand, {"do": "pause"}))]
NewDocumentBody = Annotated[NewDocument, Depends(JsonBody(NewDocument, {"garment": "hand-towel"}))]

PAGE, PAGE_MAX = 100, 500
"""Documents on a page of the list: by default, and at most."""

Limit = Annotated[int, Query(ge=1, le=PAGE_MAX, description="documents on the page")]
Time = Annotated[float | None, Query(ge=0.0, allow_inf_nan=False)]
BackOff = Annotated[float, Query(allow_inf_nan=False)]
Shown = Annotated[str | None, Query(description=f"some of {', '.join(OVERLAYS)}, separated by commas; all by default")]
After = Annotated[str, Query(max_length=100, description="where the page before ended, as its `Link` has it")]

_CHANGED: dict[int | str, dict[str, Any]] = {
    200: {"model": DocumentAnswer},
    **problems(403, 404, 409, 413, 422, 429, 507),
}


class ShareAnswer(BaseModel):
    """A new link: the path of the page that it leads to."""

    path: str


@router.get("", responses=problems(422))
async def list_documents(
    request: Request, response: Response, limit: Limit = PAGE, after: After | None = None
) -> tuple[DocumentEntry, ...]:
    """Return the documents, the latest changed first; those whose file cannot be read come last.

    If there are more than `limit`, the header `Link` leads to the next ones: `<?limit=...&after=...>; rel="next"`.
    """
    documents = workspace_of(request).documents
    page = await run_in_threadpool(documents.page, _place(after), limit)
    if page.end is not None:
        query = urlencode({"limit": limit, "after": "/".join(page.end)})
        response.headers["link"] = f'<?{query}>; rel="next"'
    return page.entries


@router.post("", status_code=201, responses=answering(DocumentAnswer, 403, 404, 413, 422, 429, 507, status=201))
async def create_document(request: Request, wanted: NewDocumentBody) -> JSONResponse:
    """Create a document; its address is in `Location`."""
    opened = await run_in_threadpool(_created, workspace_of(request), wanted)
    message = await run_in_threadpool(document_message, opened.id, opened.document.state)
    location = f"{request.scope.get('root_path', '')}/d/{opened.id}"
    return JSONResponse(message, status_code=201, headers={"location": location})


@router.get("/{document_id}", responses=answering(DocumentAnswer, 403, 404, 409, 422, 429))
async def read_document(request: Request, document_id: str) -> JSONResponse:
    """Return the drawing of a document, its solution and its problems."""
    opened = await _opened(request, document_id)
    return JSONResponse(await run_in_threadpool(document_message, document_id, opened.document.state))


@router.delete("/{document_id}", status_code=204, responses=problems(403, 404, 507))
async def remove_document(request: Request, document_id: str) -> Response:
    """Remove a document for good."""
    await run_in_threadpool(workspace_of(request).remove, document_id)
    return Response(status_code=204)


@router.put("/{document_id}/drawing", responses=_CHANGED)
async def put_drawing(request: Request, document_id: str, wanted: EditRequestBody) -> Response:
    """Change the drawing; answers 409, with the current `state`, if somebody else has changed it meanwhile."""
    return await _changed(request, document_id, wanted)


@router.put("/{document_id}/garment", responses=_CHANGED)
async def put_other_garment(request: Request, document_id: str, wanted: GarmentRequestBody) -> Response:
    """Put another garment in place of the one that is drawn, as one step."""
    return await _changed(request, document_id, wanted)


@router.put("/{document_id}/robot", responses=_CHANGED)
async def put_other_robot(request: Request, document_id: str, wanted: RobotRequestBody) -> Response:
    """Have another robot fold the garment, with the scene, start and placement that suit it, as one step."""
    return await _changed(request, document_id, wanted)


@router.post("/{document_id}/undo", responses=_CHANGED)
async def undo(request: Request, document_id: str, wanted: TravelRequestBody) -> Response:
    """Undo the last step; without one nothing happens."""
    return await _changed(request, document_id, Undo(do="undo", base_version=wanted.base_version))


@router.post("/{document_id}/redo", responses=_CHANGED)
async def redo(request: Request, document_id: str, wanted: TravelRequestBody) -> Response:
    """Redo the step undone last; without one nothing happens."""
    return await _changed(request, document_id, Redo(do="redo", base_version=wanted.base_version))


@router.post("/{document_id}/playback", responses=answering(PlaybackAnswer, 403, 404, 409, 413, 422, 429))
async def post_playback(request: Request, document_id: str, command: CommandBody) -> JSONResponse:
    """Carry out a command as on the websocket: play, pause, seek, speed, theme, choose."""
    opened = await _opened(request, document_id)
    if is_shared(request.scope):
        play(command, opened.visitors)
        return JSONResponse(playback_message(opened.visitors.state, opened.visitors.t_s))
    await run_in_threadpool(dispatch, command, workspace_of(request), opened.document)
    return JSONResponse(playback_message(opened.document.state, opened.document.t_s))


@router.post("/{document_id}/crease", responses=answering(CreaseAnswer, 403, 404, 409, 413, 422, 429, 503))
async def post_crease(request: Request, document_id: str, wanted: CreaseRequestBody) -> JSONResponse:
    """Return the fold that takes a point of the cloth to another place, or that runs along a line."""
    return await _answered(request, document_id, wanted)


@router.get("/{document_id}/steps", responses=answering(StepsAnswer, 403, 404, 409, 422, 429, 503))
async def read_steps(request: Request, document_id: str) -> JSONResponse:
    """Return the layers before each legal fold and after the last, bottom to top."""
    return await _answered(request, document_id, AskSteps(do="steps"))


@router.get("/{document_id}/versions", responses=answering(list[VersionAnswer], 403, 404, 422))
async def read_versions(request: Request, document_id: str) -> JSONResponse:
    """The drawings before the current one that the document can go back to, the latest first."""
    found = await run_in_threadpool(workspace_of(request).documents.versions, document_id)
    return JSONResponse([asdict(version) for version in found])


@router.get("/{document_id}/quick-fixes", responses=answering(QuickFixesAnswer, 403, 404, 409, 422, 429, 503))
async def read_quick_fixes(request: Request, document_id: str) -> JSONResponse:
    """Return the quick fixes of the drawing's first problem, best first; none if it has no problems."""
    return await _answered(request, document_id, AskQuickFixes(do="quick_fixes"))


@router.get("/{document_id}/overlays", tags=["overlays"], responses=answering(OverlaysAnswer, 404, 409, 422, 429, 503))
async def read_overlays(
    request: Request,
    document_id: str,
    t_s: Time = None,
    station: str | None = None,
    back_off_m: BackOff = 0.0,
    show: Shown = None,
) -> Response:
    """Return reach, slip limits, the base's way and the paths of the hands at a time of the plan or at a station.

    By default they are those at the document's own time; without a plan, at the station where the robot starts.
    """
    wanted = AskOverlays(do="overlays", t_s=t_s, station=station, back_off_m=back_off_m, show=show)
    return await _answered(request, document_id, wanted)


@router.post(
    "/{document_id}/overlays/places", tags=["overlays"], responses=answering(PlacesAnswer, 404, 409, 413, 422, 429, 503)
)
async def post_places(request: Request, document_id: str, wanted: PlacesRequestBody) -> Response:
    """Plan the document's garment wherever it could be laid, not turned, and return the costs."""
    return await _answered(request, document_id, wanted)


@router.post("/{document_id}/share", status_code=201, responses=answering(ShareAnswer, 403, 404, 507, status=201))
async def share_document(request: Request, document_id: str) -> JSONResponse:
    """Make a link with which others may look at the document and play its plan, but change nothing.

    They need no token of the server. The link is shown this once.
    """
    token = await run_in_threadpool(workspace_of(request).shares.add, document_id)
    return JSONResponse({"path": f"{request.scope.get('root_path', '')}/s/{token}/d/{document_id}"}, 201)


@router.delete("/{document_id}/share", status_code=204, responses=problems(403, 404, 507))
async def revoke_shares(request: Request, document_id: str) -> Response:
    """Take back all links to the document; pages that were opened with them are cut off within seconds."""
    await run_in_threadpool(workspace_of(request).shares.revoke, document_id)
    return Response(status_code=204)


async def _opened(request: Request, document_id: str) -> OpenDocument:
    """Return an open document; open it if necessary."""
    return await run_in_threadpool(workspace_of(request).opened, document_id)


async def _changed(request: Request, document_id: str, wanted: Wanted) -> Response:
    """Return the state that a change leads to, or the current state if the change came too late.

    All of it is one piece of work in one thread: between two, it would wait for the interpreter.
    """
    workspace = workspace_of(request)

    def work() -> Response:
        opened = workspace.opened(document_id)
        try:
            state = dispatch(wanted, workspace, opened.document)
        except StaleVersionError as error:
            current = document_message(opened.id, opened.document.state)
            return ProblemResponse(409, str(error), members={"state": current})
        return Response(document_text(opened, state), media_type="application/json")

    return await run_in_threadpool(work)


async def _answered(request: Request, document_id: str, asked: Asked) -> JSONResponse:
    """Return the answer to a question about a document, which stays open meanwhile."""
    opened = await _opened(request, document_id)
    with opened.in_use():
        return JSONResponse(await answer_of(request, *work_of(asked, workspace_of(request), opened)))


def _place(after: str | None) -> tuple[str, str] | None:
    """Return the position in the list that a query names."""
    if after is None:
        return None
    changed_at, _, document_id = after.rpartition("/")
    return changed_at, document_id


def _created(workspace: Workspace, wanted: NewDocument) -> OpenDocument:
    return workspace.create(_first_drawing(workspace, wanted))


def _first_drawing(workspace: Workspace, wanted: NewDocument) -> Drawing:
    if wanted.garment is not None and wanted.copy_of is not None:
        raise RequestError("copy_of", "a new document is either of a garment or a copy")
    if wanted.copy_of is not None:
        return workspace.opened(wanted.copy_of).document.state.drawing
    if wanted.garment is None:
        return blank_drawing()
    drawing = drawing_of(requested_garment(workspace, wanted.garment))
    return with_arcs(drawing) if wanted.arcs else drawing
