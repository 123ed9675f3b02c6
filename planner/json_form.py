"""The JSON form of a value, read and written by its type alone.

Every value is a frozen dataclass; pydantic derives from its annotations how it is written, and how strictly it is read:
unknown fields are refused by name, numbers are finite JSON numbers. So the form is defined where the value is. What
only the value itself can tell, its `__post_init__` refuses with a `FieldError`; the path to it is put before its field.
"""

from collections.abc import Callable, Hashable
from dataclasses import fields
from functools import cache
from numbers import Real
from typing import Annotated, Any, Generic, TypeVar, cast, get_args, get_origin, get_type_hints

from annotated_types import Interval
from pydantic import ConfigDict, GetCoreSchemaHandler, GetPydanticSchema, TypeAdapter, ValidationError
from pydantic_core import CoreSchema, PydanticSerializationError, PydanticUseDefault, core_schema, to_json

from planner.errors import FieldError, RequestError
from planner.strict_model import first_error

STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, json_schema_serialization_defaults_required=True)
"""The strictness of reading; the outermost value names it as its `__pydantic_config__`."""

T = TypeVar("T")


class JsonForm(Generic[T]):
    """Reads and writes the values of one type."""

    def __init__(self, kind: type[T], error: type[FieldError] = RequestError) -> None:
        """Derive the form of a type.

        Args:
            kind: the type; a dataclass names `STRICT` as its `__pydantic_config__`. A static method `completed` of it
                is given the JSON before that is read, and returns it with what it may leave out.
            error: raised for JSON that is no such value.
        """
        self._adapter: TypeAdapter[T] = TypeAdapter(kind)
        self._error = error
        self._completed: Callable[[object], object] = getattr(kind, "completed", lambda data: data)

    def write(self, value: T) -> Any:  # noqa: ANN401
        """Return a value as JSON."""
        return self._adapter.dump_python(value, mode="json")

    def read(self, data: object) -> T:
        """Return the value that JSON holds; raises the form's error, which names the field."""
        whole = self._completed(data)
        try:
            return self._adapter.validate_json(to_json(whole))
        except PydanticSerializationError:
            raise self._error("", "is nested too deeply, or has text that is no Unicode") from None
        except ValidationError as error:
            raise first_error(error, self._error, whole) from None


def require_intervals(value: Any, error: type[FieldError]) -> None:  # noqa: ANN401
    """Raise an error that names the first field of a dataclass that is outside its annotated `Interval`."""
    for name, interval in _intervals(cast("Hashable", type(value))):
        found = getattr(value, name)
        if found is None:
            continue
        if isinstance(found, bool) or not isinstance(found, Real):
            raise error(name, f"{found!r:.80} is no number")
        if not _is_within(found, interval):
            raise error(name, f"{found} is not {_said(interval)}")


@cache
def _intervals(kind: Any) -> tuple[tuple[str, Interval], ...]:  # noqa: ANN401
    """Return the fields of a dataclass that have an interval."""
    hints = get_type_hints(kind, include_extras=True)
    found = ((field.name, _interval(hints[field.name])) for field in fields(kind))
    return tuple((name, interval) for name, interval in found if interval is not None)


def _interval(hint: Any) -> Interval | None:  # noqa: ANN401
    if get_origin(hint) is Annotated:
        return next((one for one in get_args(hint)[1:] if isinstance(one, Interval)), None)
    return next((found for part in get_args(hint) if (found := _interval(part)) is not None), None)


def _is_within(value: Any, interval: Interval) -> bool:  # noqa: ANN401
    above = interval.gt < value if interval.ge is None else interval.ge <= value
    return bool(above and value <= interval.le)


def _said(interval: Interval) -> str:
    if interval.ge is None:
        return f"greater than {interval.gt:g} and at most {interval.le:g}"
    return f"between {interval.ge:g} and {interval.le:g}"


def _default_for_null(value: object) -> object:
    if value is None:
        raise PydanticUseDefault
    return value


def _or_null(source: Any, schema: GetCoreSchemaHandler) -> CoreSchema:  # noqa: ANN401
    """Return the schema that reads null as the default, and says so where reading is described."""
    given = schema(source)
    described = core_schema.nullable_schema(given)
    return core_schema.no_info_before_validator_function(_default_for_null, given, json_schema_input_schema=described)


NULL_IS_DEFAULT = GetPydanticSchema(_or_null)
"""Marks a field for which null counts as left out."""
