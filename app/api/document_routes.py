"""Routes of documents: the list, each one with its history and playback, and new folds."""

from dataclasses import asdict
from typing import Annotated, Any
from urllib.parse import urlencode

from fastapi import APIRouter, Depends, Query, Request, Response
from fastapi.concurrency import run_in_threadpool
from starlette.responses import JSONResponse

from app.api.body import JsonBody
from app.api.commands import dispatch
from app.api.described import DescribedRoute, problems
from app.api.disconnect import quick_answer
from app.api.document_answers import (
    CreaseAnswer,
    DocumentAnswer,
    DocumentEntryAnswer,
    PlaybackAnswer,
    QuickFixesAnswer,
    StepsAnswer,
    VersionAnswer,
)
from app.api.document_changes import opened_document
from app.api.document_messages import CreaseRequest, NewDocument
from app.api.live_messages import document_message, playback_message
from app.api.messages import AnyCommand, Command
from app.api.request_parsing import requested_garment, workspace_of
from app.api.shared import is_shared, play
from app.drawing.arcs import with_arcs
from app.drawing.blank import blank_drawing
from app.drawing.drawing import Drawing
from app.drawing.garment_drawing import drawing_of
from app.drawing.place_crease import PlacedCrease, along_line, grab_and_drop
from app.drawing.quick_fixes import quick_fixes
from app.open_document import OpenDocument
from app.workspace import Workspace
from planner.errors import RequestError
from planner.geometry.segment import Segment

router = APIRouter(prefix="/api/documents", tags=["documents"], route_class=DescribedRoute)

CreaseRequestBody = Annotated[
    CreaseRequest, Depends(JsonBody(CreaseRequest, {"after": 0, "line": {"start": [0.0, 0.2], "end": [0.4, 0.2]}}))
]
CommandBody = Annotated[Command, Depends(JsonBody(AnyCommand, {"do": "pause"}))]
NewDocumentBody = Annotated[NewDocument, Depends(JsonBody(NewDocument, {"garment": "hand-towel"}))]

PAGE, PAGE_MAX = 100, 500
"""Documents on a page of the list: by default, and at most."""

Limit = Annotated[int, Query(ge=1, le=PAGE_MAX, description="documents on the page")]
After = Annotated[str, Query(max_length=100, description="where the page before ended, as its `Link` has it")]


@router.get("", response_model=list[DocumentEntryAnswer], responses=problems(422))
async def list_documents(
    request: Request, response: Response, limit: Limit = PAGE, after: After | None = None
) -> list[dict[str, Any]]:
    """Return the documents, the latest changed first; those whose file cannot be read come last.

    If there are more than `limit`, the header `Link` leads to the next ones: `<?limit=...&after=...>; rel="next"`.
    """
    documents = workspace_of(request).documents
    page = await run_in_threadpool(documents.page, _place(after), limit)
    if page.end is not None:
        query = urlencode({"limit": limit, "after": "/".join(page.end)})
        response.headers["link"] = f'<?{query}>; rel="next"'
    return [asdict(entry) for entry in page.entries]


@router.post(
    "",
    status_code=201,
    responses={201: {"model": DocumentAnswer}, **problems(403, 404, 413, 422, 429, 507)},
)
async def create_document(request: Request, wanted: NewDocumentBody) -> JSONResponse:
    """Create a document; its address is in `Location`."""
    opened = await run_in_threadpool(_created, workspace_of(request), wanted)
    message = await run_in_threadpool(document_message, opened.id, opened.document.state)
    location = f"{request.scope.get('root_path', '')}/d/{opened.id}"
    return JSONResponse(message, status_code=201, headers={"location": location})


@router.get("/{document_id}", responses={200: {"model": DocumentAnswer}, **problems(403, 404, 409, 422, 429)})
async def read_document(request: Request, document_id: str) -> JSONResponse:
    """Return the drawing of a document, its solution and its problems."""
    opened = await opened_document(request, document_id)
    return JSONResponse(await run_in_threadpool(document_message, document_id, opened.document.state))


@router.delete("/{document_id}", status_code=204, responses=problems(403, 404, 507))
async def remove_document(request: Request, document_id: str) -> Response:
    """Remove a document for good."""
    await run_in_threadpool(workspace_of(request).remove, document_id)
    return Response(status_code=204)


@router.post(
    "/{document_id}/playback",
    responses={200: {"model": PlaybackAnswer}, **problems(403, 404, 409, 413, 422, 429)},
)
async def post_playback(request: Request, document_id: str, command: CommandBody) -> JSONResponse:
    """Carry out a command as on the websocket: play, pause, seek, speed, theme, choose."""
    opened = await opened_document(request, document_id)
    if is_shared(request.scope):
        play(command, opened.visitors)
        return JSONResponse(playback_message(opened.visitors.state, opened.visitors.t_s))
    await run_in_threadpool(dispatch, command, workspace_of(request), opened.document)
    return JSONResponse(playback_message(opened.document.state, opened.document.t_s))


@router.post(
    "/{document_id}/crease",
    responses={200: {"model": CreaseAnswer}, **problems(403, 404, 409, 413, 422, 429, 503)},
)
async def post_crease(request: Request, document_id: str, wanted: CreaseRequestBody) -> JSONResponse:
    """Return the fold that takes a point of the cloth to another place, or that runs along a line."""
    opened = await opened_document(request, document_id)
    placed = await quick_answer(request, _placed, opened, wanted)
    return JSONResponse(placed.to_dict())


@router.get("/{document_id}/steps", responses={200: {"model": StepsAnswer}, **problems(403, 404, 409, 422, 429, 503)})
async def read_steps(request: Request, document_id: str) -> JSONResponse:
    """Return the layers before each legal fold and after the last, bottom to top."""
    opened = await opened_document(request, document_id)
    state = opened.document.state
    return JSONResponse({"version": state.version, "steps": await quick_answer(request, state.solution.layers)})


@router.get("/{document_id}/versions", responses={200: {"model": list[VersionAnswer]}, **problems(403, 404, 422)})
async def read_versions(request: Request, document_id: str) -> JSONResponse:
    """The drawings before the current one that the document can go back to, the latest first."""
    found = await run_in_threadpool(workspace_of(request).documents.versions, document_id)
    return JSONResponse([asdict(version) for version in found])


@router.get(
    "/{document_id}/quick-fixes", responses={200: {"model": QuickFixesAnswer}, **problems(403, 404, 409, 422, 429, 503)}
)
async def read_quick_fixes(request: Request, document_id: str) -> JSONResponse:
    """Return the quick fixes of the drawing's first problem, best first; none if it has no problems."""
    opened = await opened_document(request, document_id)
    state = opened.document.state
    found = await quick_answer(request, quick_fixes, state.draft)
    return JSONResponse({"version": state.version, "quick_fixes": [quick_fix.to_dict() for quick_fix in found]})


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


def _placed(opened: OpenDocument, wanted: CreaseRequest) -> PlacedCrease:
    solution = opened.document.state.solution
    if (wanted.grab is None) == (wanted.line is None):
        raise RequestError("grab", "a fold is asked for by either grab or line")
    if wanted.grab is not None:
        (px, py), (qx, qy) = wanted.grab.start, wanted.grab.to
        return grab_and_drop(solution, wanted.after, (px, py), (qx, qy), wanted.kind)
    assert wanted.line is not None
    (ax, ay), (bx, by) = wanted.line.start, wanted.line.end
    if (ax, ay) == (bx, by):
        raise RequestError("line.end", "is the line's start")
    return along_line(solution, wanted.after, Segment((ax, ay), (bx, by)), wanted.kind)
