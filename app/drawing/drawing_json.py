"""Reads and writes a drawing as JSON: reads strictly, writes every field.

Reading accepts anything that a person can draw, however wrong: solving finds its problems. It refuses unknown fields,
numbers out of bounds and duplicate ids.
"""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError

from app.drawing.curve import CURVE_MAX, Curve
from app.drawing.drawing import (
    ChordTie,
    Corner,
    CornerTie,
    Crease,
    CreaseTie,
    Drawing,
    EdgeTie,
    End,
    Tie,
    fresh_ids,
)
from planner.cloth.fold_kinds import FoldName
from planner.cloth.garment import DEFAULT_THICKNESS_M, FOLDS_MAX, NAME_PATTERN, TITLE_MAX, Thickness
from planner.cloth.outline import POINTS_MAX
from planner.errors import FieldError, RequestError
from planner.geometry.given import GivenPose, PlanePoint
from planner.strict_model import Positive, StrictModel, first_error
from planner.task.scene import Scene
from planner.task.task import COMFORT_MAX_M, DEFAULT_ROBOT

Id = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]{1,16}$")]
Fraction = Annotated[float, Field(ge=0.0, le=1.0)]
ChordPart = Annotated[float, Field(ge=-CURVE_MAX, le=CURVE_MAX)]
Title = Annotated[str, Field(max_length=TITLE_MAX)]
Name = Annotated[str, Field(pattern=rf"^{NAME_PATTERN.pattern}$")]
RobotName = Annotated[str, Field(pattern=rf"^{NAME_PATTERN.pattern}(@\S{{1,2000}})?$")]
"""A robot's name, and changes of its card (see `planner.robots.varied_card`)."""


class CornerTieModel(StrictModel):
    """A tie to a corner."""

    kind: Literal["vertex"]
    vertex: Id

    def value(self) -> Tie:
        """Return the tie."""
        return CornerTie(self.vertex)


class EdgeTieModel(StrictModel):
    """A tie to a fraction of the way along the outline from one corner to another."""

    kind: Literal["edge"]
    start: Id = Field(alias="from")
    end: Id = Field(alias="to")
    fraction: Fraction

    def value(self) -> Tie:
        """Return the tie."""
        return EdgeTie(self.start, self.end, self.fraction)


class CreaseTieModel(StrictModel):
    """A tie to a fraction of an earlier fold's line, in the layer that the folds in `carried` had moved."""

    kind: Literal["crease"]
    fold: Id
    fraction: Fraction
    carried: Annotated[list[Id], Field(max_length=FOLDS_MAX)] = Field(default_factory=list)

    def value(self) -> Tie:
        """Return the tie."""
        return CreaseTie(self.fold, self.fraction, tuple(self.carried))


class ChordTieModel(StrictModel):
    """No tie: the end is where the fold's line meets the boundary."""

    kind: Literal["chord"]

    def value(self) -> Tie:
        """Return the tie."""
        return ChordTie()


class EndModel(StrictModel):
    """An end of a fold: its position (m) and its tie; solving looks for a missing tie."""

    point: PlanePoint
    on: Annotated[
        CornerTieModel | EdgeTieModel | CreaseTieModel | ChordTieModel | None, Field(discriminator="kind")
    ] = None

    def value(self) -> End:
        """Return the end."""
        return End(self.point, None if self.on is None else self.on.value())


class CurveModel(StrictModel):
    """The curve of an edge: its middle as seen from the middle of the chord (chord lengths), `across` to the left."""

    along: ChordPart = 0.0
    across: ChordPart

    def value(self) -> Curve | None:
        """Return the curve; None where it is straight."""
        return Curve(self.along, self.across) if self.along or self.across else None


class CornerModel(StrictModel):
    """A corner of the outline (m), and the curve of the edge to the next one; reading assigns a missing id."""

    id: Id | None = None
    point: PlanePoint
    curve: CurveModel | None = None

    def value(self, name: str) -> Corner:
        """Return the corner with an id."""
        return Corner(name, self.point, None if self.curve is None else self.curve.value())


class CreaseModel(StrictModel):
    """A fold; reading assigns a missing id."""

    id: Id | None = None
    name: Title = ""
    kind: FoldName
    start: EndModel
    end: EndModel
    grip_radius_m: Positive | None = None
    twin: Id | None = None


class DrawingModel(StrictModel):
    """A drawing."""

    name: Name
    title: Title
    outline: Annotated[list[CornerModel], Field(max_length=POINTS_MAX)]
    areal_density_kg_m2: Positive
    grip_radius_m: Positive
    folds: Annotated[list[CreaseModel], Field(max_length=FOLDS_MAX)]
    placement: GivenPose
    scene: dict[str, Any]
    start_station: Annotated[str, Field(max_length=TITLE_MAX)]
    comfort_radius_m: Annotated[float, Field(ge=0.0, le=COMFORT_MAX_M)]
    robot: RobotName = DEFAULT_ROBOT
    thickness_m: Thickness = DEFAULT_THICKNESS_M

    def value(self) -> Drawing:
        """Return the drawing; raise `FieldError` for duplicate ids or an invalid scene."""
        corners = _named("outline", "v", [corner.id for corner in self.outline])
        names = _named("folds", "f", [fold.id for fold in self.folds])
        return Drawing(
            self.name,
            self.title,
            tuple(corner.value(name) for name, corner in zip(corners, self.outline, strict=True)),
            self.areal_density_kg_m2,
            self.grip_radius_m,
            tuple(_crease(name, fold, names) for name, fold in zip(names, self.folds, strict=True)),
            self.placement,
            _scene(self.scene),
            self.start_station,
            self.comfort_radius_m,
            self.robot,
            self.thickness_m,
        )


def drawing_from_dict(data: Mapping[str, Any]) -> Drawing:
    """Return the drawing read from JSON; raise `FieldError` naming the field."""
    try:
        return DrawingModel.model_validate(data).value()
    except ValidationError as error:
        raise first_error(error, RequestError, data) from None


def drawing_to_dict(drawing: Drawing) -> dict[str, Any]:
    """Return the drawing as JSON, with every field filled in; a straight edge has no curve."""
    return {
        "name": drawing.name,
        "title": drawing.title,
        "outline": [_corner_to_dict(corner) for corner in drawing.outline],
        "areal_density_kg_m2": drawing.areal_density_kg_m2,
        "thickness_m": drawing.thickness_m,
        "grip_radius_m": drawing.grip_radius_m,
        "folds": [_crease_to_dict(fold) for fold in drawing.folds],
        "placement": drawing.placement.to_dict(),
        "scene": drawing.scene.to_dict(),
        "start_station": drawing.start_station,
        "comfort_radius_m": drawing.comfort_radius_m,
        "robot": drawing.robot,
    }


def end_to_dict(end: End) -> dict[str, Any]:
    """Return the end as JSON."""
    return {"point": list(end.point), "on": None if end.tie is None else _tie_to_dict(end.tie)}


def _tie_to_dict(tie: Tie) -> dict[str, Any]:
    match tie:
        case CornerTie(corner):
            return {"kind": "vertex", "vertex": corner}
        case EdgeTie(start, end, fraction):
            return {"kind": "edge", "from": start, "to": end, "fraction": fraction}
        case CreaseTie(fold, fraction, carried):
            return {"kind": "crease", "fold": fold, "fraction": fraction, "carried": list(carried)}
        case ChordTie():
            return {"kind": "chord"}


def _corner_to_dict(corner: Corner) -> dict[str, Any]:
    plain = {"id": corner.id, "point": list(corner.point)}
    if corner.curve is None:
        return plain
    return {**plain, "curve": {"along": corner.curve.along, "across": corner.curve.across}}


def _crease_to_dict(fold: Crease) -> dict[str, Any]:
    return {
        "id": fold.id,
        "name": fold.name,
        "kind": fold.kind,
        "start": end_to_dict(fold.start),
        "end": end_to_dict(fold.end),
        "grip_radius_m": fold.grip_radius_m,
        "twin": fold.twin,
    }


def _crease(name: str, fold: CreaseModel, names: Sequence[str]) -> Crease:
    twin = fold.twin if fold.twin in names and fold.twin != name else None
    return Crease(name, fold.name, fold.kind, fold.start.value(), fold.end.value(), fold.grip_radius_m, twin)


def _named(field: str, prefix: str, given: Sequence[str | None]) -> list[str]:
    """Return the given ids, with new ones for those missing; raise `RequestError` for duplicates."""
    known = [name for name in given if name is not None]
    for index, name in enumerate(given):
        if name is not None and name in given[:index]:
            raise RequestError(f"{field}[{index}].id", f"{name!r} is the id of another one too")
    fresh = iter(fresh_ids(prefix, known, len(given) - len(known)))
    return [next(fresh) if name is None else name for name in given]


def _scene(data: dict[str, Any]) -> Scene:
    try:
        return Scene.from_dict(data)
    except FieldError as error:
        raise error.within("scene") from None
