"""A document that is open: with its stage, its player and its planner."""

from dataclasses import dataclass

from app.document import Document
from app.job_pool import JobPool
from app.plan_store import PlanStore
from app.player import Player
from app.replanner import Replanner
from app.ui.stage import Stage
from planner.cloth.garment import Garment
from planner.errors import FoldingError
from planner.primitives.scene import Scene
from planner.robot.pr2 import load_robot

ROBOT = "pr2"


@dataclass
class UnknownDocumentError(FoldingError):
    """No open document has this name."""

    name: str

    def __str__(self) -> str:
        return f"there is no open document {self.name!r}"


@dataclass(frozen=True, slots=True)
class OpenDocument:
    """What belongs to an open document."""

    document: Document
    stage: Stage
    player: Player
    replanner: Replanner

    @staticmethod
    def open(garment: Garment, pool: JobPool, plans: PlanStore) -> "OpenDocument":
        """Open a document on a garment, with a stage of its own; its plan is being made when this returns."""
        scene = Scene()
        document = Document(garment, scene)
        stage = Stage(load_robot(ROBOT).card, scene)
        return OpenDocument(document, stage, Player(document, stage), Replanner(document, pool, plans))

    def close(self) -> None:
        """End all that."""
        self.replanner.close()
        self.player.close()
        self.stage.close()
