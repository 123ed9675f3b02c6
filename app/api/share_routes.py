"""Routes of links with which others may look at a document."""

from fastapi import APIRouter, Request, Response
from fastapi.concurrency import run_in_threadpool
from pydantic import BaseModel
from starlette.responses import JSONResponse

from app.api.described import DescribedRoute, problems
from app.api.request_parsing import workspace_of

router = APIRouter(prefix="/api/documents", tags=["documents"], route_class=DescribedRoute)


class ShareAnswer(BaseModel):
    """A new link: the path of the page that it leads to."""

    path: str


@router.post(
    "/{document_id}/share", status_code=201, responses={201: {"model": ShareAnswer}, **problems(403, 404, 507)}
)
async def share_document(request: Request, document_id: str) -> JSONResponse:
    """Make a link with which others may look at the document and play its plan, but change nothing.

    They need no token of the server. The link is told this once.
    """
    token = await run_in_threadpool(workspace_of(request).shares.add, document_id)
    return JSONResponse({"path": f"{request.scope.get('root_path', '')}/s/{token}/d/{document_id}"}, 201)


@router.delete("/{document_id}/share", status_code=204, responses=problems(403, 404, 507))
async def revoke_shares(request: Request, document_id: str) -> Response:
    """Take back all links to the document; pages that were opened with them are cut off within seconds."""
    await run_in_threadpool(workspace_of(request).shares.revoke, document_id)
    return Response(status_code=204)
