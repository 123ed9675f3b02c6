"""Requests that never end, sent to a real listener with short time-outs."""

import socket
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
import uvicorn

from app.server import protocols
from app.server.protocols import TimedProtocol
from tests.patience import PATIENCE_S

LIMIT_S = 0.3
SLOW_ANSWER_S, SLOW_BYTE_S, SLOW_HEAD_S = 3 * LIMIT_S, LIMIT_S / 5, LIMIT_S / 3
"""How long slow servers and clients take for what is in time, and so is not hung up on (s)."""
HEAD = b"GET / HTTP/1.1\r\nhost: here\r\n"
POST = b"POST / HTTP/1.1\r\nhost: here\r\ncontent-length: 10\r\n\r\n"


async def reads_and_answers_slowly(scope: Any, receive: Any, send: Any) -> None:
    import asyncio

    if scope["type"] != "http":
        return
    while True:
        message = await receive()
        if message["type"] == "http.disconnect":
            return
        if not message["more_body"]:
            break
    await asyncio.sleep(SLOW_ANSWER_S if scope["path"] == "/slow" else 0.0)
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]})
    await send({"type": "http.response.body", "body": b"ok"})


@pytest.fixture
def port(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    monkeypatch.setattr(protocols, "HEAD_S", LIMIT_S)
    monkeypatch.setattr(protocols, "BODY_S", LIMIT_S)
    listener = socket.create_server(("127.0.0.1", 0))
    config = uvicorn.Config(reads_and_answers_slowly, http=TimedProtocol, log_config=None, lifespan="off")
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, args=([listener],), daemon=True)
    thread.start()
    yield listener.getsockname()[1]
    server.should_exit = True
    thread.join(PATIENCE_S)


def opened(port: int) -> socket.socket:
    return socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)


def told_until_closed(wire: socket.socket) -> bytes:
    told = b""
    while part := wire.recv(65536):
        told += part
    return told


@pytest.mark.parametrize("begun", [b"", b"GET / HT", HEAD, POST, POST + b"half"])
def test_a_request_that_stops_half_way_is_hung_up_on(port: int, begun: bytes) -> None:
    with opened(port) as wire:
        wire.sendall(begun)
        told = told_until_closed(wire)
    assert told.startswith(b"HTTP/1.1 408")
    assert b"application/problem+json" in told


@pytest.mark.parametrize("begun", [HEAD, POST])
def test_a_byte_now_and_then_does_not_stretch_the_time(port: int, begun: bytes) -> None:
    with opened(port) as wire:
        wire.sendall(begun)
        with pytest.raises(OSError):
            for _ in range(1000):  # nine more bytes would end the body, so few enough of them are sent in the time
                time.sleep(SLOW_BYTE_S)
                wire.sendall(b"x")


def test_many_that_are_half_open_are_all_hung_up_on_and_others_answered_meanwhile(port: int) -> None:
    wires = [opened(port) for _ in range(300)]
    for wire in wires:
        wire.sendall(b"GET / HT")
    with opened(port) as wire:
        wire.sendall(HEAD + b"connection: close\r\n\r\n")
        assert told_until_closed(wire).startswith(b"HTTP/1.1 200")
    for wire in wires:
        with wire:
            assert told_until_closed(wire).startswith(b"HTTP/1.1 408")


def test_an_answer_may_take_its_time_and_the_next_request_its_own(port: int) -> None:
    with opened(port) as wire:
        for path in (b"/slow", b"/slow", b"/"):
            wire.sendall(b"GET " + path + b" HTTP/1.1\r\nhost: here\r\n")
            time.sleep(SLOW_HEAD_S)
            wire.sendall(b"\r\n")
            told = b""
            while not told.endswith(b"ok"):
                told += wire.recv(65536)
            assert told.startswith(b"HTTP/1.1 200")
