"""HTTP methods: `HEAD` wherever there is `GET`, and the methods that a path allows."""

from collections.abc import Iterator

from fastapi import Request
from starlette.routing import BaseRoute, Match, Mount, Router
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_METHODS = ("GET", "POST", "PUT", "PATCH", "DELETE")


class HeadAsGet:
    """Middleware that answers `HEAD` as `GET`, without the body."""

    def __init__(self, app: ASGIApp) -> None:
        """Wrap the routes."""
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Call the routes, and drop the body of an answer to `HEAD`."""
        if scope["type"] != "http" or scope["method"] != "HEAD":
            await self._app(scope, receive, send)
            return

        async def send_head(message: Message) -> None:
            await send({**message, "body": b""} if message["type"] == "http.response.body" else message)

        await self._app({**scope, "method": "GET"}, receive, send_head)


def allowed_methods(request: Request) -> str:
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
    matches = [told for route in routes for match, told in [route.matches(scope)] if match is Match.FULL]
    return min((len(told.get("path_params", ())) for told in matches), default=None)


def _routes(router: Router) -> Iterator[BaseRoute]:
    """Yield the routes of a router and of the routers in it: an included one does not tell the parameters."""
    for route in router.routes:
        inner = getattr(route, "original_router", None)
        if inner is None:
            yield route
        else:
            yield from _routes(inner)
