"""A garment as it is drawn: its outline, its weight, the folds, and where it lies."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any

from annotated_types import Interval
from pydantic import Field

from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.outline import EDGE_MIN_M, POINTS_MAX, require_simple_outline
from planner.errors import GarmentError
from planner.geometry.given import GivenPose, PlanePoint
from planner.geometry.pose import Point2, Pose2
from planner.geometry.region import Region
from planner.json_form import NULL_IS_DEFAULT, STRICT, JsonForm, require_intervals
from planner.message import Message
from planner.strict_model import LARGEST_M

NAME_PATTERN = re.compile(r"[a-z0-9][a-z0-9-]{0,62}")
TITLE_MAX = 200
FOLDS_MAX = 64
FIRST_IS_RED = "the first fold cannot be red: red takes the flap of the fold before it"
DEFAULT_DENSITY_KG_M2 = 0.2
DEFAULT_GRIP_RADIUS_M = 0.127
DEFAULT_THICKNESS_M = 0.001
THICKNESS_MIN_M, THICKNESS_MAX_M = 0.0001, 0.02
LAYER_AIR_M = 0.001
"""How much further apart than they are thick layers come to lie that nothing presses together (m)."""

DEFAULT_YAW_RAD = -math.pi / 2

Positive = Annotated[float, Interval(gt=0.0, le=LARGEST_M)]
Thickness = Annotated[float, Interval(ge=THICKNESS_MIN_M, le=THICKNESS_MAX_M)]
Title = Annotated[str, Field(json_schema_extra={"maxLength": TITLE_MAX})]


@dataclass(frozen=True, slots=True)
class DrawnFold:
    """A fold as the user draws it: a directed line; the cloth to its left is folded over it.

    Attributes:
        name: the name that the user gave it.
        kind: its kind (`FOLD_KINDS`): "blue" folds every layer, "red" only those that the fold before it moved.
        start: first end in the garment frame (m), on the boundary of the silhouette at the time of the fold.
        end: second end (m).
        grip_radius_m: the radius within which one grip holds the cloth (m).
    """

    __pydantic_config__ = STRICT

    name: Title
    kind: Annotated[str, Field(json_schema_extra={"enum": list(FOLD_KINDS)})]
    start: PlanePoint
    end: PlanePoint
    grip_radius_m: Annotated[Positive, NULL_IS_DEFAULT] = DEFAULT_GRIP_RADIUS_M

    def __post_init__(self) -> None:
        """Check the fields; raises `GarmentError`."""
        if self.kind not in FOLD_KINDS:
            raise GarmentError("kind", f"expected one of {', '.join(FOLD_KINDS)}; got {self.kind!r}")
        if len(self.name) > TITLE_MAX:
            raise GarmentError("name", f"has {len(self.name)} characters, more than {TITLE_MAX}")
        length = math.dist(self.start, self.end)
        if length < EDGE_MIN_M:
            text = f"the line is {length * 1000:.3f} mm long, less than {EDGE_MIN_M * 1000:g} mm"
            values = {"length_m": length, "least_m": EDGE_MIN_M}
            raise GarmentError("end", Message("line_too_short", text, values))
        require_intervals(self, GarmentError)

    @property
    def is_red(self) -> bool:
        """Whether it folds only the layers that the fold before it moved."""
        return FOLD_KINDS[self.kind].is_red


@dataclass(frozen=True, slots=True)
class Garment:
    """A garment, its folds in the user's order, and where it lies at the start.

    Attributes:
        name: its name, also the file's.
        title: its name for people.
        outline: the pattern's corners in the garment frame (m), the first not repeated.
        areal_density_kg_m2: the cloth's mass per area.
        folds: the folds in the user's order.
        grip_radius_m: the radius within which one grip holds the cloth, unless a fold has its own (m).
        placement: the garment frame in the table frame.
        thickness_m: the cloth's thickness where fingers press it (m).
    """

    __pydantic_config__ = STRICT

    name: Annotated[str, Field(json_schema_extra={"pattern": f"^{NAME_PATTERN.pattern}$"})]
    title: Annotated[Title, NULL_IS_DEFAULT, Field(default_factory=lambda given: given["name"])]
    outline: Annotated[
        tuple[PlanePoint, ...], Field(json_schema_extra={"minItems": 3, "maxItems": POINTS_MAX, "uniqueItems": True})
    ]
    areal_density_kg_m2: Annotated[Positive, Field(default=DEFAULT_DENSITY_KG_M2)]
    folds: Annotated[tuple[DrawnFold, ...], Field(default=(), json_schema_extra={"maxItems": FOLDS_MAX})]
    grip_radius_m: Annotated[Positive, Field(default=DEFAULT_GRIP_RADIUS_M)]
    placement: Annotated[
        GivenPose, NULL_IS_DEFAULT, Field(default_factory=lambda given: centred_placement(given["outline"]))
    ]
    thickness_m: Thickness = DEFAULT_THICKNESS_M

    def __post_init__(self) -> None:
        """Check the fields; raises `GarmentError` with the field and the number."""
        if not NAME_PATTERN.fullmatch(self.name):
            raise GarmentError("name", f"{self.name!r} does not match {NAME_PATTERN.pattern}")
        if len(self.title) > TITLE_MAX:
            raise GarmentError("title", f"has {len(self.title)} characters, more than {TITLE_MAX}")
        require_simple_outline(self.outline)
        require_intervals(self, GarmentError)
        if len(self.folds) > FOLDS_MAX:
            raise GarmentError("folds", f"there are {len(self.folds)} folds, more than {FOLDS_MAX}")
        if self.folds and self.folds[0].is_red:
            raise GarmentError("folds[0].kind", FIRST_IS_RED)

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> "Garment":
        """Return the garment in the contents of a garment file; fields left out have their defaults.

        Raises:
            GarmentError: names the field, and says what is wrong with which number.
        """
        garment = _GARMENTS.read(data)
        radius_m, given = garment.grip_radius_m, data.get("folds", ())
        folds = (
            replace(fold, grip_radius_m=radius_m) if fields.get("grip_radius_m") is None else fold
            for fold, fields in zip(garment.folds, given, strict=True)
        )
        return replace(garment, folds=tuple(folds))

    def to_dict(self) -> dict[str, Any]:
        """Return the contents of a garment file, every field filled in."""
        written: dict[str, Any] = _GARMENTS.write(self)
        return written

    @property
    def layer_m(self) -> float:
        """The height that a layer takes in a stack that nothing presses (m)."""
        return self.thickness_m + LAYER_AIR_M

    @property
    def pattern(self) -> Region:
        """The cloth spread out, in the garment frame."""
        return Region.polygon(self.outline)


def centred_placement(outline: tuple[Point2, ...]) -> Pose2:
    """Return the placement that centres the outline's bounding box on the table, its top away from the robot."""
    xs, ys = [x for x, _ in outline], [y for _, y in outline]
    middle_x, middle_y = (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2
    return Pose2(-middle_y, middle_x, DEFAULT_YAW_RAD)


_GARMENTS = JsonForm(Garment, GarmentError)
