"""Memory, CPU time and sockets of a process and of its children, read from /proc."""

import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

CLOCK_TICKS_PER_S = 100
"""Resolution of Linux's process accounting."""

_PAGE_MB = os.sysconf("SC_PAGE_SIZE") / (1 << 20)


def family(pid: int) -> list[int]:
    """Return a process and all below it, fork servers too."""
    below: dict[int, list[int]] = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            below.setdefault(int(stat.read_text().rpartition(")")[2].split()[1]), []).append(int(stat.parent.name))
        except OSError:
            continue
    found = [pid]
    for one in found:
        found.extend(below.get(one, ()))
    return found


def cpu_s(pid: int) -> float:
    """Return the CPU time that a process has spent (s); 0 where it has ended."""
    try:
        user, system = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:13]
    except OSError:
        return 0.0
    return (int(user) + int(system)) / CLOCK_TICKS_PER_S


def family_cpu_s(pids: Iterable[int]) -> float:
    """Return the CPU time that processes have spent, with that of their children that have ended (s)."""
    ticks = 0
    for pid in pids:
        with suppress(OSError):
            ticks += sum(map(int, Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:15]))
    return ticks / CLOCK_TICKS_PER_S


def memory_mb(pid: int) -> float:
    """Return the resident memory of a process (MB); 0 where it has ended."""
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * _PAGE_MB
    except OSError:
        return 0.0


def sockets(pid: int) -> int:
    """Return the number of a process's open sockets."""
    count = 0
    for entry in Path(f"/proc/{pid}/fd").iterdir():
        try:
            count += str(entry.readlink()).startswith("socket:")
        except OSError:  # closed meanwhile
            continue
    return count
