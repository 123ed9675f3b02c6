"""Servers that are forks of a process with the program in it: to import it takes seconds, and tests start many.

A fork has a parent, its keeper, that waits for it and tells how it ended. Processes that a server starts are its own.
"""

import atexit
import json
import os
import select
import signal
import socket
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import TextIO

PIECE = 1 << 16
"""The most that is read of a request at once (bytes); it is a line of JSON."""


class Forked:
    """A process that runs the program; it is used like a `subprocess.Popen` that has its output in a pipe."""

    def __init__(self, stdout: TextIO, told: TextIO) -> None:
        self.pid, self.stdout = int(told.readline()), stdout
        self.returncode: int | None = None
        self._told = told

    def poll(self) -> int | None:
        return self.wait(0.0)

    def wait(self, timeout: float | None = None) -> int | None:
        """Return the process's exit code, or minus the signal that ended it; None if it still runs after the time."""
        if self.returncode is None and select.select([self._told], [], [], timeout)[0]:
            self.returncode = int(self._told.readline())
            self._told.close()
        return self.returncode

    def send_signal(self, number: int) -> None:
        if self.poll() is None:
            os.kill(self.pid, number)

    def terminate(self) -> None:
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)

    def communicate(self, timeout: float | None = None) -> tuple[str, None]:
        """Return the rest of the output once the process and all others that write to it have ended."""
        if self.wait(timeout) is None:
            raise subprocess.TimeoutExpired(f"process {self.pid}", timeout or 0.0)
        rest = self.stdout.read()
        self.stdout.close()
        return rest, None


def forked(arguments: list[str]) -> Forked:
    """Start the program with some arguments."""
    read, write = os.pipe()
    told, tell = os.pipe()
    request = {"arguments": arguments, "environment": dict(os.environ), "folder": str(Path.cwd())}
    socket.send_fds(_nursery(), [f"{json.dumps(request)}\n".encode()], [write, tell])
    os.close(write)
    os.close(tell)
    return Forked(os.fdopen(read, encoding="utf-8"), os.fdopen(told, encoding="utf-8"))


@cache
def _nursery() -> socket.socket:
    """Start the process from which programs are forked; it ends once the socket to it is closed."""
    ours, theirs = socket.socketpair()
    command = f"from tests.app.nursery import fork_on_request; fork_on_request({theirs.fileno()})"
    process = subprocess.Popen([sys.executable, "-c", command], pass_fds=[theirs.fileno()])
    theirs.close()
    atexit.register(process.wait)
    atexit.register(ours.close)  # the last that is registered is done first
    return ours


def fork_on_request(descriptor: int) -> None:
    """Fork programs as they are asked for at a socket, until it is closed."""
    import app.server.serve  # noqa: F401
    from app.cli import main

    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for keepers
    asked_at = socket.socket(fileno=descriptor)
    while True:
        request, descriptors, _, _ = socket.recv_fds(asked_at, PIECE, 2)
        if not request:
            return
        while not request.endswith(b"\n"):
            request += asked_at.recv(PIECE)
        if os.fork() == 0:
            break
        for one in descriptors:
            os.close(one)
    asked_at.close()
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    write, tell = descriptors
    if pid := os.fork():
        os.close(write)
        os.write(tell, f"{pid}\n".encode())
        _, status = os.waitpid(pid, 0)
        os.write(tell, f"{os.waitstatus_to_exitcode(status)}\n".encode())
        os._exit(0)
    os.close(tell)
    for standard in (1, 2):
        os.dup2(write, standard)
    os.close(write)
    asked = json.loads(request)
    os.environ.clear()
    os.environ.update(asked["environment"])
    os.chdir(asked["folder"])
    sys.argv[1:] = asked["arguments"]
    main()
