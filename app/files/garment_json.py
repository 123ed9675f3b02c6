"""Reads garment files and plan files, strictly."""

from dataclasses import replace
from typing import Any

from pydantic_core import from_json

from app.files.import_errors import ImportedFileError, broken
from planner.cloth.garment import Garment
from planner.message import Message
from planner.task.plan import Plan
from planner.task.plan_files import VERSION_FIELD


def read_garment_json(data: bytes) -> tuple[Garment, tuple[Message, ...]]:
    """Return the garment in a garment file or a plan file, and remarks on it.

    Raises:
        ImportedFileError: the file is not a JSON object, or one of another kind.
        GarmentError: the garment is invalid; the error names the field.
        RequestError: the plan is invalid; the error names the field.
    """
    try:
        values = from_json(data.removeprefix(b"\xef\xbb\xbf"), allow_inf_nan=False)
    except ValueError as error:
        raise broken(f"it is not JSON: {error}") from None
    if not isinstance(values, dict):
        raise broken("it is not a JSON object")
    _require_no_other_kind(values)
    if VERSION_FIELD in values:
        return _garment_of(Plan.from_dict(values))
    return Garment.from_dict(values), ()


def _require_no_other_kind(values: dict[str, Any]) -> None:
    """Raise `ImportedFileError` if a JSON object is a file of another kind, with what it is and what to do."""
    pattern = values.get("pattern")
    if isinstance(pattern, dict) and isinstance(pattern.get("panels"), dict):
        panels = list(pattern["panels"])
        text = (
            f"it is a pattern specification of GarmentCode, with {len(panels)} panels to be sewn together: import the "
            "SVG or DXF of one panel instead"
        )
        raise ImportedFileError("file", Message("pattern_specification", text, {"panels": len(panels)}))
    if "file_spec" in values or "vertices_coords" in values:
        text = "it is a crease pattern in the FOLD format, which is not read: import an SVG or DXF of it instead"
        raise ImportedFileError("file", Message("fold_file", text))
    if "pleat_robot" in values:
        text = "it is the card of a robot: import it as a zip with its URDF and its meshes"
        raise ImportedFileError("file", Message("robot_card_file", text))


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
