"""Routes of the page, `/d/{document}`, and its files; `/` redirects to the document opened last."""

from collections.abc import Callable
from hashlib import sha256
from html import escape
from http import HTTPStatus

from fastapi import APIRouter, FastAPI, Request
from fastapi.concurrency import run_in_threadpool
from starlette.responses import FileResponse, HTMLResponse, RedirectResponse, Response
from starlette.staticfiles import NotModifiedResponse, StaticFiles

from app.api.asker import workspace_of
from app.api.shared import is_shared
from app.files.exports import find_export
from app.page_files import scripts, static_dir, styles
from app.workspace import Workspace
from planner.errors import FoldingError

router = APIRouter(include_in_schema=False)

_FRESH = {"cache-control": "no-cache"}
_HEAD_END = "  </head>"
_PICTURE = find_export("picture.png")


@router.get("/")
async def read_first_page(request: Request) -> Response:
    """Redirect to the document opened last, or to a new one."""
    document_id = await run_in_threadpool(workspace_of(request).first)
    return RedirectResponse(f"{request.scope.get('root_path', '')}/d/{document_id}", headers=_FRESH)


@router.get("/d/{document_id}")
async def read_page(request: Request, document_id: str) -> Response:
    """Return the designer on a document; the page itself reports a missing one.

    Where it is shared, it says what a preview of the link shows.
    """
    status = await run_in_threadpool(_remembered, workspace_of(request), document_id)
    if status == HTTPStatus.OK and is_shared(request.scope):
        return HTMLResponse(await run_in_threadpool(_with_preview, request, document_id), headers=_FRESH)
    return FileResponse(static_dir() / "index.html", status_code=status, headers=_FRESH)


@router.get("/static/page.js")
async def read_scripts(request: Request) -> Response:
    """Return all of the page's modules."""
    return await _joined(request, scripts, "text/javascript")


@router.get("/static/page.css")
async def read_styles(request: Request) -> Response:
    """Return all of the page's style sheets."""
    return await _joined(request, styles, "text/css")


async def _joined(request: Request, put_together: Callable[[], str], media_type: str) -> Response:
    """Return a text that changes with the files it is made of, or that the browser has it already."""
    response = Response(await run_in_threadpool(put_together), media_type=media_type)
    response.headers.update({"etag": f'"{sha256(response.body).hexdigest()}"'} | _FRESH)
    if response.headers["etag"] in request.headers.get("if-none-match", ""):
        return NotModifiedResponse(response.headers)
    return response


def _remembered(workspace: Workspace, document_id: str) -> int:
    """Remember the document as the one opened last, and return the page's status."""
    try:
        workspace.opened(document_id)
    except FoldingError:
        return HTTPStatus.NOT_FOUND
    workspace.documents.remember_last(document_id)
    return HTTPStatus.OK


def _with_preview(request: Request, document_id: str) -> str:
    """Return the page with the document's title, and where its picture is if there is a plan."""
    state = workspace_of(request).opened(document_id).document.state
    title = f"{state.drawing.title or state.drawing.name} - Pleat"
    properties = {"og:type": "website", "og:title": title}
    if _PICTURE is not None and _PICTURE.reason(state) is None:
        properties["og:image"] = (
            f"{str(request.base_url).rstrip('/')}/api/documents/{document_id}/files/{_PICTURE.what}"
        )
        properties["twitter:card"] = "summary_large_image"
    lines = [f'    <meta property="{name}" content="{escape(content)}">\n' for name, content in properties.items()]
    page = (static_dir() / "index.html").read_text(encoding="utf-8")
    return page.replace(_HEAD_END, "".join(lines) + _HEAD_END, 1)


class FreshFiles(StaticFiles):
    """Static files that a browser revalidates each time, so that an update never mixes old and new files."""

    def file_response(self, *args: object, **kwargs: object) -> Response:
        """Return the usual answer, with the instruction not to reuse it unasked."""
        response: Response = super().file_response(*args, **kwargs)  # type: ignore[arg-type]
        response.headers.update(_FRESH)
        return response


def mount_files(app: FastAPI) -> None:
    """Serve the page's scripts and styles at `/static`."""
    app.mount("/static", FreshFiles(directory=static_dir()), name="static")
