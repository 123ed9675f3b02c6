"""The processes that a process has started, from Linux's /proc."""

from pathlib import Path


def descendants(pid: int) -> set[int]:
    """Return all descendants of a process."""
    parents: dict[int, int] = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            after_name = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if after_name[0] != "Z":
            parents[int(stat.parent.name)] = int(after_name[1])
    found, grown = {pid}, True
    while grown:
        below = {child for child, parent in parents.items() if parent in found} - found
        found |= below
        grown = bool(below)
    return found - {pid}


def is_alive(pid: int) -> bool:
    """Return whether any thread of a process still runs: as long as one does, its files are open."""
    return any(_is_running(task) for task in Path(f"/proc/{pid}/task").glob("*/stat"))


def _is_running(task: Path) -> bool:
    try:
        return task.read_text().rpartition(")")[2].split()[0] not in ("Z", "X")
    except (FileNotFoundError, ProcessLookupError):  # it has just ended
        return False
