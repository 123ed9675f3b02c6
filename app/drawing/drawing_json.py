"""Reads and writes a drawing as JSON: reads strictly, writes every field; a straight edge has no curve.

Reading accepts anything that a person can draw, however wrong: solving finds its problems. It refuses unknown fields,
numbers out of bounds and duplicate ids. Ids of corners and folds may be missing, and folds' names.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from app.drawing.drawing import Drawing, End, fresh_ids
from planner.errors import RequestError
from planner.json_form import JsonForm

_DRAWINGS, _ENDS = JsonForm(Drawing), JsonForm(End)


def drawing_from_dict(data: Mapping[str, Any]) -> Drawing:
    """Return the drawing read from JSON; raise `FieldError` naming the field."""
    drawing = _DRAWINGS.read({**data, **_named(data, "outline", "v", {}), **_named(data, "folds", "f", {"name": ""})})
    corners, folds = [corner.id for corner in drawing.outline], [fold.id for fold in drawing.folds]
    for field, ids in (("outline", corners), ("folds", folds)):
        for index, name in enumerate(ids):
            if name in ids[:index]:
                raise RequestError(f"{field}[{index}].id", f"{name!r} is the id of another one too")
    twins = [fold.twin if fold.twin in folds and fold.twin != fold.id else None for fold in drawing.folds]
    return replace(
        drawing, folds=tuple(replace(fold, twin=twin) for fold, twin in zip(drawing.folds, twins, strict=True))
    )


def drawing_to_dict(drawing: Drawing) -> dict[str, Any]:
    """Return the drawing as JSON, with every field filled in; a straight edge has no curve."""
    written: dict[str, Any] = _DRAWINGS.write(drawing)
    return written


def end_to_dict(end: End) -> dict[str, Any]:
    """Return the end as JSON."""
    written: dict[str, Any] = _ENDS.write(end)
    return written


def _named(data: Mapping[str, Any], field: str, prefix: str, defaults: Mapping[str, Any]) -> dict[str, Any]:
    """Return the field of a drawing's JSON in which each part has an id, and the defaults."""
    if not isinstance(parts := data.get(field), list):
        return {}
    filled = [{**defaults, **part} if isinstance(part, dict) else part for part in parts]
    lacking = [part for part in filled if isinstance(part, dict) and part.get("id") is None]
    known = [part["id"] for part in filled if isinstance(part, dict) and isinstance(part.get("id"), str)]
    for part, name in zip(lacking, fresh_ids(prefix, known, len(lacking)), strict=True):
        part["id"] = name
    return {field: filled}
