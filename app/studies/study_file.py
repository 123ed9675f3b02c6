"""A study as it is written down, in a TOML file or a request of JSON (docs/studies.md), and how it is read.

It is read strictly: every error names the field, and the file is named by who asked.
"""

import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, WithJsonSchema

from app.studies.axis import Axis, number_axis
from app.studies.cell import CARD, LIMITS, MIDDLE, MOVED, PLACEMENT, ROBOT, SCENE, START, TABLE
from app.studies.fields import StudyError, reported_at, require_known, table, text, truth, whole
from app.studies.garment_entries import Sources, read_garments
from app.studies.rehearsed import StudyRehearsal, read_rehearsal
from app.studies.study import Sample, Study
from planner.errors import FieldError
from planner.geometry.given import GivenPose
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.json_form import STRICT, JsonForm
from planner.robots.load_robot import load_robot, robot_card_file
from planner.robots.varied_card import changed
from planner.task.scene import Scene
from planner.task.task import DEFAULT_ROBOT, TIME_LIMIT_S, Limits

CELLS_MAX = 100_000
"""The most cells of a study that does not say `cells_max` itself."""

CELLS_LIMIT = 10_000_000
"""The largest `cells_max`."""

WORK_LIMIT_S = 10.0
"""The work for a cell by default, in seconds of a present-day machine; time is left for slower ones."""

_STATIONS = "stations"
_POSE = tuple(field.name for field in fields(Pose2))
_POSES: JsonForm[tuple[Pose2, ...]] = JsonForm(tuple[GivenPose, ...], StudyError)

_Text = Annotated[str, Field(json_schema_extra={"minLength": 1})]
_Names = Annotated[list[_Text], Field(json_schema_extra={"minItems": 1})]

_PLACEMENTS = {
    "anyOf": [
        {"const": "own"},
        {"type": "array", "minItems": 1, "items": {"type": "object", "required": list(_POSE)}},
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


@dataclass(frozen=True, slots=True)
class _Numbers:
    """A table of the file whose fields are numbers to vary: the axes' prefix, the known fields, how one is checked."""

    prefix: str
    known: tuple[str, ...]
    check: Callable[[str, Any], object]
    whole: tuple[str, ...] = ()

    def axes(self, field: str, given: Mapping[str, Any]) -> Iterator[Axis]:
        """Yield an axis for each field, every value checked on its own."""
        require_known(field, given, self.known)
        for name, value in given.items():
            axis = number_axis(f"{field}.{name}", value, whole=name in self.whole)
            for number in axis.values:
                with reported_at(field):
                    self.check(name, number)
            yield Axis(f"{self.prefix}{name}", axis.values)


def read_study(path: Path) -> Study:
    """Return the study in a file.

    Raises:
        StudyError: the file cannot be read, or a field is not valid.
    """
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise StudyError("", f"cannot be read: {error.strerror}") from None
    except (UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError) as error:
        raise StudyError("", f"is no TOML: {error}") from None
    return study_of(content, Sources(folder=path.parent))


def study_of(content: Mapping[str, Any], sources: Sources, cells_limit: int = CELLS_LIMIT) -> Study:
    """Return the study that a file's content describes.

    Args:
        content: the content.
        sources: where its garments come from.
        cells_limit: the largest `cells_max`.

    Raises:
        StudyError: a field is not valid, or there are more cells than `cells_max`.
    """
    require_known("", content, FIELDS)
    robots = content.get("robots", [DEFAULT_ROBOT])
    scene, axes = _scene(table("scene", content.get("scene", {})))
    poses, placed = _placements(content.get("placements", "own"))
    rehearsal, noise = _rehearsal(content)
    study = Study(
        text("title", content.get("title", "Study")),
        read_garments(content.get("garments"), sources),
        (
            _names(ROBOT, "robots", robots, load_robot),
            *_card(table("card", content.get("card", {})), robots),
            *_stations(content, scene),
            *_TABLE.axes("table", table("table", content.get("table", {}))),
            *axes,
            *placed,
            *_limits(table("limits", content.get("limits", {}))),
            *noise,
        ),
        scene,
        _STATIONS in content.get("scene", {}),
        poses,
        _sample(content),
        truth("comfort_margin", content.get("comfort_margin", False)),
        rehearsal,
    )
    most = whole("cells_max", content.get("cells_max", min(CELLS_MAX, cells_limit)), 1, cells_limit)
    runs = 1 if rehearsal is None else rehearsal.runs
    if study.count * runs > most:
        varied = [f"{len(axis.values)} {axis.name}" for axis in study.all_axes if len(axis.values) > 1]
        text_of = " x ".join([*varied, *([f"{runs} runs"] if runs > 1 else [])])
        raise StudyError(
            "cells_max",
            f"there are {study.count:,} cells{' to rehearse' if runs > 1 else ''} ({text_of}), more than {most:,}; "
            "draw some of them with [sample] cells = N, or allow more",
        )
    return study


def _names(axis: str, field: str, given: object, check: Callable[[str], object]) -> Axis:
    """Return the axis of a list of names, each of which a function knows."""
    if not isinstance(given, list):
        raise StudyError(field, f"{given!r} is no list of names")
    names = tuple(text(f"{field}[{number}]", name) for number, name in enumerate(given))
    for number, name in enumerate(names):
        try:
            check(name)
        except FieldError as error:
            raise StudyError(f"{field}[{number}]", error.message) from None
    return Axis(axis, names, is_ordered=False)


def _card(given: Mapping[str, Any], robots: Sequence[str]) -> Iterator[Axis]:
    """Yield an axis for each field of the robots' cards that varies, by its path; every robot must have it."""
    for path, value in _paths(given):
        axis = number_axis(f"card.{path}", value)
        for robot in robots:
            for number in axis.values:
                try:
                    robot_card_file(changed(str(robot), {path: number}))
                except FieldError as error:
                    raise StudyError(f"card.{path}", error.message) from None
        yield Axis(f"{CARD}{path}", axis.values)


def _paths(given: Mapping[str, Any], within: str = "") -> Iterator[tuple[str, Any]]:
    """Yield each field with its path; TOML reads a dotted key as tables in tables."""
    for name, value in given.items():
        if isinstance(value, dict) and "from" not in value:
            yield from _paths(value, f"{within}{name}.")
        else:
            yield f"{within}{name}", value


def _stations(content: Mapping[str, Any], scene: Scene) -> Iterator[Axis]:
    if "start_stations" in content:
        known = dict(scene.stations)

        def check(name: str) -> None:
            if name not in known:
                raise StudyError("", f"expected one of {', '.join(known)}; got {name!r}")

        yield _names(START, "start_stations", content["start_stations"], check)


def _scene(given: Mapping[str, Any]) -> tuple[Scene, tuple[Axis, ...]]:
    """Return the scene with the stations given, and an axis for each other field."""
    numbers = {name: value for name, value in given.items() if name != _STATIONS}
    stations = {_STATIONS: given[_STATIONS]} if _STATIONS in given else {}
    with reported_at("scene"):
        scene = Scene.from_dict(stations)
    return scene, tuple(_SCENE.axes("scene", numbers))


def _placements(given: object) -> tuple[tuple[Pose2, ...], tuple[Axis, ...]]:
    """Return the poses given, and the axes: of these, or of a grid of moves or of places."""
    if given == "own":
        return (), ()
    if isinstance(given, list):
        with reported_at("placements"):
            poses = _POSES.read(given)
        return poses, (Axis(PLACEMENT, tuple(range(len(poses))), is_ordered=False),)
    kinds = {"moved": MOVED, "middle": MIDDLE}
    found = table("placements", given)
    require_known("placements", found, kinds)
    if len(found) != 1:
        raise StudyError("placements", 'is "own", a list of poses, or one of moved and middle')
    name, grid = next(iter(found.items()))
    numbers = _Numbers(kinds[name], _POSE, lambda *_: None)
    return (), tuple(numbers.axes(f"placements.{name}", table(f"placements.{name}", grid)))


def _limits(given: Mapping[str, Any]) -> Iterator[Axis]:
    """Yield an axis for each limit; what is left out is limited by work, so that every machine has the same answer."""
    filled = {"work_limit_s": WORK_LIMIT_S, "time_limit_s": TIME_LIMIT_S[1], **given}
    heuristics = filled.pop("heuristic", None)
    yield from _LIMITS.axes("limits", filled)
    if heuristics is not None:
        listed = heuristics if isinstance(heuristics, list) else [heuristics]
        yield _names(f"{LIMITS}heuristic", "limits.heuristic", listed, lambda name: Limits(heuristic=name))  # type: ignore[arg-type]


def _rehearsal(content: Mapping[str, Any]) -> tuple[StudyRehearsal | None, tuple[Axis, ...]]:
    """Return how plans are rehearsed, if they are, and the axis of noise."""
    if "rehearsal" not in content:
        return None, ()
    found, noise = read_rehearsal(table("rehearsal", content["rehearsal"]))
    return found, (noise,)


def _sample(content: Mapping[str, Any]) -> Sample | None:
    if "sample" not in content:
        return None
    given = table("sample", content["sample"])
    require_known("sample", given, ("cells", "seed"))
    return Sample(
        whole("sample.cells", given.get("cells"), 1, CELLS_LIMIT), whole("sample.seed", given.get("seed", 0), 0, 2**53)
    )


def _numbers_of(kind: type, but: tuple[str, ...] = ()) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind) if field.name not in but)


_TABLE = _Numbers(TABLE, _numbers_of(Table), lambda name, number: Table(**{name: number}))
_SCENE = _Numbers(SCENE, _numbers_of(Scene, ("table", _STATIONS)), lambda name, number: Scene.from_dict({name: number}))
_LIMITS = _Numbers(
    LIMITS, _numbers_of(Limits, ("heuristic",)), lambda name, number: Limits(**{name: number}), whole=("max_expanded",)
)
