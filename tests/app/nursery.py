"""Servers that are forks of a process with the program in it: to import it takes seconds, and tests start many.

All processes of a test run share that process. A fork has a parent, its keeper, that waits for it and tells how it
ended. Processes that a server starts are its own; its template of workers is a fork, too.
"""

import fcntl
import gc
import json
import multiprocessing.util
import os
import select
import signal
import socket
import subprocess
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, TextIO

FOLDER = "PLEAT_TEST_NURSERY"
"""Names the folder in which a test run has the nursery's socket."""

SOCKET, LASTS = "socket", "lasts"
FREE_FROM = 200
"""Descriptors from here on are none that a program asks for by their numbers."""

PIECE = 1 << 16
"""The most that is read of a request at once (bytes); it is a line of JSON."""

SERVER = ("alembic.command", "app.api.metrics", "app.cli.serve", "app.server.serve")
WORKERS = ("app.job_kinds.kinds", "app.live_planning", "app.searches")
"""What they import as they start."""

ENVIRONMENT = dict(os.environ)
"""As it is before any test changes it."""


def be_had(folder: str) -> None:
    """Have a nursery in a folder from when it is first asked for until this process ends."""
    os.environ[FOLDER] = folder
    os.mkfifo(Path(folder) / LASTS)
    os.open(Path(folder) / LASTS, os.O_RDWR)


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
    with _nursery() as nursery:
        _ask(nursery, request, [write, tell])
    os.close(write)
    os.close(tell)
    return Forked(os.fdopen(read, encoding="utf-8"), os.fdopen(told, encoding="utf-8"))


def _ask(process: socket.socket, request: dict[str, Any], descriptors: list[int]) -> None:
    socket.send_fds(process, [f"{json.dumps(request)}\n".encode()], descriptors)


def _asked(by: socket.socket) -> tuple[dict[str, Any] | None, list[int]]:
    """Return a request, and the descriptors that came with it; None if there is no one to ask any more."""
    line, descriptors, _, _ = socket.recv_fds(by, PIECE, 8)
    while line and not line.endswith(b"\n"):
        line += by.recv(PIECE)
    return json.loads(line) if line else None, descriptors


def _nursery() -> socket.socket:
    """Return a connection to the process from which programs are forked; the first that asks starts it."""
    folder = Path(os.environ[FOLDER])
    with (folder / LASTS).open("rb+", buffering=0) as lasts, socket.socket(socket.AF_UNIX) as listener:
        fcntl.flock(lasts, fcntl.LOCK_EX)
        if not (folder / SOCKET).exists():
            listener.bind(str(folder / SOCKET))
            listener.listen(64)
            command = f"from tests.app.nursery import fork_on_request; fork_on_request({listener.fileno()})"
            listener.set_inheritable(True)
            os.posix_spawn(sys.executable, [sys.executable, "-c", command], ENVIRONMENT)
    nursery = socket.socket(socket.AF_UNIX)
    nursery.connect(str(folder / SOCKET))
    return nursery


def fork_on_request(descriptor: int) -> None:
    """Fork programs as they are asked for at a socket, as long as the test run lasts."""
    from app.cli import main
    from planner.planning.warm_up import compile_kernels

    for name in SERVER + WORKERS:
        import_module(name)
    compile_kernels()
    gc.freeze()  # looking through them for garbage would copy them
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for keepers
    listener = socket.socket(fileno=descriptor)
    lasts = os.open(Path(listener.getsockname()).with_name(LASTS), os.O_RDONLY | os.O_NONBLOCK)
    while True:
        ready, _, _ = select.select([listener.fileno(), lasts], [], [])
        if lasts in ready:
            return
        with listener.accept()[0] as by:
            asked, descriptors = _asked(by)
        if asked is not None and os.fork() == 0:
            break
        for one in descriptors:
            os.close(one)
    listener.close()
    os.close(lasts)
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
    os.environ.clear()
    os.environ.update(asked["environment"])
    os.chdir(asked["folder"])
    sys.argv[1:] = asked["arguments"]
    _fork_template()
    main()


def _fork_template() -> None:
    """Have a fork of this process ready for when `multiprocessing` would start an interpreter as its fork server.

    It is made while no other thread runs. A second fork server is an interpreter.
    """
    asks, by = socket.socketpair()
    if not (pid := os.fork()):
        asks.close()
        _become_fork_server(by)
    by.close()
    start = multiprocessing.util.spawnv_passfds

    def started(path: bytes, args: Sequence[Any], passfds: Sequence[int]) -> int:
        command = os.fsdecode(args[-1])
        if "forkserver" not in command or asks.fileno() < 0:
            return start(path, args, passfds)
        masked = [int(number) for number in signal.pthread_sigmask(signal.SIG_BLOCK, [])]
        request = {"command": command, "numbers": list(passfds), "masked": masked, "environment": dict(os.environ)}
        with asks:
            _ask(asks, request, list(passfds))
        return pid

    multiprocessing.util.spawnv_passfds = started


def _become_fork_server(by: socket.socket) -> None:
    """Run the command that is sent, with the descriptors that it names by their numbers."""
    asked, descriptors = _asked(by)
    by.close()
    if asked is None:
        os._exit(0)
    free = [fcntl.fcntl(one, fcntl.F_DUPFD, FREE_FROM) for one in descriptors]
    for one in descriptors:
        os.close(one)
    for one, number in zip(free, asked["numbers"], strict=True):
        os.dup2(one, number)
        os.close(one)
    os.environ.clear()
    os.environ.update(asked["environment"])
    signal.pthread_sigmask(signal.SIG_SETMASK, asked["masked"])
    try:
        exec(asked["command"], {})
    finally:
        os._exit(0)
