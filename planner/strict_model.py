"""Read JSON strictly: refuse unknown fields by name, and accept only finite JSON numbers."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, cast

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


def first_error(error: ValidationError, kind: type[FieldError], data: object = None) -> FieldError:
    """Return the first of pydantic's errors as one of our own.

    Errors of type come before errors that a value raised itself; those are kept as they are.

    Args:
        error: the errors.
        kind: the type of the error returned.
        data: what was read; without it the field's path has the names of variants of unions in it.
    """
    details = [one for one in error.errors(include_url=False) if one["type"] != "default_factory_not_called"]
    detail = next((one for one in details if _raised(one) is None), details[0])
    place = detail["loc"] if data is None else _in_data(detail["loc"], data, is_missing=detail["type"] == "missing")
    path, raised = field_path((*place, *_tag(detail))), _raised(detail)
    return kind(path, plain_message(dict(detail))) if raised is None else raised.within(path)


def _in_data(location: tuple[int | str, ...], data: object, *, is_missing: bool) -> tuple[int | str, ...]:
    """Return a pydantic location without the names of variants of unions, which are not fields of the data."""
    found: list[int | str] = []
    for part in location[:-1] if is_missing else location:
        is_key = isinstance(data, Mapping) and part in data
        if is_key or (isinstance(part, int) and isinstance(data, Sequence)):
            found.append(part)
            data = cast("Any", data)[part]
    return (*found, location[-1]) if is_missing else tuple(found)


def _tag(detail: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the field that tells the variants of a union apart, if it is to blame."""
    return (detail["ctx"]["discriminator"].strip("'"),) if detail["type"].startswith("union_tag_") else ()


def _raised(detail: Mapping[str, Any]) -> FieldError | None:
    """Return the error that a value's own validation raised, if any."""
    found = detail.get("ctx", {}).get("error")
    return found if isinstance(found, FieldError) else None


def plain_message(detail: dict[str, Any]) -> str:
    """Return one of pydantic's errors in words that name the offending value."""
    if detail["type"] in ("extra_forbidden", "unexpected_keyword_argument"):
        return "is not a known field"
    if detail["type"] in ("missing", "union_tag_not_found"):
        return "is missing"
    if detail["type"] == "union_tag_invalid":
        return f"expected one of {detail['ctx']['expected_tags']}; got {detail['ctx']['tag'][:80]!r}"
    shown = repr(detail["input"])
    text = detail["msg"].replace("valid array", "valid list").replace("valid tuple", "valid list")
    return f"{text}, not {shown if len(shown) <= 80 else shown[:77] + '...'}"
