"""Serves the designer on one address until interrupted."""

import ipaddress
import signal
import socket
import sys
from collections.abc import Callable
from types import FrameType
from typing import Any, NoReturn, TypeAlias

import uvicorn
from starlette.applications import Starlette

from app.api.create_app import create_app
from app.server.arenas import use_few_arenas
from app.server.log import logging_to, standard_error
from app.server.protocols import TimedProtocol, WebSocketProtocol
from app.settings import Settings
from app.store.access_token import AccessToken, file_token, kept_token
from app.store.data_folder import DataFolder
from app.worker.template import start_template

_LARGEST_MESSAGE = 4 << 20
"""Largest websocket message (bytes)."""

_GRACE_S = 1
"""Time for open requests to end at shutdown (s)."""

_SWITCH_S = 0.0001
"""Time for which a thread keeps the interpreter (s).

A request changes threads several times and waits that long each time for one that works, as at an export; Python's
default of 5 ms would be noticeable.
"""


_Address: TypeAlias = tuple[socket.AddressFamily, tuple[Any, ...]]


class _Server(uvicorn.Server):
    """A server that announces when it listens, and stops jobs before it waits for open requests."""

    def __init__(self, config: uvicorn.Config, announce: Callable[[], None], stop_work: Callable[[], None]) -> None:
        super().__init__(config)
        self._announce = announce
        self._stop_work = stop_work

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started:
            self._announce()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        self._stop_work()
        await super().shutdown(sockets)


def serve(settings: Settings, announce: Callable[[str, str | None], None]) -> None:
    """Serve until interrupted; SIGTERM ends the process with status 0, once everything is closed.

    Args:
        settings: the settings.
        announce: called as soon as the server answers, with its URL, and with the token if it has just been made.

    Raises:
        OSError: the address is not available.
        WeakTokenError: the token in the file is too short.
        StorageError: the token or the database cannot be read or kept.
        UnusableFolderError: the data folder cannot be used.
        HeldFolderError: another server uses the data folder.
        BadDatabaseUrlError: the database's URL names none that can be used.
        RequestError: its library is not installed.
        OtherDatabaseError: another version of Pleat has made its tables.
    """
    sys.setswitchinterval(_SWITCH_S)
    use_few_arenas()
    signal.signal(signal.SIGTERM, _end)  # uvicorn raises the signal again once it has ended
    address = _address(settings)
    with DataFolder(settings.data).held() as tell_others, _listening(address) as listener:
        start_template()
        token, made = _token(settings, address)
        bound = settings.model_copy(update={"port": listener.getsockname()[1]})
        with logging_to(standard_error(), as_json=settings.log_json):
            app = create_app(bound, token)
            app.state.workspace.prepare()

            def announce_everywhere() -> None:
                tell_others(_url(bound))
                announce(_url(bound), made)

            _Server(_config(app), announce_everywhere, app.state.workspace.lanes.stop).run(sockets=[listener])


def _end(_: int, __: FrameType | None) -> NoReturn:
    sys.exit(0)


def _config(app: Starlette) -> uvicorn.Config:
    return uvicorn.Config(
        app,
        log_config=None,
        http=TimedProtocol,
        ws=WebSocketProtocol,
        ws_max_size=_LARGEST_MESSAGE,
        ws_per_message_deflate=False,
        timeout_graceful_shutdown=_GRACE_S,
        server_header=False,
    )


def _address(settings: Settings) -> _Address:
    """Return the address to listen on."""
    family, _, _, _, address = socket.getaddrinfo(settings.host, settings.port, type=socket.SOCK_STREAM)[0]
    return family, address


def _token(settings: Settings, where: _Address) -> tuple[AccessToken | None, str | None]:
    """Return the token to ask for, if one is needed, and in words if it has just been made."""
    if settings.token_file is not None:
        return file_token(settings.token_file), None
    if settings.insecure or ipaddress.ip_address(where[1][0]).is_loopback:
        return None, None
    return kept_token(DataFolder(settings.data).token, is_new=settings.new_token)


def _listening(where: _Address) -> socket.socket:
    family, address = where
    # asyncio sends at once only where the protocol is named; else each answer would wait 40 ms for an acknowledgement.
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
    except OSError:
        listener.close()
        raise
    return listener


def _url(settings: Settings) -> str:
    host = f"[{settings.host}]" if ":" in settings.host else settings.host
    return f"http://{host}:{settings.port}"
