"""Makes a document's state from a garment or a plan without a document, for export."""

from dataclasses import replace

from app.document_state import DocumentState, VersionPlan
from app.drawing.draft import draft_of
from app.drawing.garment_drawing import drawing_of
from planner.cloth.garment import Garment
from planner.task.plan import Plan
from planner.task.task import Task


def state_of_garment(garment: Garment) -> DocumentState:
    """Return the state of a document with this garment and no plan."""
    return DocumentState(1, draft_of(drawing_of(garment)))


def state_of_plan(plan: Plan) -> DocumentState:
    """Return the state of a document with a plan's garment and the plan as its answer."""
    task: Task = plan.task
    drawing = replace(
        drawing_of(task.garment, task.scene),
        placement=task.start.placement,
        comfort_radius_m=task.limits.comfort_radius_m,
    )
    return DocumentState(1, draft_of(drawing), VersionPlan(1, task, plan, ""))
