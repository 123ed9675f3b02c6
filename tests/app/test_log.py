import logging
import os
import re

import pytest

from app.server.log import LINES_MAX, logging_to


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
    os.close(read)
    os.close(write)
