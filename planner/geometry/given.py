"""Points and poses as people give them in files and requests, with bounded numbers."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Annotated, Any, TypeVar

from pydantic import BeforeValidator, Field, GetCoreSchemaHandler, GetPydanticSchema, PlainSerializer
from pydantic_core import CoreSchema, PydanticKnownError, core_schema

from planner.geometry.pose import Pose2
from planner.strict_model import Bounded

T = TypeVar("T")


def _pair(value: object) -> object:
    """Return a list of two as a tuple; refuse any other length for the list as a whole, not for its members."""
    if not isinstance(value, list):
        return value
    count = {"field_type": "List", "actual_length": len(value)}
    if len(value) < 2:
        raise PydanticKnownError("too_short", {**count, "min_length": 2})
    if len(value) > 2:
        raise PydanticKnownError("too_long", {**count, "max_length": 2})
    return tuple(value)


PlanePoint = Annotated[tuple[Bounded, Bounded], BeforeValidator(_pair)]
"""A point of the plane (m)."""


_STRICT = core_schema.CoreConfig(strict=True, allow_inf_nan=False)
"""The strictness of a pose's numbers; a typed dictionary inherits none from the value that contains it."""


def _bounded(source: Any, schema: GetCoreSchemaHandler) -> CoreSchema:  # noqa: ANN401
    """Return the schema that reads a dataclass with all its numbers bounded; writing stays as it is."""
    number = schema(Bounded)
    members = {field.name: core_schema.typed_dict_field(number) for field in fields(source)}
    return core_schema.no_info_after_validator_function(
        lambda given: source(**given),
        core_schema.typed_dict_schema(members, extra_behavior="forbid", config=_STRICT),
        serialization=core_schema.plain_serializer_function_ser_schema(
            lambda value: value, return_schema=schema(source)
        ),
    )


GivenPose = Annotated[Pose2, GetPydanticSchema(_bounded)]
"""A pose (m, rad)."""


def _as_object(described: dict[str, Any]) -> None:
    """Describe a default as the object that it is in JSON; pydantic would describe the pairs."""
    if "default" in described:
        described["default"] = dict(described["default"])


_OBJECT_DEFAULT = Field(json_schema_extra=_as_object)


def _pairs(named: Mapping[str, T]) -> tuple[tuple[str, T], ...]:
    return tuple(named.items())


NamedPoses = Annotated[
    tuple[tuple[str, Pose2], ...],
    GetPydanticSchema(
        lambda _, schema: core_schema.no_info_after_validator_function(_pairs, schema(dict[str, GivenPose]))
    ),
    PlainSerializer(dict, return_type=dict[str, Pose2]),
    _OBJECT_DEFAULT,
]
"""Poses by name, in order; in JSON one object."""

NamedNumbers = Annotated[
    tuple[tuple[str, float], ...],
    GetPydanticSchema(lambda _, schema: core_schema.no_info_after_validator_function(_pairs, schema(dict[str, float]))),
    PlainSerializer(dict, return_type=dict[str, float]),
    _OBJECT_DEFAULT,
]
"""Numbers by name, in order; in JSON one object."""
