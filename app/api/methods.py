"""HTTP methods: `HEAD` wherever there is `GET`, and the methods that a path allows."""

from fastapi import Request
from starlette.routing import Match, Mount
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
    """Return the value of `Allow` for the path of a request: the methods of all routes that lead there."""
    allowed = [method for method in _METHODS if _is_allowed(request, method)]
    return ", ".join(["GET", "HEAD", *allowed[1:]] if "GET" in allowed else allowed)


def _is_allowed(request: Request, method: str) -> bool:
    """Return whether a route allows this method; folders of files are only read."""
    root_path = request.scope.get("app_root_path", request.scope.get("root_path", ""))  # set by mounted folders
    scope = {**request.scope, "method": method, "root_path": root_path}
    matching = [route for route in request.app.router.routes if route.matches(scope)[0] is Match.FULL]
    return any(method == "GET" or not isinstance(route, Mount) for route in matching)
