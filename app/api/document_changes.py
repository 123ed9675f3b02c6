"""Routes that change a document: its drawing, garment or robot, and its history."""

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Request, Response
from fastapi.concurrency import run_in_threadpool

from app.api.body import JsonBody
from app.api.commands import put_garment, put_robot
from app.api.described import DescribedRoute, problems
from app.api.document_answers import DocumentAnswer
from app.api.document_messages import EditRequest, GarmentRequest, RobotRequest, TravelRequest
from app.api.live_messages import document_message
from app.api.problems import ProblemResponse
from app.api.request_parsing import requested_garment, workspace_of
from app.api.serialization import document_text
from app.document import Document
from app.document_state import DocumentState
from app.drawing.drawing import Drawing
from app.drawing.drawing_json import drawing_from_dict
from app.drawing.edit import Edit, Phase, StaleVersionError
from app.open_document import OpenDocument
from planner.errors import FieldError, RequestError
from planner.robots.known_robots import require_name

router = APIRouter(prefix="/api/documents", tags=["documents"], route_class=DescribedRoute)

EditRequestBody = Annotated[EditRequest, Depends(JsonBody(EditRequest, {"base_version": 1, "phase": "cancel"}))]
GarmentRequestBody = Annotated[GarmentRequest, Depends(JsonBody(GarmentRequest, {"garment": "tie"}))]
TravelRequestBody = Annotated[TravelRequest, Depends(JsonBody(TravelRequest, {"base_version": 1}, may_be_empty=True))]
RobotRequestBody = Annotated[RobotRequest, Depends(JsonBody(RobotRequest, {"robot": "ur5e-pair"}))]

_CHANGED: dict[int | str, dict[str, Any]] = {
    200: {"model": DocumentAnswer},
    **problems(403, 404, 409, 413, 422, 429, 507),
}


@router.put("/{document_id}/drawing", responses=_CHANGED)
async def put_drawing(request: Request, document_id: str, wanted: EditRequestBody) -> Response:
    """Change the drawing; answers 409, with the current `state`, if somebody else has changed it meanwhile."""

    def change(document: Document) -> DocumentState:
        return document.edit(_edit(wanted, document.state.drawing))

    return await _changed(request, document_id, change)


@router.put("/{document_id}/garment", responses=_CHANGED)
async def put_other_garment(request: Request, document_id: str, wanted: GarmentRequestBody) -> Response:
    """Put another garment in place of the one that is drawn, as one step."""

    def change(document: Document) -> DocumentState:
        garment = requested_garment(workspace_of(request), wanted.garment)
        return put_garment(document, garment, wanted.label, wanted.base_version, has_arcs=wanted.arcs)

    return await _changed(request, document_id, change)


@router.put("/{document_id}/robot", responses=_CHANGED)
async def put_other_robot(request: Request, document_id: str, wanted: RobotRequestBody) -> Response:
    """Have another robot fold the garment, with the scene, start and placement that suit it, as one step."""

    def change(document: Document) -> DocumentState:
        return put_robot(document, wanted.robot, wanted.label, wanted.base_version)

    return await _changed(request, document_id, change)


@router.post("/{document_id}/undo", responses=_CHANGED)
async def undo(request: Request, document_id: str, wanted: TravelRequestBody) -> Response:
    """Undo the last step; without one nothing happens."""
    return await _changed(request, document_id, lambda document: document.undo(wanted.base_version))


@router.post("/{document_id}/redo", responses=_CHANGED)
async def redo(request: Request, document_id: str, wanted: TravelRequestBody) -> Response:
    """Redo the step undone last; without one nothing happens."""
    return await _changed(request, document_id, lambda document: document.redo(wanted.base_version))


async def opened_document(request: Request, document_id: str) -> OpenDocument:
    """Return an open document; open it if necessary."""
    return await run_in_threadpool(workspace_of(request).opened, document_id)


async def _changed(request: Request, document_id: str, change: Callable[[Document], DocumentState]) -> Response:
    """Return the state that a change leads to, or the current state if the change came too late.

    All of it is one piece of work in one thread: between two, it would wait for the interpreter.
    """
    workspace = workspace_of(request)

    def work() -> Response:
        opened = workspace.opened(document_id)
        try:
            state = change(opened.document)
        except StaleVersionError as error:
            current = document_message(opened.id, opened.document.state)
            return ProblemResponse(409, str(error), members={"state": current})
        return Response(document_text(opened, state), media_type="application/json")

    return await run_in_threadpool(work)


def _edit(wanted: EditRequest, now: Drawing) -> Edit:
    phase = Phase(wanted.phase)
    if wanted.drawing is None and phase is not Phase.CANCEL:
        raise RequestError("drawing", "is missing")
    try:
        drawing = None if wanted.drawing is None else drawing_from_dict(wanted.drawing)
        if drawing is not None and drawing.robot != now.robot:
            require_name(drawing.robot)
    except FieldError as error:
        raise error.within("drawing") from None
    return Edit(wanted.label, drawing, phase, wanted.base_version, wanted.coalesce, wanted.gesture)
