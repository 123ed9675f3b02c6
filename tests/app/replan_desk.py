"""A document that is planned anew at every edit, without a server."""

import threading
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from app.document import Document
from app.document_state import VersionPlan
from app.drawing.draft import draft_of
from app.drawing.drawing import Drawing
from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from app.jobs.job_pool import JobPool
from app.replanner import Replanner
from app.store.database import Database
from app.store.plan_store import PlanStore
from bench.in_thread import InThread
from planner.cloth.garment import Garment
from planner.plans import plan
from tests.app.drawing.drawings import pulled
from tests.app.samples import towel
from tests.patience import wait_until
from tests.required import required

TOWEL = solve(drawing_of(Garment.from_dict(towel()))).drawing


class Desk:
    """A document with its planner."""

    def __init__(self, database: Database) -> None:
        self.pool = JobPool()
        self.plans = PlanStore(database)
        self.document = Document(draft_of(TOWEL))
        self.replanner = Replanner(self.document, self.pool, InThread(), self.plans)

    def rest(self) -> None:
        """Wait until the plan and everything else belong to the drawing."""
        wait_until(lambda: self.is_answered and self.has_film and self.answer.is_final)

    @property
    def answer(self) -> VersionPlan:
        """The document's latest answer; there has to be one."""
        return required(self.document.state.answer)

    @property
    def is_answered(self) -> bool:
        return self.document.state.is_answered

    @property
    def has_film(self) -> bool:
        state = self.document.state
        return state.shown is not None and state.answer is not None and state.shown.plan is state.answer.plan


@contextmanager
def replanning() -> Iterator[Desk]:
    with TemporaryDirectory() as folder, closing(Database(Path(folder) / "pleat.db")) as database:
        made = Desk(database)
        yield made
        made.replanner.close()
        made.pool.close()


class Endless:
    """A search that ends only when it is stopped; by default only the first one does.

    Attributes:
        begun: whether it has begun.
        stopped: whether it was told to stop.
    """

    def __init__(self, *, is_once: bool = True) -> None:
        self.begun, self.stopped = threading.Event(), threading.Event()
        self._is_once = is_once

    def __call__(self, *arguments: object, should_stop: Callable[[], bool], **options: object) -> object:
        if not (self._is_once and self.begun.is_set()):
            self.begun.set()
            wait_until(should_stop)
            self.stopped.set()
        return plan(*arguments, should_stop=should_stop, **options)  # type: ignore[arg-type]


def nothing(*_: object, **__: object) -> None:
    """Adapt no plan."""


def moved(millimetres: float) -> Drawing:
    return solve(pulled(TOWEL, 0, -0.001 * millimetres, 0.0)).drawing
