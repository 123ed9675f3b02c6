"""The fields of a study: the same in its TOML file and in a request of JSON (docs/studies.md)."""

from dataclasses import dataclass, fields
from typing import Annotated, Any

from pydantic import Field, WithJsonSchema

from planner.geometry.pose import Pose2
from planner.json_form import STRICT

_Text = Annotated[str, Field(json_schema_extra={"minLength": 1})]
_Names = Annotated[list[_Text], Field(json_schema_extra={"minItems": 1})]

_POSE = {"type": "object", "required": [field.name for field in fields(Pose2)]}
_PLACEMENTS = {
    "anyOf": [
        {"const": "own"},
        {"type": "array", "minItems": 1, "items": _POSE},
        {"type": "object", "oneOf": [{"required": ["moved"]}, {"required": ["middle"]}]},
    ]
}
_ENTRY = {"type": "object", "oneOf": [{"required": [kind]} for kind in ("name", "garment", "template", "random")]}


@dataclass(frozen=True, slots=True)
class StudyFields:
    """A study as it is written down; null and left out are the same.

    `app.studies.study_file` reads what is in the fields. In a request garments are named or drawn, not read from files.
    """

    __pydantic_config__ = STRICT

    garments: Annotated[list[dict[str, Any]], Field(json_schema_extra={"minItems": 1, "items": _ENTRY})]
    title: _Text | None = None
    robots: _Names | None = None
    card: dict[str, Any] | None = None
    start_stations: _Names | None = None
    table: dict[str, Any] | None = None
    scene: dict[str, Any] | None = None
    placements: Annotated[str | list[Any] | dict[str, Any], WithJsonSchema(_PLACEMENTS)] | None = None
    limits: dict[str, Any] | None = None
    sample: dict[str, Any] | None = None
    comfort_margin: bool | None = None
    rehearsal: dict[str, Any] | None = None
    cells_max: Annotated[int, Field(json_schema_extra={"minimum": 1})] | None = None

    @property
    def content(self) -> dict[str, Any]:
        """The fields that are given, by name, as a file has them."""
        given = {name: getattr(self, name) for name in FIELDS}
        return {name: value for name, value in given.items() if value is not None}


FIELDS = tuple(field.name for field in fields(StudyFields))
"""The names of all fields."""
