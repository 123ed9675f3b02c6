"""Read JSON strictly: refuse unknown fields by name, and accept only finite JSON numbers."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from planner.errors import FieldError

LARGEST_M = 10.0
"""The largest coordinate or other length in a file or request (m)."""

Bounded = Annotated[float, Field(ge=-LARGEST_M, le=LARGEST_M)]
"""The type of a coordinate (m)."""

Positive = Annotated[float, Field(gt=0.0, le=LARGEST_M)]
"""The type of a length above zero (m)."""


class StrictModel(BaseModel):
    """A JSON object whose fields are all known and of exactly the declared types."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)


def field_path(location: tuple[int | str, ...]) -> str:
    """Return a pydantic location as a path: ``("outline", 3, 0)`` -> ``outline[3][0]``."""
    path = ""
    for part in location:
        path += f"[{part}]" if isinstance(part, int) else f".{part}" if path else str(part)
    return path


def first_error(error: ValidationError, kind: type[FieldError]) -> FieldError:
    """Return the first of pydantic's errors as one of our own.

    Errors of type come before errors that a value raised itself; those are kept as they are.
    """
    details = [one for one in error.errors(include_url=False) if one["type"] != "default_factory_not_called"]
    detail = next((one for one in details if _told(one) is None), details[0])
    path, told = field_path(detail["loc"]), _told(detail)
    return kind(path, plain_message(dict(detail))) if told is None else told.within(path)


def _told(detail: Mapping[str, Any]) -> FieldError | None:
    """Return the error that a value raised itself; None if it raised none."""
    found = detail.get("ctx", {}).get("error")
    return found if isinstance(found, FieldError) else None


def plain_message(detail: dict[str, Any]) -> str:
    """Return one of pydantic's errors in words that name the offending value."""
    if detail["type"] in ("extra_forbidden", "unexpected_keyword_argument"):
        return "is not a known field"
    if detail["type"] == "missing":
        return "is missing"
    shown = repr(detail["input"])
    text = detail["msg"].replace("valid array", "valid list").replace("valid tuple", "valid list")
    return f"{text}, not {shown if len(shown) <= 80 else shown[:77] + '...'}"
