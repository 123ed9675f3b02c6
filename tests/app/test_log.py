import asyncio
import json
import logging
import os
import re

import pytest

from app.server.log import LINES_MAX, logging_to
from app.server.request_id import REQUEST_ID


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
    with logging_to(write):
        for _ in range(lines):
            logging.getLogger("app.workspace").warning("x" * 1000)
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
