"""Everything that a running server holds: garments, documents, plans, and the lanes for work."""

import logging
import threading
from collections.abc import Mapping
from functools import partial

from app.document import Document
from app.drawing.draft import draft_of
from app.drawing.drawing import Drawing
from app.drawing.garment_drawing import drawing_of
from app.jobs.job_desk import JobDesk
from app.jobs.job_kind import AnyKind, Stores
from app.jobs.lanes import Lanes
from app.jobs.limits import CLIENT, TooManyError
from app.live_planning import compile_for
from app.open_document import OpenDocument
from app.settings import Settings
from app.store.data_folder import DataFolder
from app.store.database import Database
from app.store.document_reader import KeptDocument
from app.store.document_repository import DocumentRepository
from app.store.garment_repository import GarmentRepository
from app.store.job_repository import JobRepository
from app.store.plan_store import PlanStore
from app.store.robot_repository import RobotRepository
from app.store.share_repository import ShareRepository
from app.store.study_store import StudyStore
from app.store.trace_store import TraceStore
from app.worker.process import ignore
from app.worker.stop import Stop, StoppedError
from app.worker.template import LostProcessError, template_problem
from planner.errors import FoldingError
from planner.planning.warm_up import EACH_KIND, must_compile
from planner.robots.own_robots import use_robots_folder

FIRST_GARMENT = "t-shirt"
UNUSED_S = 60.0
"""Time after which an unused document is closed (s)."""

OPEN_MAX, CROWDED_S = 32, 5.0
"""Number of documents beyond which unused ones are closed sooner, and the time after which (s).

An open document holds its plans, and a worker what they were found with: 0.3 to 5 MB (measured). The time is for
clients that go from document to document and wait for each plan.
"""

_LOOK_EVERY_S = 2.0
"""Period of the check for unused documents, and for robots that other servers have changed (s)."""

_AT_REST_S = 1.0
"""Time after its last use in which a document makes no room for another of the same client (s)."""

_ROOM_AFTER_S = 5
"""Time after which a client with too many open documents may try again (s)."""

_log = logging.getLogger(__name__)


class Workspace:
    """The workspace of a server.

    Attributes:
        folder: the data folder.
        garments: the garment repository.
        robots: the repository of robots; the whole process looks for robots of one's own there.
        documents: the document repository.
        shares: the links to documents.
        plans: the plans made so far.
        traces: the traces of rehearsed runs.
        study_store: the studies.
        lanes: the workers for everything that takes time.
        database: the database.
        jobs: the jobs, running and ended.
    """

    def __init__(self, settings: Settings, kinds: Mapping[str, AnyKind]) -> None:
        """Start with no open document; `kinds` are the jobs that can be asked for."""
        self.folder = DataFolder(settings.data)
        self.database = Database(self.folder.database, settings.database)
        self.garments = GarmentRepository(self.database)
        self.robots = RobotRepository(self.folder.robots, self.database)
        use_robots_folder(self.folder.robots)
        self.documents = DocumentRepository(self.database)
        self.shares = ShareRepository(self.database)
        self.plans = PlanStore(self.database)
        self.traces = TraceStore(self.database)
        self.lanes = Lanes()
        self.study_store = StudyStore(self.folder.studies, self.database)
        stores = Stores(self.garments, self.plans, self.study_store, self.traces, self.robots)
        self.jobs = JobDesk(kinds, stores, JobRepository(self.database), self.lanes.jobs, self.lanes.background)
        self._of_client_max = settings.open_documents
        self._open: dict[str, OpenDocument] = {}
        self._lock = threading.RLock()
        self._closing = threading.Event()
        self._compiling = Stop()

    def prepare(self) -> None:
        """Open the database.

        Raises:
            StorageError: the system or the database refuses.
            OtherDatabaseError: another version of Pleat has made the tables.
        """
        with self.database.reading("the database cannot be used"):
            pass

    def start(self) -> None:
        """Open the document that the page shows first, and start closing unused ones."""
        self.robots.recover()
        try:
            self.robots.take_over()
        except FoldingError as error:
            _log.error("%s", error)
        try:
            self.opened(self.first()).show()
        except FoldingError as error:
            _log.error("no document could be opened: %s", error)
        try:
            self.jobs.resume()
        except FoldingError as error:
            _log.error("the jobs of the last time could not be read: %s", error)
        threading.Thread(target=self._look_after, name="workspace", daemon=True).start()
        threading.Thread(target=self._compile, name="kernels", daemon=True).start()

    def _compile(self) -> None:
        """Compile the kernels that the cache lacks, so that no robot's first plan waits for them; all else goes first.

        The template has those of the first robot. Each kernel is in the cache as soon as it is compiled: who needs the
        same meanwhile compiles only the rest.
        """
        try:
            for robot in EACH_KIND[1:]:
                if must_compile(robot):
                    self.lanes.background.run(compile_for, self._compiling, ignore, robot)
        except StoppedError:
            return
        except (FoldingError, LostProcessError) as error:
            _log.warning("kernels could not be compiled ahead: %s", error)

    def first(self) -> str:
        """Return the id of the document to show first: the last one opened, or a new one if none can be opened."""
        with self._lock:
            for document_id in self.documents.recent():
                try:
                    return self.opened(document_id).id
                except TooManyError:
                    raise
                except FoldingError as error:
                    _log.warning("%s", error)
            return self.create(drawing_of(self.garments.garment(FIRST_GARMENT))).id

    def create(self, drawing: Drawing) -> OpenDocument:
        """Return a new document, open and saved; raises `TooManyError` as `opened` does."""
        with self._lock:
            self._make_room()
            document_id = self.documents.new_id()
            draft = draft_of(drawing)
            keeper = self.documents.keeper(document_id)
            keeper.keep(1, draft)
            return self._open_as(document_id, KeptDocument(1, draft, keeper))

    def opened(self, document_id: str) -> OpenDocument:
        """Return an open document; open it if necessary.

        Raises:
            UnknownDocumentError: there is none with this id.
            NewerDocumentError: a newer version of Pleat wrote it.
            BrokenDocumentError: it cannot be read.
            StorageError: the database refuses.
            TooManyError: the client has too many open documents, all of them in use.
        """
        with self._lock:
            if document_id not in self._open:
                self._make_room()
                self._open_as(document_id, self.documents.kept(document_id))
            opened = self._open[document_id]
            opened.touch()
            return opened

    def remove(self, document_id: str) -> None:
        """Remove a document for good, and tell its users.

        Raises:
            UnknownDocumentError: there is none with this id.
            StorageError: it could not be removed; nothing has changed.
        """
        with self._lock:
            opened = self._open.get(document_id)
            if opened is None:
                self.documents.remove(document_id)
            else:
                opened.document.end(lambda: self.documents.remove(document_id))
                del self._open[document_id]
        if opened is not None:
            opened.say_goodbye()
            opened.close()

    def close_unused(self, unused_s: float = UNUSED_S) -> None:
        """Close the documents that have been unused for longer than a time (s), and sooner those beyond `OPEN_MAX`."""
        with self._lock:
            by_use = sorted(self._open.values(), key=lambda opened: opened.unused_s, reverse=True)
            beyond = len(by_use) - OPEN_MAX
            limits = (min(CROWDED_S, unused_s) if number < beyond else unused_s for number in range(len(by_use)))
            unused = [opened for opened, limit_s in zip(by_use, limits, strict=True) if opened.unused_s > limit_s]
            for opened in unused:
                del self._open[opened.id]
        for opened in unused:
            opened.close()

    def problems(self) -> dict[str, str | None]:
        """Return what is wrong now with what the server depends on; None where it is well."""
        disk = self.folder.problem()
        return {"disk": disk, "database": disk or self.database.problem(), "workers": template_problem()}

    @property
    def open_count(self) -> int:
        """The number of open documents."""
        with self._lock:
            return len(self._open)

    def close(self) -> None:
        """Stop all work and close all documents."""
        self._closing.set()
        self._compiling.set()
        self.lanes.close()
        with self._lock:
            open_documents = tuple(self._open.values())
            self._open.clear()
        for opened in open_documents:
            opened.close()
        self.database.close()

    def _make_room(self) -> None:
        """Close the client's document that was unused for longest, if it has as many open as it may."""
        client = CLIENT.get()
        own = [opened for opened in self._open.values() if client and opened.opened_by == client]
        if len(own) < self._of_client_max:
            return
        oldest = max(own, key=lambda opened: opened.unused_s)
        if oldest.unused_s < _AT_REST_S:
            raise TooManyError(f"there are {len(own)} open documents of yours already", _ROOM_AFTER_S)
        del self._open[oldest.id]
        threading.Thread(target=oldest.close, name="closing", daemon=True).start()  # it may take a second

    def _open_as(self, document_id: str, kept: KeptDocument) -> OpenDocument:
        document = Document(
            kept.draft,
            version=kept.version,
            start=kept.start,
            keep=kept.keeper.keep,
            keep_start=kept.keeper.keep_start,
            reread=partial(self.documents.reread, kept.keeper),
        )
        self._open[document_id] = OpenDocument(document_id, document, self.lanes, self.plans)
        return self._open[document_id]

    def _look_after(self) -> None:
        while not self._closing.wait(_LOOK_EVERY_S):
            try:
                self.close_unused()
                if self.database.is_shared:
                    self.robots.refresh()
            except Exception:
                _log.exception("what nobody uses could not be closed, or robots not be followed")
