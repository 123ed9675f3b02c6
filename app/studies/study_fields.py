"""The fields of a study: the same in its TOML file and in a request of JSON (docs/studies.md)."""

from dataclasses import dataclass, fields
from typing import Any

from planner.json_form import STRICT


@dataclass(frozen=True, slots=True)
class StudyFields:
    """A study as it is written down; null and left out are the same.

    `app.studies.study_file` reads what is in the fields. In a request garments are named or drawn, not read from files.
    """

    __pydantic_config__ = STRICT

    garments: list[dict[str, Any]]
    title: str | None = None
    robots: list[str] | None = None
    card: dict[str, Any] | None = None
    start_stations: list[str] | None = None
    table: dict[str, Any] | None = None
    scene: dict[str, Any] | None = None
    placements: str | list[Any] | dict[str, Any] | None = None
    limits: dict[str, Any] | None = None
    sample: dict[str, Any] | None = None
    comfort_margin: bool | None = None
    rehearsal: dict[str, Any] | None = None
    cells_max: int | None = None

    @property
    def content(self) -> dict[str, Any]:
        """The fields that are given, by name, as a file has them."""
        given = {name: getattr(self, name) for name in FIELDS}
        return {name: value for name, value in given.items() if value is not None}


FIELDS = tuple(field.name for field in fields(StudyFields))
"""The names of all fields."""
