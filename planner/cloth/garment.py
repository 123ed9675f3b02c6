"""A garment as it is drawn: an outline, what it weighs, the folds that are wanted, where it lies."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import Field, ValidationError

from planner.cloth.outline import EDGE_MIN_M, require_simple_outline
from planner.errors import GarmentError
from planner.geometry.pose import Point2, Pose2
from planner.geometry.region import Region
from planner.message import Message
from planner.strict_model import LARGEST_M, Bounded, PlanePoint, Positive, StrictModel, first_error

NAME_PATTERN = re.compile(r"[a-z0-9][a-z0-9-]{0,62}")
TITLE_MAX = 200
FOLDS_MAX = 64
DEFAULT_DENSITY_KG_M2 = 0.2
DEFAULT_GRIP_RADIUS_M = 0.127
DEFAULT_YAW_RAD = -math.pi / 2


@dataclass(frozen=True, slots=True)
class DrawnFold:
    """A fold as the user draws it: a directed line; what lies to its left is folded over it.

    Attributes:
        name: what the user calls it.
        kind: "blue" folds every layer, "red" only those that the fold before it moved.
        start: first end in the article frame (m), on the boundary of the silhouette as it is then.
        end: second end (m).
        grip_radius_m: how far round itself one grip holds the cloth (m).
    """

    name: str
    kind: str
    start: Point2
    end: Point2
    grip_radius_m: float = DEFAULT_GRIP_RADIUS_M

    def __post_init__(self) -> None:
        """Refuse what is no fold; raises `GarmentError`."""
        if self.kind not in ("blue", "red"):
            raise GarmentError("kind", f"{self.kind!r} is neither 'blue' nor 'red'")
        if len(self.name) > TITLE_MAX:
            raise GarmentError("name", f"has {len(self.name)} characters, more than {TITLE_MAX}")
        length = math.dist(self.start, self.end)
        if length < EDGE_MIN_M:
            text = f"the line is {length * 1000:.3f} mm long, less than {EDGE_MIN_M * 1000:g} mm"
            values = {"length_m": length, "least_m": EDGE_MIN_M}
            raise GarmentError("end", Message("line_too_short", text, values))
        _require_positive("grip_radius_m", self.grip_radius_m)

    @property
    def is_red(self) -> bool:
        """Whether it folds only the layers that the fold before it moved."""
        return self.kind == "red"

    def to_dict(self) -> dict[str, Any]:
        """The fold as it stands in a garment file."""
        return {
            "name": self.name,
            "kind": self.kind,
            "start": list(self.start),
            "end": list(self.end),
            "grip_radius_m": self.grip_radius_m,
        }


@dataclass(frozen=True, slots=True)
class Garment:
    """A garment, its folds in the user's order, and where it lies at the start.

    Attributes:
        name: its name, also the file's.
        title: what people call it.
        outline: the pattern's corners in the article frame (m), the first not repeated.
        areal_density_kg_m2: the cloth's mass per area.
        folds: the wanted folds in the user's order.
        grip_radius_m: how far round itself one grip holds the cloth, unless a fold says otherwise (m).
        placement: the article frame in the table frame.
    """

    name: str
    title: str
    outline: tuple[Point2, ...]
    areal_density_kg_m2: float
    folds: tuple[DrawnFold, ...]
    grip_radius_m: float
    placement: Pose2

    def __post_init__(self) -> None:
        """Refuse what is no garment; raises `GarmentError` naming the field and the number."""
        if not NAME_PATTERN.fullmatch(self.name):
            raise GarmentError("name", f"{self.name!r} does not match {NAME_PATTERN.pattern}")
        if len(self.title) > TITLE_MAX:
            raise GarmentError("title", f"has {len(self.title)} characters, more than {TITLE_MAX}")
        require_simple_outline(self.outline)
        _require_positive("areal_density_kg_m2", self.areal_density_kg_m2)
        _require_positive("grip_radius_m", self.grip_radius_m)
        if len(self.folds) > FOLDS_MAX:
            raise GarmentError("folds", f"there are {len(self.folds)} folds, more than {FOLDS_MAX}")
        if self.folds and self.folds[0].is_red:
            raise GarmentError("folds[0].kind", "the first fold cannot be red: no fold comes before it")

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> "Garment":
        """A garment from the contents of a garment file, defaults filled in.

        Raises:
            GarmentError: names the field, and says what is wrong with which number.
        """
        try:
            drawing = _GarmentModel.model_validate(data)
        except ValidationError as error:
            raise first_error(error, GarmentError) from None
        return drawing.to_garment()

    def to_dict(self) -> dict[str, Any]:
        """The contents of a garment file, every field filled in."""
        return {
            "name": self.name,
            "title": self.title,
            "outline": [list(p) for p in self.outline],
            "areal_density_kg_m2": self.areal_density_kg_m2,
            "folds": [f.to_dict() for f in self.folds],
            "grip_radius_m": self.grip_radius_m,
            "placement": self.placement.to_dict(),
        }

    @property
    def pattern(self) -> Region:
        """The cloth spread out, in the article frame."""
        return Region.polygon(self.outline)


def centred_placement(outline: tuple[Point2, ...]) -> Pose2:
    """The placement that puts the outline's bounding box on the middle of the table, top away."""
    xs, ys = [x for x, _ in outline], [y for _, y in outline]
    middle_x, middle_y = (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2
    return Pose2(-middle_y, middle_x, DEFAULT_YAW_RAD)


def _require_positive(field: str, value: float) -> None:
    if not 0.0 < value <= LARGEST_M:
        raise GarmentError(field, f"{value} is not greater than 0 and at most {LARGEST_M:g}")


class _FoldModel(StrictModel):
    name: str
    kind: str
    start: PlanePoint
    end: PlanePoint
    grip_radius_m: Positive | None = None


class _PlacementModel(StrictModel):
    x_m: Bounded
    y_m: Bounded
    yaw_rad: Bounded


class _GarmentModel(StrictModel):
    name: str
    title: str | None = None
    outline: list[PlanePoint]
    areal_density_kg_m2: Positive = DEFAULT_DENSITY_KG_M2
    folds: list[_FoldModel] = Field(default_factory=list)
    grip_radius_m: Positive = DEFAULT_GRIP_RADIUS_M
    placement: _PlacementModel | None = None

    def to_garment(self) -> Garment:
        outline = tuple((x, y) for x, y in self.outline)
        require_simple_outline(outline)
        placed = self.placement
        return Garment(
            self.name,
            self.name if self.title is None else self.title,
            outline,
            self.areal_density_kg_m2,
            tuple(self._drawn_fold(i) for i in range(len(self.folds))),
            self.grip_radius_m,
            Pose2(placed.x_m, placed.y_m, placed.yaw_rad) if placed else centred_placement(outline),
        )

    def _drawn_fold(self, index: int) -> DrawnFold:
        fold = self.folds[index]
        radius = self.grip_radius_m if fold.grip_radius_m is None else fold.grip_radius_m
        try:
            return DrawnFold(fold.name, fold.kind, (fold.start[0], fold.start[1]), (fold.end[0], fold.end[1]), radius)
        except GarmentError as error:
            raise error.within(f"folds[{index}]") from None
