import asyncio
import json
import logging
import os
import re
import socket
import threading
from pathlib import Path

import pytest

from app.server.log import LINES_MAX, logging_to
from app.server.request_id import REQUEST_ID
from tests.app.conftest import Served
from tests.patience import PATIENCE_S


def test_a_line_has_time_level_and_source() -> None:
    read, write = os.pipe()
    with logging_to(write):
        logging.getLogger("app.workspace").warning("the disk is %s", "full")
        logging.getLogger("uvicorn.access").info("a request")
        logging.getLogger("websockets").info("small talk")
    os.close(write)
    with os.fdopen(read, encoding="utf-8") as file:
        first, second = file.read().splitlines()
    stamp = r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d[+-]\d{4}"
    assert re.fullmatch(stamp + " WARNING app.workspace: the disk is full", first)
    assert re.fullmatch(stamp + " INFO uvicorn.access: a request", second)


@pytest.mark.parametrize("lines", [10, 3 * LINES_MAX])
def test_a_pipe_that_nobody_reads_holds_up_nobody(lines: int) -> None:
    read, write = os.pipe()

    def log() -> None:
        with logging_to(write):
            for _ in range(lines):
                logging.getLogger("app.workspace").warning("x" * 1000)

    thread = threading.Thread(target=log, daemon=True)
    thread.start()
    thread.join(PATIENCE_S)
    assert not thread.is_alive()
    # The writing end stays open: lines that still wait would be written to whatever gets its number next.
    os.close(read)


def test_a_line_within_a_request_has_its_id_as_text_and_as_json() -> None:
    lines = {}
    for as_json in (False, True):
        read, write = os.pipe()
        before = REQUEST_ID.set("a-b.c")
        with logging_to(write, as_json=as_json):
            try:
                raise ValueError("bad\nluck")
            except ValueError:
                logging.getLogger("app.workspace").exception("it failed")
        REQUEST_ID.reset(before)
        os.close(write)
        with os.fdopen(read, encoding="utf-8") as file:
            lines[as_json] = file.read()
    assert lines[False].endswith("request=a-b.c\n")
    told = json.loads(lines[True])
    assert {name: told[name] for name in ("level", "source", "request")} == {
        "level": "ERROR",
        "source": "app.workspace",
        "request": "a-b.c",
    }
    assert told["message"].startswith("it failed\nTraceback") and "bad\nluck" in told["message"]


def test_a_request_cut_off_by_the_end_of_the_server_is_no_error_but_a_failed_one_is() -> None:
    read, write = os.pipe()
    with logging_to(write):
        for error in (asyncio.CancelledError(), KeyError("a fault")):
            try:
                raise error
            except (asyncio.CancelledError, KeyError):
                logging.getLogger("uvicorn.error").exception("Exception in ASGI application")
    os.close(write)
    with os.fdopen(read, encoding="utf-8") as file:
        told = file.read()
    assert told.count("Exception in ASGI application") == 1
    assert "a fault" in told


SECRET = "Sw0rdfish-Sw0rdfish_Sw0rdfish"

REQUESTS = [
    ("GET", "/?token={}", ""),
    ("GET", "/?token={0}&token={0}", ""),
    ("GET", "/?%74o%6Ben%3D{0}&%54OKEN={0}", ""),
    ("GET", "/?next=%2F%3Ftoken%253D{}", ""),
    ("GET", "/d/a%3Ftoken={}", ""),
    ("GET", "/pleat/?token={}", "X-Forwarded-Prefix: /pleat\r\n"),
    ("GET", "/?token={0}", "Cookie: pleat-{port}={0}\r\n"),
    ("GET", "/?token={0}", "Authorization: Bearer {0}\r\n"),
    ("GET", "/?token={}", "Sec-Fetch-Site: cross-site\r\n"),
    ("HEAD", "/?token={}", ""),
    ("POST", "/api/dag?token={}", ""),
    ("GET", "/s/{0}/d/abcdefgh?token={0}", ""),
    ("GET", "//s//{}/", ""),
    ("GET", "/?next=%2Fs%2F{}", ""),
    ("GET", "/api/documents/abcdefgh/live?token={}", "UPGRADE"),
    ("GET", "/s/{}/api/documents/abcdefgh/live", "UPGRADE"),
]
"""Method, target and further headers of requests that name a secret, under the server's own name and a foreign one."""

UPGRADE = (
    "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
)


def asked(port: int, method: str, target: str, host: str, headers: str) -> bytes:
    """Return the beginning of the answer to a request, sent as it is written here."""
    with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S) as wire:
        wire.sendall(f"{method} {target} HTTP/1.1\r\nHost: {host}\r\n{headers}\r\n".encode())
        return wire.recv(64)


@pytest.mark.parametrize("form", [[], ["--log-json"]])
def test_no_request_brings_a_token_into_the_log_and_refused_websockets_are_no_errors(
    tmp_path: Path, form: list[str]
) -> None:
    (tmp_path / "token").write_text(SECRET)
    server = Served(tmp_path / "data", 0, "--token-file", str(tmp_path / "token"), *form)
    try:
        for host in (server.authority, "evil.example"):
            for method, target, headers in REQUESTS:
                more = UPGRADE if headers == "UPGRADE" else headers.format(SECRET, port=server.port)
                assert asked(server.port, method, target.format(SECRET), host, more).startswith(b"HTTP/1.1 ")
        server.process.terminate()
        told, _ = server.process.communicate(timeout=PATIENCE_S)
    finally:
        server.stop()
    lines = told.splitlines()
    assert sum(" HTTP/1.1" in line for line in lines) == 2 * len(REQUESTS) - 4
    assert "Sw0rdfish" not in told and "ERROR" not in told
    refused = [line for line in lines if "WebSocket" in line]
    assert len(refused) == 4 and all("127.0.0.1:" in line for line in refused)
    assert [re.findall(r" (40\d)\b", line)[0] for line in refused] == ["401", "403", "403", "403"]


def test_what_is_no_secret_stays_in_the_log() -> None:
    read, write = os.pipe()
    with logging_to(write):
        logging.getLogger("uvicorn.access").info('"GET /?token=abc"de&rate_hz=30 HTTP/1.1" 200')
        logging.getLogger("uvicorn.access").info('"GET /static/js/main.js HTTP/1.1" 200')
        logging.getLogger("uvicorn.error").info("Application startup complete.")
        logging.getLogger("uvicorn.error").info('%s - "WebSocket %s" [accepted]', "127.0.0.1:1", "/live")
    os.close(write)
    with os.fdopen(read, encoding="utf-8") as file:
        first, second = file.read().splitlines()
    assert first.endswith('"GET /?token=...&rate_hz=30 HTTP/1.1" 200')
    assert second.endswith('"GET /static/js/main.js HTTP/1.1" 200')
