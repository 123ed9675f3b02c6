"""The share of garments that are read right, wrong, or not at all, over random rendered pictures.

Garment, placement, table, light, camera and sheet are drawn anew for each picture, from its number alone. A share of
the pictures has an arm that hides a part. Every picture is read as by ``pleat see``: as a drawing; then the known
garment's outline is fitted to what was seen. The renderer shares nothing with what reads.
"""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from statistics import median
from time import process_time
from typing import Any

import numpy as np
from shapely import Point

from app.rehearsal.camera.look import random_look
from app.rehearsal.vision.fit_stack import fit_stack
from app.rehearsal.vision.on_table import outline_on_table
from app.rehearsal.vision.picture import read_picture
from app.rehearsal.vision.scale_said import SheetSaid
from app.rehearsal.vision.seen_garment import drawn
from app.rehearsal.vision.stack_fit import LOOKS_ALIKE
from app.rehearsal.vision.vision_errors import NothingToldError
from bench.report import Report, Row, seconds
from bench.table_photo import Photo, photo
from planner import load_garment
from planner.cloth.cloth_state import ClothState
from planner.geometry.pose import Pose2
from planner.geometry.region import Region

GARMENTS = ("t-shirt", "jeans", "shirt", "tie", "scarf", "vest", "skirt", "hand-towel")
PICTURES, PICTURES_QUICK = 60, 4
"""Pictures of each kind."""

FREE_M = 0.2
"""Between the middle of the sheet and the cloth (m)."""

NEAR_M = 0.01
WRONG_M, WRONG_SIZE = 0.03, 0.1
"""A placement or a size that is further off than this, and not doubted, is wrong without saying so."""

COLUMNS = (
    "",
    "pictures",
    "drawn, sure",
    "size off [%]",
    "p95",
    "wrong, unsaid",
    "fitted, sure",
    "corners <= 1 cm",
    "worst corner [mm]",
    "wrong, unsaid",
    "CPU [s]",
)


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A random picture with its ground truth.

    Attributes:
        garment: the name of the garment.
        photo: the picture.
        placement: the garment's frame on the table.
        sheet: the sheet's frame on the table.
    """

    garment: str
    photo: Photo
    placement: Pose2
    sheet: Pose2


@dataclass(frozen=True, slots=True)
class Judged:
    """A reading of a picture, compared with the ground truth.

    Attributes:
        garment: the name of the garment.
        drawn_doubt: why the outline drawn is not sure; None where it is.
        size_off: by which share the area's root is off; None where nothing was drawn.
        size_error: what was told of that.
        fitted_doubt: why the placement of the known garment is not sure; None where it is.
        corners_m: how far off its corners are, in the frame of the sheet (m); empty where nothing was drawn.
        cpu_s: the CPU time taken (s).
    """

    garment: str
    drawn_doubt: str | None
    size_off: float | None
    size_error: float | None
    fitted_doubt: str | None
    corners_m: tuple[float, ...]
    cpu_s: float


def vision(_: Sequence[str], repetitions: int) -> Report:
    """Read pictures with and without an arm in them."""
    number = PICTURES if repetitions > 1 else PICTURES_QUICK
    rows = [
        _row(kind, [judge(scene(index, has_arm=has_arm)) for index in range(number)])
        for kind, has_arm in (("nothing in the way", False), ("an arm in the way", True))
    ]
    return Report("vision", "Garments read from rendered pictures", COLUMNS, tuple(rows), 1)


def scene(index: int, *, has_arm: bool) -> Scene:
    """Return the picture of a number: one garment, and a sheet of A4 beside it."""
    rng = np.random.default_rng([index, has_arm])
    name = str(rng.choice(GARMENTS))
    outline = np.array(load_garment(name).outline)
    yaw_rad = float(rng.uniform(-math.pi, math.pi))
    middle = Pose2(0.0, 0.0, yaw_rad).to_outer((outline.min(axis=0) + outline.max(axis=0)) / 2.0)
    x, y = rng.uniform(-0.06, 0.06, 2) - middle
    placement = Pose2(float(x), float(y), yaw_rad)
    ring = placement.to_outer(outline)
    sheet = _beside(Region.polygon(ring), rng)
    shown = photo([ring], random_look(rng, has_arm=has_arm), index, (sheet.x_m, sheet.y_m, sheet.yaw_rad))
    return Scene(name, shown, placement, sheet)


def _beside(cloth: Region, rng: np.random.Generator) -> Pose2:
    """Return where a sheet lies by chance that does not touch the cloth."""
    while True:
        x, y, yaw_rad = rng.uniform(-0.75, 0.75), rng.uniform(-0.5, 0.5), rng.uniform(-math.pi, math.pi)
        if cloth.shape.distance(Point(x, y)) > FREE_M:
            return Pose2(float(x), float(y), float(yaw_rad))


def judge(scene: Scene) -> Judged:
    """Return what is read from a picture, beside the truth."""
    started = process_time()
    garment = load_garment(scene.garment)
    try:
        seen = outline_on_table(read_picture(scene.photo.jpeg), SheetSaid("a4"))
        made = drawn(seen, scene.garment)
    except NothingToldError as error:
        return Judged(scene.garment, str(error), None, None, str(error), (), process_time() - started)
    fit = fit_stack(seen.contour, ClothState.spread_out(garment.pattern))
    cpu_s = process_time() - started
    doubt = seen.doubt or (None if fit.unknown is not None and fit.unknown.code == LOOKS_ALIKE else fit.unknown)
    return Judged(
        scene.garment,
        None if made.sure.unknown is None else made.sure.unknown.text,
        abs(math.sqrt(made.garment.pattern.area / garment.pattern.area) - 1.0),
        seen.size_error,
        None if doubt is None else doubt.text,
        tuple(_corners_off(scene, (fit.placement, *fit.others))),
        cpu_s,
    )


def _corners_off(scene: Scene, ways: tuple[Pose2, ...]) -> list[float]:
    """Return how far off corners are, of the likest of placements that look alike; a sheet may be turned by half."""
    corners = np.array(load_garment(scene.garment).outline)
    true = scene.sheet.to_inner(scene.placement.to_outer(corners))
    found = [sign * way.to_outer(corners) for way in ways for sign in (1.0, -1.0)]
    offs: list[list[float]] = [np.hypot(*(one - true).T).tolist() for one in found]
    return min(offs, key=max)


def _row(kind: str, judged: list[Judged]) -> Row:
    sizes = [one.size_off for one in judged if one.drawn_doubt is None and one.size_off is not None]
    fitted = [one for one in judged if one.fitted_doubt is None]
    corners = [off for one in fitted for off in one.corners_m]
    worst = [max(one.corners_m) for one in fitted]
    told: dict[str, Any] = {
        "kind": kind,
        "pictures": len(judged),
        "drawn_sure": len(sizes),
        "size_off": median(sizes),
        "size_off_p95": float(np.quantile(sizes, 0.95)),
        "size_wrong_unsaid": sum(off > WRONG_SIZE for off in sizes),
        "fitted_sure": len(fitted),
        "corners_near": float(np.mean(np.array(corners) <= NEAR_M)),
        "worst_corner_m": median(worst),
        "placement_wrong_unsaid": sum(off > WRONG_M for off in worst),
        "cpu_s": median(one.cpu_s for one in judged),
    }
    line = (
        kind,
        str(told["pictures"]),
        str(told["drawn_sure"]),
        f"{100 * told['size_off']:.1f}",
        f"{100 * told['size_off_p95']:.1f}",
        str(told["size_wrong_unsaid"]),
        str(told["fitted_sure"]),
        f"{told['corners_near']:.0%}",
        f"{1000 * told['worst_corner_m']:.1f}",
        str(told["placement_wrong_unsaid"]),
        seconds(told["cpu_s"]),
    )
    return Row((line,), {**told, "all": [asdict(one) for one in judged]})
