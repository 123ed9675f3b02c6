"""Does the work of a job; runs in a process of its own."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from app.jobs.apart import Tell
from app.jobs.job_kind import Progress

Asked = TypeVar("Asked")
Answer = TypeVar("Answer")

_NICENESS = 10
"""Niceness of a job: people who draw, and those who wait for an answer, come first."""


@dataclass(frozen=True, slots=True)
class Progressed:
    """News of a job: the share that is done, and what is being done."""

    share: float
    message: str


def do_job(tell: Tell, work: Callable[[Asked, Progress], Answer], asked: Asked) -> Answer:
    """Do the work of a job, and send its progress on."""
    os.nice(_NICENESS)
    return work(asked, lambda share, message: tell(Progressed(min(max(share, 0.0), 1.0), message)))
