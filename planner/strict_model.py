"""JSON read strictly: unknown fields are refused by name, numbers are finite JSON numbers."""

from typing import Annotated, Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from planner.errors import FieldError

LARGEST_M = 10.0
"""No coordinate or other length in a file or request may be larger (m)."""

Bounded = Annotated[float, Field(ge=-LARGEST_M, le=LARGEST_M)]
Positive = Annotated[float, Field(gt=0.0, le=LARGEST_M)]
PlanePoint = Annotated[list[Bounded], Field(min_length=2, max_length=2)]

Error = TypeVar("Error", bound=FieldError)


class StrictModel(BaseModel):
    """A JSON object whose fields are all known and of exactly the type that they should be."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)


def field_path(location: tuple[int | str, ...]) -> str:
    """A pydantic location as a path: ``("outline", 3, 0)`` -> ``outline[3][0]``."""
    path = ""
    for part in location:
        path += f"[{part}]" if isinstance(part, int) else f".{part}" if path else str(part)
    return path


def first_error(error: ValidationError, kind: type[Error]) -> Error:
    """The first of pydantic's complaints as one of our errors."""
    detail = error.errors(include_url=False, include_context=False)[0]
    return kind(field_path(detail["loc"]), plain_message(dict(detail)))


def plain_message(detail: dict[str, Any]) -> str:
    """One of pydantic's complaints in words that name the offending value."""
    if detail["type"] in ("extra_forbidden", "unexpected_keyword_argument"):
        return "is not a known field"
    if detail["type"] == "missing":
        return "is missing"
    shown = repr(detail["input"])
    return f"{detail['msg']}, not {shown if len(shown) <= 80 else shown[:77] + '...'}"
