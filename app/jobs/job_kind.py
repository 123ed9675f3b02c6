"""A kind of job: the form of its request, and the functions that check, do and answer it.

A request passes through three functions. `prepare` runs in the server: it turns the body into the argument of the work,
looking up garments and plans by name, and raises for a bad request before there is a job. `work` runs in a process of
its own, which a cancel kills at any point together with the processes it has started. `finish` runs in the server again
and returns the result as JSON.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, Protocol, TypeAlias, TypeVar

from app.store.garment_repository import GarmentRepository
from app.store.plan_store import PlanStore
from app.store.robot_repository import RobotRepository
from app.store.study_store import StudyStore
from app.store.trace_store import TraceStore
from app.worker.process import Caller
from planner.json_form import JsonForm

Body = TypeVar("Body")
Asked = TypeVar("Asked")
Answer = TypeVar("Answer")


class Progress(Protocol):
    """Tells how far a job is."""

    def __call__(self, share: float, message: str, found: object = None) -> None:
        """Tell the share of the job that is done (0..1), what is being done, and what was just found."""


LARGEST_BODY = 1 << 20
"""Largest body of a request by default (bytes)."""


@dataclass(frozen=True, slots=True)
class Stores:
    """The repositories and stores that a kind's functions may use; they add plans, traces, studies and robots.

    Attributes:
        garments: the garments.
        plans: the plans made so far.
        studies: the studies.
        traces: the traces of rehearsed runs.
        robots: the robots of one's own.
    """

    garments: GarmentRepository
    plans: PlanStore
    studies: StudyStore
    traces: TraceStore
    robots: RobotRepository


def as_it_is(_: Stores, answer: Answer) -> Answer:
    """Return what the work has brought, which is JSON already: a `finish` or `tell`."""
    return answer


def _unnamed(_: object) -> str:
    """Return no name: an `about`."""
    return ""


def _nothing(_: Stores, __: object) -> None:
    """Leave everything as it is: a `release`."""


@dataclass(frozen=True)
class JobKind(Generic[Body, Asked, Answer]):
    """A kind of job.

    Attributes:
        name: its name in REST.
        does: what it does, as a sentence for the description of its route.
        body: the type of the request's body: a `StrictModel`, or a dataclass with `STRICT` as its config.
        example: a body that is answered.
        prepare: returns the argument of `work`; it must be picklable. Raises a `FoldingError` for a bad request.
        work: a module-level function, in a module that is cheap to import. Its result must be picklable.
        finish: returns the result as JSON.
        tell: returns what the work has just found as JSON; runs in the server, as `finish` does.
        about: tells jobs of a kind apart for people: the title of the garment or study, from what `prepare` returned.
        release: called once the job has ended in whatever way, with what `prepare` returned.
        path: the path of the route that starts such jobs; by default `/api/jobs/{name}`.
        largest_body: the largest body (bytes).
        may_begin_anew: whether a job that the server's end interrupted is done again at the next start.
        is_listed_cancelled: whether a job that was cancelled is listed; not where a page cancels one with each change
            of what it looks for, and begins the next.
    """

    name: str
    does: str
    body: type[Body]
    example: dict[str, Any]
    prepare: Callable[[Stores, Body], Asked]
    work: Callable[[Asked, Progress], Answer]
    finish: Callable[[Stores, Answer], Any]
    tell: Callable[[Stores, Any], dict[str, Any]] = as_it_is
    about: Callable[[Asked], str] = _unnamed
    release: Callable[[Stores, Asked], None] = _nothing
    path: str | None = None
    largest_body: int = LARGEST_BODY
    may_begin_anew: bool = False
    is_listed_cancelled: bool = True

    @cached_property
    def form(self) -> JsonForm[Body]:
        """Reads the body from JSON."""
        return JsonForm(self.body)

    @property
    def route(self) -> str:
        """The path of the route that starts jobs of this kind."""
        return self.path or f"/api/jobs/{self.name}"


AnyKind: TypeAlias = JobKind[Any, Any, Any]


@dataclass(frozen=True, slots=True)
class Progressed:
    """News of a job: the share that is done, what is being done, and what was just found."""

    share: float
    message: str
    found: object = None


def do_job(caller: Caller, work: Callable[[Asked, Progress], Answer], asked: Asked) -> Answer:
    """Do the work of a job in its own process, and send its progress on."""

    def progress(share: float, message: str, found: object = None) -> None:
        caller.tell(Progressed(min(max(share, 0.0), 1.0), message, found))

    return work(asked, progress)
