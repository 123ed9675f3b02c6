"""Does the work of a job; runs in a process of its own."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from app.jobs.job_kind import Progress
from app.worker.process import Caller

Asked = TypeVar("Asked")
Answer = TypeVar("Answer")


@dataclass(frozen=True, slots=True)
class Progressed:
    """News of a job: the share that is done, what is being done, and what was just found."""

    share: float
    message: str
    found: object = None


def do_job(caller: Caller, work: Callable[[Asked, Progress], Answer], asked: Asked) -> Answer:
    """Do the work of a job, and send its progress on."""

    def progress(share: float, message: str, found: object = None) -> None:
        caller.tell(Progressed(min(max(share, 0.0), 1.0), message, found))

    return work(asked, progress)
