"""Serves the designer on one address until interrupted."""

import ipaddress
import socket
import sys
from collections.abc import Callable
from typing import Any, TypeAlias

import uvicorn

from app.api.create_app import create_app
from app.server.log import logging_to, standard_error
from app.server.timed_protocol import TimedProtocol
from app.settings import Settings
from app.store.data_folder import DataFolder
from planner.errors import FoldingError

_LARGEST_MESSAGE = 4 << 20
"""Largest websocket message (bytes)."""

_GRACE_S = 1
"""Time for open requests to end at shutdown (s)."""

_SWITCH_S = 0.0001
"""Time for which a thread keeps the interpreter (s).

A request changes threads several times and waits that long for a running search each time; Python's default of 5 ms
would be noticeable.
"""


_Address: TypeAlias = tuple[socket.AddressFamily, tuple[Any, ...]]


class ExposedError(FoldingError):
    """The address is open to other machines, and the settings do not allow that."""


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


def serve(settings: Settings, announce: Callable[[str], None]) -> None:
    """Serve until interrupted; call `announce` with the URL as soon as the server answers.

    Raises:
        ExposedError: the address is beyond loopback, and `Settings.insecure` is not set.
        OSError: the address is not available.
        UnusableFolderError: the data folder cannot be used.
        HeldFolderError: another server uses the data folder.
    """
    sys.setswitchinterval(_SWITCH_S)
    address = _address(settings)
    with (
        DataFolder(settings.data).held() as tell_others,
        _listening(address) as listener,
        logging_to(standard_error()),
    ):
        bound = settings.model_copy(update={"port": listener.getsockname()[1]})
        app = create_app(bound)
        config = uvicorn.Config(
            app,
            log_config=None,
            http=TimedProtocol,
            ws_max_size=_LARGEST_MESSAGE,
            ws_per_message_deflate=False,
            timeout_graceful_shutdown=_GRACE_S,
            server_header=False,
        )
        stop_work = app.state.workspace.lanes.stop

        def announce_everywhere() -> None:
            tell_others(_url(bound))
            announce(_url(bound))

        _Server(config, announce_everywhere, stop_work).run(sockets=[listener])


def _address(settings: Settings) -> _Address:
    """Return the address to listen on; raise `ExposedError`."""
    family, _, _, _, address = socket.getaddrinfo(settings.host, settings.port, type=socket.SOCK_STREAM)[0]
    if not settings.insecure and not ipaddress.ip_address(address[0]).is_loopback:
        raise ExposedError(
            f"{settings.host} can be reached from other machines, and whoever comes in from there could read, change "
            "and delete your documents: nobody is asked for a password. Serve on 127.0.0.1, or say --insecure."
        )
    return family, address


def _listening(where: _Address) -> socket.socket:
    family, address = where
    listener = socket.socket(family, socket.SOCK_STREAM)
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
