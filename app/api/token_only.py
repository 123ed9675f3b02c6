"""Refusal of requests without the server's token.

Programs send it as `Authorization: Bearer TOKEN`. A person opens a page with `?token=TOKEN` once: the answer leads to
the same page without it, and gives the browser a cookie that no script can read and no other site can use.
"""

from urllib.parse import parse_qsl, urlencode

from starlette.datastructures import Headers
from starlette.requests import cookie_parser
from starlette.responses import RedirectResponse, Response
from starlette.types import ASGIApp, Receive, Scope, Send

from app.api.problems import ProblemResponse
from app.api.shared import is_shared
from app.store.access_token import AccessToken

UNAUTHORIZED = 401
PARAMETER = "token"
_KEPT_S = 30 * 24 * 3600
"""Time for which a browser keeps the cookie (s)."""

_SEE_OTHER = 303
_POLICY_VIOLATION = 1008
_WEBSOCKET_ANSWERS = "websocket.http.response"
_DETAIL = "This server asks for its token: `Authorization: Bearer TOKEN`, or open `/?token=TOKEN` once in a browser."


class TokenOnly:
    """Middleware that admits only requests with the token, for HTTP and websockets alike."""

    def __init__(self, app: ASGIApp, token: AccessToken, port: int) -> None:
        """Ask for this token; browsers send cookies to all ports of a host, so the cookie is named for the port."""
        self._app = app
        self._token = token
        self._cookie = f"pleat-{port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, as those by a link, exchange the token of a page's address for a cookie, or refuse."""
        if scope["type"] == "lifespan" or is_shared(scope) or self._is_known(Headers(scope=scope)):
            await self._app(scope, receive, send)
            return
        await self._answer(scope)(scope, receive, send)

    def _is_known(self, headers: Headers) -> bool:
        kind, _, given = headers.get("authorization", "").partition(" ")
        if kind.lower() == "bearer" and self._token.matches(given.strip()):
            return True
        return any(self._token.matches(value) for value in self._cookies(headers))

    def _cookies(self, headers: Headers) -> list[str]:
        found = (cookie_parser(line) for line in headers.getlist("cookie"))
        return [cookies[self._cookie] for cookies in found if self._cookie in cookies]

    def _answer(self, scope: Scope) -> ASGIApp:
        if scope["type"] == "websocket" and _WEBSOCKET_ANSWERS not in scope.get("extensions", {}):
            return _close
        if scope["type"] == "http" and scope["method"] in ("GET", "HEAD"):
            query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
            given = [value for name, value in query if name == PARAMETER]
            if len(given) == 1 and self._token.matches(given[0]):
                return self._welcome(scope, given[0], [pair for pair in query if pair[0] != PARAMETER])
        headers = {"www-authenticate": 'Bearer realm="Pleat"', "cache-control": "no-store"}
        return ProblemResponse(UNAUTHORIZED, _DETAIL, headers=headers)

    def _welcome(self, scope: Scope, token: str, others: list[tuple[str, str]]) -> Response:
        """Return the way to the same page without the token, and the cookie."""
        path = f"/{scope['path'].lstrip('/')}"  # two slashes at the start would lead to another host
        leads_to = f"{path}?{urlencode(others)}" if others else path
        answer = RedirectResponse(leads_to, _SEE_OTHER, headers={"cache-control": "no-store"})
        answer.set_cookie(
            self._cookie,
            token,
            max_age=_KEPT_S,
            path=scope.get("root_path", "") or "/",
            secure=_is_https(scope),
            httponly=True,
            samesite="strict",
        )
        return answer


def _is_https(scope: Scope) -> bool:
    """Return whether the proxy says that the browser uses HTTPS."""
    return scope["scheme"] == "https" or Headers(scope=scope).get("x-forwarded-proto", "").lower() == "https"


async def _close(_: Scope, __: Receive, send: Send) -> None:
    await send({"type": "websocket.close", "code": _POLICY_VIOLATION})
