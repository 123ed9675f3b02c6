"""All that the server holds while it runs: garments, plans, searches, open documents."""

from app.garment_shelf import GarmentShelf
from app.job_pool import JobPool
from app.open_document import OpenDocument, UnknownDocumentError
from app.plan_store import PlanStore
from app.settings import Settings

FIRST_DOCUMENT = "main"
FIRST_GARMENT = "t-shirt"


class Workspace:
    """One for each server.

    Attributes:
        garments: the garments that can be asked for by name.
        plans: the plans made so far.
        pool: where searches run.
    """

    def __init__(self, settings: Settings) -> None:
        """Nothing is open yet."""
        self.garments = GarmentShelf(settings.data / "garments")
        self.plans = PlanStore()
        self.pool = JobPool()
        self._open: dict[str, OpenDocument] = {}

    def open_first(self) -> None:
        """Open the document that the page shows."""
        garment = self.garments.garment(FIRST_GARMENT)
        self._open[FIRST_DOCUMENT] = OpenDocument.open(garment, self.pool, self.plans)

    def opened(self, name: str) -> OpenDocument:
        """An open document; raises `UnknownDocumentError`."""
        if name not in self._open:
            raise UnknownDocumentError(name)
        return self._open[name]

    def close(self) -> None:
        """Stop every search and close every document."""
        self.pool.close()
        for opened in self._open.values():
            opened.close()
        self._open.clear()
