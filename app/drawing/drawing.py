"""The drawing: outline, folds whose ends are tied to the cloth, placement on the table, and scene.

A drawing may be invalid, e.g. its outline may cross itself or a fold may end off the cloth. It is still an ordinary
value; solving it (`app.drawing.solve`) finds its problems. Corners and folds have ids that stay the same while the
drawing changes, so that a tie keeps its corner when other corners are added or removed.

Its JSON form follows from its annotations (`app.drawing.drawing_json`).
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal, TypeAlias, TypeVar

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, GetPydanticSchema

from app.drawing.curve import Curve
from planner.cloth.fold_kinds import FOLD_KINDS, FoldName
from planner.cloth.garment import DEFAULT_THICKNESS_M, FOLDS_MAX, NAME_PATTERN, TITLE_MAX, Thickness
from planner.cloth.outline import POINTS_MAX
from planner.geometry.given import GivenPose, PlanePoint
from planner.geometry.pose import Point2
from planner.json_form import STRICT
from planner.strict_model import Positive
from planner.task.scene import Scene
from planner.task.task import COMFORT_MAX_M, DEFAULT_ROBOT

T = TypeVar("T")

_FORM = ConfigDict(**STRICT, serialize_by_alias=True)

_Id = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]{1,16}$")]
_Fraction = Annotated[float, Field(ge=0.0, le=1.0)]
_Title = Annotated[str, Field(max_length=TITLE_MAX)]
_Name = Annotated[str, Field(pattern=rf"^{NAME_PATTERN.pattern}$")]
_Kind = Annotated[str, GetPydanticSchema(lambda _, schema: schema(FoldName))]
_RobotName = Annotated[str, Field(pattern=rf"^{NAME_PATTERN.pattern}(@\S{{1,2000}})?$")]
"""A robot's name, and changes of its card (see `planner.robots.varied_card`)."""


def _whole(given: Any) -> Any:  # noqa: ANN401
    """Return a curve's JSON, whose handle is over the middle of the chord unless it says otherwise."""
    return {"along": 0.0, **given} if isinstance(given, dict) else given


def _if_bent(curve: Curve | None) -> Curve | None:
    return curve if curve is not None and (curve.along or curve.across) else None


def _may_lack_curve(schema: dict[str, Any]) -> None:
    """Describe the curve without its default: with one it would be taken for a field that is always sent."""
    schema["required"] = ["id", "point"]
    schema["properties"]["curve"].pop("default", None)


@dataclass(frozen=True, slots=True)
class Corner:
    """A corner of the outline.

    Attributes:
        id: the corner's id in this drawing.
        point: its position, garment frame (m).
        curve: the curve of the edge to the next corner; None where that is straight.
    """

    __pydantic_config__ = ConfigDict(**STRICT, json_schema_extra=_may_lack_curve)

    id: _Id
    point: PlanePoint
    curve: Annotated[
        Curve | None, BeforeValidator(_whole), AfterValidator(_if_bent), Field(exclude_if=lambda curve: curve is None)
    ] = None


@dataclass(frozen=True, slots=True)
class CornerTie:
    """A tie to a corner of the outline."""

    __pydantic_config__ = _FORM

    corner: Annotated[_Id, Field(alias="vertex")]
    kind: Literal["vertex"] = "vertex"


@dataclass(frozen=True, slots=True)
class EdgeTie:
    """A tie to the outline between two corners, at a fraction of the way along it from the first to the second.

    The corners are neighbours until a corner is inserted between them.
    """

    __pydantic_config__ = _FORM

    start: Annotated[_Id, Field(alias="from")]
    end: Annotated[_Id, Field(alias="to")]
    fraction: _Fraction
    kind: Literal["edge"] = "edge"


@dataclass(frozen=True, slots=True)
class CreaseTie:
    """A tie to the line of an earlier fold.

    Attributes:
        fold: the id of the earlier fold.
        fraction: the position along that fold's line, from its start.
        carried: the ids of the folds before it that had moved the layer in question.
    """

    __pydantic_config__ = STRICT

    fold: _Id
    fraction: _Fraction
    carried: Annotated[tuple[_Id, ...], Field(max_length=FOLDS_MAX)] = ()
    kind: Literal["crease"] = "crease"


@dataclass(frozen=True, slots=True)
class ChordTie:
    """No tie: the end is where the fold's line meets the boundary nearest to the end's point."""

    __pydantic_config__ = STRICT

    kind: Literal["chord"] = "chord"


Tie: TypeAlias = CornerTie | EdgeTie | CreaseTie | ChordTie


@dataclass(frozen=True, slots=True)
class End:
    """An end of a fold.

    Attributes:
        point: its position, garment frame, on the cloth as the fold finds it (m).
        tie: its tie; None for an end just drawn, or if no tie can be found.
    """

    __pydantic_config__ = _FORM

    point: PlanePoint
    tie: Annotated[Tie | None, Field(alias="on", discriminator="kind")] = None


@dataclass(frozen=True, slots=True)
class Crease:
    """A fold as drawn; the cloth to the left of start -> end moves.

    Attributes:
        id: the fold's id in this drawing.
        name: the user's name for the fold.
        kind: its kind, as `FOLD_KINDS` names it.
        start: the first end.
        end: the second end.
        grip_radius_m: the radius of cloth that one grip holds (m); None for the garment's.
        twin: the id of the fold that mirrors this one, if they are linked.
    """

    __pydantic_config__ = STRICT

    id: _Id
    name: _Title
    kind: _Kind
    start: End
    end: End
    grip_radius_m: Positive | None = None
    twin: _Id | None = None

    @property
    def is_red(self) -> bool:
        """Whether the fold takes only the layers that the previous fold moved."""
        return FOLD_KINDS[self.kind].is_red

    @property
    def ends(self) -> tuple[End, End]:
        """Both ends, start first."""
        return (self.start, self.end)


@dataclass(frozen=True, slots=True)
class Drawing:
    """A garment as drawn, with the conditions for folding it.

    Attributes:
        name: the garment's name, also its file's.
        title: the garment's displayed name.
        outline: the corners, with no limits on number or position.
        areal_density_kg_m2: the cloth's mass per area (kg/m2).
        grip_radius_m: the radius of cloth that one grip holds, unless a fold has its own (m).
        folds: the folds in the user's order.
        placement: the garment frame in the table frame.
        scene: table, stations and costs.
        start_station: the station at which the robot starts; may be missing from the scene.
        comfort_radius_m: the comfort radius (m).
        robot: the name of the robot that folds.
        thickness_m: the cloth's thickness where fingers press it (m).
    """

    __pydantic_config__ = STRICT

    name: _Name
    title: _Title
    outline: Annotated[tuple[Corner, ...], Field(max_length=POINTS_MAX)]
    areal_density_kg_m2: Positive
    grip_radius_m: Positive
    folds: Annotated[tuple[Crease, ...], Field(max_length=FOLDS_MAX)]
    placement: GivenPose
    scene: Scene
    start_station: _Title
    comfort_radius_m: Annotated[float, Field(ge=0.0, le=COMFORT_MAX_M)]
    robot: _RobotName = DEFAULT_ROBOT
    thickness_m: Thickness = DEFAULT_THICKNESS_M

    @property
    def points(self) -> tuple[Point2, ...]:
        """The positions of the outline's corners (m)."""
        return tuple(corner.point for corner in self.outline)

    def sharing(self, other: "Drawing") -> "Drawing":
        """Return an equal drawing that takes from another one the corners, folds and scene that are equal there.

        A history of steps, each of which changes little, takes a third of the memory.
        """
        return replace(
            self,
            outline=_shared(self.outline, other.outline),
            folds=_shared(self.folds, other.folds),
            placement=other.placement if other.placement == self.placement else self.placement,
            scene=other.scene if other.scene == self.scene else self.scene,
        )


def _shared(parts: tuple[T, ...], others: tuple[T, ...]) -> tuple[T, ...]:
    """Return the parts, those that are equal to one of the others as that object."""
    known = {other: other for other in others}
    return tuple(known.get(part, part) for part in parts)


def fresh_ids(prefix: str, taken: Iterable[str | None], count: int) -> list[str]:
    """Return `count` unused ids: the prefix followed by the smallest free numbers."""
    used = set(taken)
    found: list[str] = []
    number = 0
    while len(found) < count:
        if (name := f"{prefix}{number}") not in used:
            found.append(name)
        number += 1
    return found
