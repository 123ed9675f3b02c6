"""Studies small enough to plan at once."""

from typing import Any

from app.studies.garment_entries import Sources
from app.studies.study import Study
from app.studies.study_file import study_of

HEIGHTS = [0.7, 0.75, 0.8, 0.85]


def content(**changes: Any) -> dict[str, Any]:
    """Return the content of a study's file: one small towel on tables of four heights."""
    towel = {"template": "towel", "measures": {"width_m": 0.3, "length_m": 0.2}}
    return {"garments": [towel], "table": {"height_m": HEIGHTS}, "limits": {"work_limit_s": 1.0}, **changes}


def study(**changes: Any) -> Study:
    return study_of(content(**changes), Sources())
