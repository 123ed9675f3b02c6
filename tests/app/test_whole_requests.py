"""Requests that are refused before their body was read: the client is told so, and not cut off."""

import socket
from collections.abc import Iterator

import pytest

from tests.app.conftest import REST, Served
from tests.patience import PATIENCE_S

MIB = 1 << 20


def answered(served: Served, method: str, path: str, size: int, *headers: str) -> bytes:
    """Return the answer to a request that sends all of its body before it looks for one."""
    head = [f"{method} {path} HTTP/1.1", f"Host: {served.authority}", *headers, f"Content-Length: {size}", "", ""]
    with socket.create_connection(("127.0.0.1", served.port), timeout=PATIENCE_S) as wire:
        wire.sendall("\r\n".join(head).encode())
        for _ in range(size // MIB):
            wire.sendall(b" " * MIB)
        return wire.recv(4096)


@pytest.mark.parametrize(
    ("method", "path", "size", "status"),
    [
        ("POST", "/api/plans", 3 * MIB, 413),
        ("POST", "/api/dag", 3 * MIB, 413),
        ("POST", "/api/plans/imports", 60 * MIB, 413),
        ("POST", "/api/robots/imports", 80 * MIB, 413),
        ("PUT", "/api/garments/mine", 3 * MIB, 413),
        ("POST", "/nothing", 8 * MIB, 404),
        ("DELETE", "/api/plans", 8 * MIB, 405),
    ],
)
def test_a_body_beyond_the_limit_is_answered(served: Served, method: str, path: str, size: int, status: int) -> None:
    answer = answered(served, method, path, size, "Content-Type: application/json")
    assert answer.startswith(f"HTTP/1.1 {status} ".encode()) and b"application/problem+json" in answer


def test_a_client_that_asks_first_is_answered_at_once(served: Served) -> None:
    with socket.create_connection(("127.0.0.1", served.port), timeout=PATIENCE_S) as wire:
        wire.sendall(
            f"POST /api/dag HTTP/1.1\r\nHost: {served.authority}\r\nExpect: 100-continue\r\n"
            f"Content-Length: {100 * MIB}\r\n\r\n".encode()
        )
        assert wire.recv(4096).startswith(b"HTTP/1.1 413 ")


def test_pieces_of_unknown_number_are_answered_too(served: Served) -> None:
    def pieces() -> Iterator[bytes]:
        yield from [b" " * MIB] * 3

    headers = {"content-type": "application/json"}
    assert REST.post(f"{served.url}/api/dag", content=pieces(), headers=headers).status_code == 413
