"""Reads JSON files: garments and plans, strictly, patterns of GarmentCode, and crease patterns."""

from dataclasses import replace

from pydantic_core import from_json

from app.files.crease_pattern import is_crease_pattern, read_fold
from app.files.import_errors import ImportedFileError, broken
from app.files.pattern_panels import is_pattern_specification, read_panels
from app.files.sketch import Sketch
from planner.cloth.garment import Garment
from planner.message import Message
from planner.task.plan import Plan
from planner.task.plan_files import VERSION_FIELD


def read_json(data: bytes) -> tuple[Garment, tuple[Message, ...]] | Sketch:
    """Return the garment in a garment file or a plan file, and remarks on it; of a pattern the drawing.

    Raises:
        ImportedFileError: the file is not a JSON object, one of another kind, or a pattern that is not valid.
        GarmentError: the garment is invalid; the error names the field.
        RequestError: the plan is invalid; the error names the field.
    """
    try:
        values = from_json(data.removeprefix(b"\xef\xbb\xbf"), allow_inf_nan=False)
    except ValueError as error:
        raise broken(f"it is not JSON: {error}") from None
    if not isinstance(values, dict):
        raise broken("it is not a JSON object")
    if is_pattern_specification(values):
        return read_panels(values)
    if is_crease_pattern(values):
        return read_fold(values)
    if "pleat_robot" in values:
        text = "it is the card of a robot: import it as a zip with its URDF and its meshes"
        raise ImportedFileError("file", Message("robot_card_file", text))
    if VERSION_FIELD in values:
        return _garment_of(Plan.from_dict(values))
    return Garment.from_dict(values), ()


def _garment_of(plan: Plan) -> tuple[Garment, tuple[Message, ...]]:
    """Return the garment of a plan, placed as at the plan's start, and a note that says so."""
    done = len(plan.task.start.folds_done)
    from_middle = f" after {done} of its folds" if done else ""
    text = (
        f"the file is a plan{from_middle}: its garment was taken, where it lies at the plan's start, "
        "and is planned anew with this document's table, stations and costs"
    )
    note = Message("garment_of_plan", text, {"folds_done": done})
    return replace(plan.task.garment, placement=plan.task.start.placement), (note,)
