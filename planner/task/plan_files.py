"""Plan files (``*.plan.json``): a plan with its task and its trajectory, to be shown, exported or continued."""

import json
from pathlib import Path

from planner.cloth.garment import Garment
from planner.cloth.garment_files import load_garment, other_kind, read_json
from planner.errors import RequestError
from planner.task.plan import Plan

ENDING = ".plan.json"


def write_plan(plan: Plan, path: Path) -> None:
    """Write a plan file; raises `OSError`."""
    path.write_text(json.dumps(plan.to_dict()) + "\n", encoding="utf-8")


def read_plan(path: Path) -> Plan:
    """Return the plan in a file.

    Raises:
        GarmentFileError: the file is missing or no JSON.
        FieldError: the file is no plan file; names the field.
    """
    data = read_json(path)
    if not isinstance(data, dict):
        raise RequestError("", "a plan file holds one JSON object")
    return Plan.from_dict(data)


def load(source: str) -> Garment | Plan:
    """Return the shipped garment of a name, or the garment or the plan in a file; raises as `load_garment` does."""
    path = Path(source)
    if path.is_file():
        data = read_json(path)
        if isinstance(data, dict) and other_kind(data) == "plan":
            return Plan.from_dict(data)
    return load_garment(source)
