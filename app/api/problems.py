"""Errors as `application/problem+json` (RFC 9457): title, status, sentence, fields; never a trace."""

import http
import json
import logging
from collections.abc import Awaitable, Callable, Iterator, Mapping, Sequence
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import Response
from starlette.routing import BaseRoute, Match, Mount, Router
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.answers import Says
from app.document import EndedDocumentError
from app.drawing.edit import StaleVersionError
from app.jobs.job_desk import ForeignJobError
from app.jobs.job_pool import BusyError
from app.jobs.limits import TooManyError
from app.overlays.moment import NoClothError
from app.store.database import OtherDatabaseError
from app.store.document_errors import BrokenDocumentError, NewerDocumentError, UnknownDocumentError
from app.store.job_repository import UnknownJobError
from app.store.plan_store import UnknownPlanError
from app.store.storage_error import ForbiddenStorageError, FullStorageError, StorageError, storage_error
from app.store.study_store import UnknownStudyError
from app.store.trace_store import UnknownTraceError
from app.worker.stop import StoppedError
from app.worker.template import PlannerNotLoadedError
from planner.errors import (
    FieldError,
    FoldingError,
    GarmentFileError,
    ReadOnlyGarmentError,
    ReadOnlyRobotError,
    UnknownGarmentError,
    UnknownRobotError,
    UnsolvedPlanError,
)
from planner.strict_model import field_path, plain_message

_log = logging.getLogger(__name__)

MEDIA_TYPE = "application/problem+json"

FAILED = "The server failed on this request; its log says why."

CLIENT_GONE = 499
"""Status in the log, as of other servers, for a client that has gone away: nobody reads the answer."""


class LookOnlyError(FoldingError):
    """A visitor by a link to a document has asked for a change."""

    def __str__(self) -> str:
        return "this link is for looking and playing only"


class TooLargeError(FoldingError):
    """A request body is beyond the limit."""


class ClientGoneError(FoldingError):
    """The client has closed the connection."""

    def __str__(self) -> str:
        return "The client went away."


_STATUS_OF: dict[type[FoldingError], int] = {
    UnknownGarmentError: 404,
    UnknownRobotError: 404,
    UnknownPlanError: 404,
    UnknownTraceError: 404,
    UnknownDocumentError: 404,
    EndedDocumentError: 404,
    UnknownJobError: 404,
    ForeignJobError: 409,
    UnknownStudyError: 404,
    BrokenDocumentError: 422,
    NewerDocumentError: 409,
    OtherDatabaseError: 409,
    ForbiddenStorageError: 403,
    LookOnlyError: 403,
    ClientGoneError: CLIENT_GONE,
    FullStorageError: 507,
    StorageError: 500,
    ReadOnlyGarmentError: 409,
    ReadOnlyRobotError: 409,
    UnsolvedPlanError: 409,
    StaleVersionError: 409,
    NoClothError: 409,
    StoppedError: 503,
    PlannerNotLoadedError: 503,
    GarmentFileError: 422,
}
_METHODS = ("GET", "POST", "PUT", "PATCH", "DELETE")
_REQUEST_PARTS = ("body", "query", "path", "header")


class FieldProblem(BaseModel):
    """A field of the input and its error; `says` has the numbers of the message, by name."""

    field: str
    message: str
    says: Says | None = None


class Problem(BaseModel):
    """An error (RFC 9457)."""

    title: str
    status: int
    detail: str
    errors: list[FieldProblem] | None = None


class ProblemResponse(Response):
    """The response that carries a problem.

    Attributes:
        problem: the problem as JSON.
    """

    media_type = MEDIA_TYPE

    def __init__(
        self,
        status: int,
        detail: str,
        errors: Sequence[Mapping[str, Any]] = (),
        headers: dict[str, str] | None = None,
        members: Mapping[str, Any] | None = None,
    ) -> None:
        """Make the title from the status; `errors` is left out if empty; `members` are further fields."""
        self.problem: dict[str, Any] = {"title": _title(status), "status": status, "detail": detail}
        if errors:
            self.problem["errors"] = list(errors)
        self.problem.update(members or {})
        super().__init__(json.dumps(self.problem).encode("ascii"), status, headers)


class FailuresAsProblems:
    """Middleware that answers unexpected errors of the routes as problems, and logs each once.

    FastAPI's own handler raises the error again after it has answered, so the server would log it a second time.
    """

    def __init__(self, app: ASGIApp) -> None:
        """Wrap the routes."""
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Call the routes; if they fail after the answer has begun, break it off."""
        has_begun = False

        async def send_noted(message: Message) -> None:
            nonlocal has_begun
            has_begun = has_begun or message["type"] == "http.response.start"
            await send(message)

        try:
            await self._app(scope, receive, send_noted)
        except Exception:
            if scope["type"] != "http" or has_begun:
                raise
            _log.exception("%s %s failed", scope["method"], scope["path"])
            await ProblemResponse(500, FAILED)(scope, receive, send)


def install_problems(app: FastAPI) -> None:
    """Answer every exception with a problem."""
    handlers: dict[type[Exception], Callable[[Request, Any], Awaitable[Response]]] = {
        HTTPException: _http_problem,
        RequestValidationError: _validation_problem,
        ClientDisconnect: _problem,
        FoldingError: _problem,
        OSError: _problem,
    }
    for kind, handler in handlers.items():
        app.add_exception_handler(kind, handler)


async def _http_problem(request: Request, error: HTTPException) -> Response:
    answer = ProblemResponse(error.status_code, _http_detail(request, error), headers=dict(error.headers or {}))
    if error.status_code == http.HTTPStatus.METHOD_NOT_ALLOWED:
        answer.headers["allow"] = _allowed_methods(request)
    return answer


async def _validation_problem(_: Request, error: RequestValidationError) -> Response:
    fields = [_described(detail) for detail in error.errors()]
    return ProblemResponse(422, _summary(fields), fields)


async def _problem(_: Request, error: Exception) -> Response:
    """Answer an error; raise a bug again."""
    answer = problem_of(error)
    if answer is None:
        raise error
    return answer


def problem_of(error: Exception) -> ProblemResponse | None:
    """Return the answer that reports an error; None for a bug.

    A refusal of the operating system is logged; an `OSError` of a library's own making is a bug.
    """
    match error:
        case FoldingError():
            return folding_problem(error)
        case ClientDisconnect():
            return folding_problem(ClientGoneError())
        case OSError() if error.errno is not None:
            what = "the request could not be answered"
            _log.error(what, exc_info=error)
            return folding_problem(storage_error(what, error))
    return None


def folding_problem(error: FoldingError) -> ProblemResponse:
    """Return the answer to what has raised an error of Pleat's own, by its class."""
    match error:
        case FieldError():
            field: dict[str, Any] = {"field": error.field, "message": error.message}
            if error.says is not None:
                field["says"] = error.says.to_dict()
            return ProblemResponse(422, _summary([field]), [field])
        case TooLargeError():
            return ProblemResponse(413, str(error), headers={"connection": "close"})
        case BusyError(retry_after_s=wait_s):
            return ProblemResponse(503, str(error), headers={"retry-after": str(wait_s)})
        case TooManyError(retry_after_s=wait_s):
            return ProblemResponse(429, str(error), headers={"retry-after": str(wait_s)})
    status = next((code for kind, code in _STATUS_OF.items() if isinstance(error, kind)), 422)
    return ProblemResponse(status, str(error))


def _title(status: int) -> str:
    try:
        return http.HTTPStatus(status).phrase
    except ValueError:
        return "Error"


def _http_detail(request: Request, error: HTTPException) -> str:
    if error.status_code == http.HTTPStatus.NOT_FOUND:
        return f"There is nothing at {request.url.path[:200]}."
    if error.status_code == http.HTTPStatus.METHOD_NOT_ALLOWED:
        return f"{request.method} is not possible at {request.url.path[:200]}."
    return str(error.detail)


def _described(detail: Any) -> dict[str, str]:  # noqa: ANN401
    location = tuple(detail["loc"])
    inner = location[1:] if location and location[0] in _REQUEST_PARTS else location
    return {"field": field_path(inner), "message": plain_message(dict(detail))}


def _summary(fields: Sequence[Mapping[str, Any]]) -> str:
    first = fields[0]
    text = f"{first['field']}: {first['message']}" if first["field"] else first["message"]
    return text if len(fields) == 1 else f"{text} (and {len(fields) - 1} more)"


def _allowed_methods(request: Request) -> str:
    """Return the value of `Allow` for the path of a request: the methods of the routes that lead there.

    Where a route has this very path, those that have a parameter in it do not count: `/api/jobs/studies` is no job.
    """
    found = {method: parameters for method in _METHODS if (parameters := _parameters(request, method)) is not None}
    allowed = [method for method, parameters in found.items() if parameters == min(found.values())]
    return ", ".join(["GET", "HEAD", *allowed[1:]] if "GET" in allowed else allowed)


def _parameters(request: Request, method: str) -> int | None:
    """Return how many parameters the path has for a route of this method; None if there is no such route.

    Folders of files are only read.
    """
    root_path = request.scope.get("app_root_path", request.scope.get("root_path", ""))  # set by mounted folders
    scope = {**request.scope, "method": method, "root_path": root_path, "path_params": {}}
    routes = [route for route in _routes(request.app.router) if method == "GET" or not isinstance(route, Mount)]
    matches = [values for route in routes for match, values in [route.matches(scope)] if match is Match.FULL]
    return min((len(values.get("path_params", ())) for values in matches), default=None)


def _routes(router: Router) -> Iterator[BaseRoute]:
    """Yield the routes of a router and of the routers in it: an included one does not tell the parameters."""
    for route in router.routes:
        inner = getattr(route, "original_router", None)
        if inner is None:
            yield route
        else:
            yield from _routes(inner)
