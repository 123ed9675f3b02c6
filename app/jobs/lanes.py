"""Assigns work to lanes, so that short work never waits behind long work.

- ``quick`` is for work of some hundredths of a second.
- ``files`` is for work of up to some seconds: reading files, making them, sampling timelines.
- ``robots`` is for reading robots, one at a time, in processes of their own: their meshes may take much memory.
- ``searches`` is for plans, suggestions and maps, in the workers (`app.worker`).
- ``jobs`` is for work of any length that nobody waits for, in processes of their own; a core is left to the others.
- ``live`` is for the plans of the open documents, in the workers too.

Each lane has its own workers and its own queue, which is limited where clients can add work.
"""

import os
import time

from app.jobs.job_pool import PATIENCE_S, JobPool
from app.worker.workers import Workers

QUICK_WAITING_MAX = 64
FILES_WAITING_MAX = 16
ROBOTS_WAITING_MAX = 8
SEARCHES_WAITING_MAX = 32
JOBS_WAITING_MAX = 64

BACKGROUND_NICENESS = 10
"""Niceness of jobs and of searches for suggestions: people who draw, and the plans of their drawings, come first."""


class Lanes:
    """The lanes of a server.

    Attributes:
        workers: the processes for work that somebody waits for.
        background: those for the rest: they have less right to the processor.
    """

    def __init__(self) -> None:
        """Start no thread before there is work."""
        self.workers = Workers()
        self.background = Workers(kept=1, niceness=BACKGROUND_NICENESS)
        self.quick = JobPool(waiting_max=QUICK_WAITING_MAX)
        self.files = JobPool(waiting_max=FILES_WAITING_MAX)
        self.robots = JobPool(workers=1, waiting_max=ROBOTS_WAITING_MAX)
        self.searches = JobPool(waiting_max=SEARCHES_WAITING_MAX)
        self.jobs = JobPool(workers=max(1, (os.cpu_count() or 1) - 1), waiting_max=JOBS_WAITING_MAX)
        self.live = JobPool()

        self._pools = (self.quick, self.files, self.robots, self.searches, self.jobs, self.live)

    def load(self) -> dict[str, tuple[int, int, int]]:
        """Return by lane how many jobs wait, how many run, and how many have run so far."""
        names = ("quick", "files", "robots", "searches", "jobs", "live")
        return {name: pool.load() for name, pool in zip(names, self._pools, strict=True)}

    def stop(self) -> None:
        """Stop all work."""
        for pool in self._pools:
            pool.stop()

    def close(self) -> None:
        """Stop all work, and wait a little for it to end."""
        self.stop()
        deadline_s = time.monotonic() + PATIENCE_S
        for pool in self._pools:
            pool.close(max(0.0, deadline_s - time.monotonic()))
        self.workers.close()
        self.background.close()
