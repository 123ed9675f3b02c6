"""The memory of a server's threads: few arenas, so that what one thread has freed serves the others."""

import os
import platform
import subprocess
import sys

import pytest

from app.server.arenas import ARENAS_MAX

pytestmark = pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="only glibc has arenas")

COUNT = """
import ctypes, tempfile, threading
FIRST
all_there = threading.Barrier(64)
def work():
    all_there.wait()
    kept = [bytes(4096) for _ in range(100)]
    all_there.wait()
threads = [threading.Thread(target=work) for _ in range(64)]
for thread in threads: thread.start()
for thread in threads: thread.join()
libc = ctypes.CDLL(None)
libc.fopen.restype = ctypes.c_void_p
with tempfile.NamedTemporaryFile("r") as told:
    file = ctypes.c_void_p(libc.fopen(told.name.encode(), b"w"))
    libc.malloc_info(0, file)
    libc.fclose(file)
    print(told.read().count("<heap nr="))
"""


def arenas(first: str, **chosen: str) -> int:
    """Return the number of arenas of a program with many threads."""
    others = {name: value for name, value in os.environ.items() if name not in ("MALLOC_ARENA_MAX", "GLIBC_TUNABLES")}
    command = [sys.executable, "-c", COUNT.replace("FIRST", first)]
    told = subprocess.run(command, env={**others, **chosen}, capture_output=True, text=True, check=True)
    return int(told.stdout)


def test_many_threads_share_few_arenas() -> None:
    few = "from app.server.arenas import use_few_arenas; use_few_arenas()"
    assert arenas(few) <= ARENAS_MAX < arenas("")
    assert arenas(few, MALLOC_ARENA_MAX="5") == arenas("", MALLOC_ARENA_MAX="5") > ARENAS_MAX
