"""A server in a process of its own, requests to it, and its CPU time."""

import json
import subprocess
import sys
import tempfile
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from bench.measurement import BenchmarkError

ROOT = Path(__file__).parent.parent
CLOCK_TICKS_PER_S = 100
"""Resolution of Linux's process accounting."""


@contextmanager
def served() -> Iterator[tuple[str, "subprocess.Popen[str]"]]:
    """Serve on a free port with an empty data folder; yield the address and the process."""
    with tempfile.TemporaryDirectory() as data:
        options = ["serve", "--port", "0", "--data", data]
        command = [sys.executable, "-c", "from app.cli import main; main()", *options]
        out, log = subprocess.PIPE, subprocess.DEVNULL
        with subprocess.Popen(command, cwd=ROOT, stdout=out, stderr=log, text=True) as process:
            try:
                assert process.stdout is not None
                address = next((word for word in process.stdout.readline().split() if word.startswith("http://")), None)
                if address is None:
                    raise BenchmarkError("the server does not start")
                yield address, process
            finally:
                process.kill()


def ask(method: str, url: str, body: object = None) -> dict[str, Any]:
    """Return the server's JSON answer; raise `urllib.error.HTTPError` for a problem."""
    content = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(url, content, {"content-type": "application/json"}, method=method)
    with urllib.request.urlopen(request) as answer:
        found: dict[str, Any] = json.load(answer)
    return found


def cpu_s(pid: int) -> float | None:
    """Return the CPU time that a process has spent (s); None where the system does not report it."""
    account = Path(f"/proc/{pid}/stat")
    if not account.exists():
        return None
    user, system = account.read_text().rpartition(")")[2].split()[11:13]
    return (int(user) + int(system)) / CLOCK_TICKS_PER_S
