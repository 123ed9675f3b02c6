"""Pictures with more than one piece: cut-outs, stripes of the table's colour, two garments, table tops."""

import numpy as np
import pytest

from app.rehearsal.vision.seen_garment import Seen, see
from app.rehearsal.vision.vision_errors import NothingToldError
from planner.geometry.pose import FloatArray
from planner.geometry.region import Region
from tests.app.rehearsal.vision.painted import (
    A4_M,
    BLUE,
    FLOOR,
    PAPER,
    WOOD,
    cut_out,
    garment,
    jpeg,
    rectangle,
    striped,
    taken,
)

SHEET = rectangle(0.75, -0.45, A4_M), PAPER


def size_off(seen: Seen, ring: FloatArray) -> float:
    return abs(Region.polygon(seen.garment.outline).area / Region.polygon(ring).area - 1.0)


def code(seen: Seen) -> str | None:
    return None if seen.sure.unknown is None else seen.sure.unknown.code


@pytest.mark.parametrize("colour", [0, 12, 128, 255])
def test_a_cut_out_is_seen_by_what_is_opaque_whatever_its_colour(colour: int) -> None:
    ring = garment("t-shirt", yaw_rad=0.0)
    width_m = float(np.ptp(ring[:, 0]))
    seen = see(cut_out([ring], colour), "shirt", f"{width_m:.3f}m:width")
    assert seen.sure.unknown is None
    assert len(seen.garment.outline) == len(ring)
    assert size_off(seen, ring) < 0.01


@pytest.mark.parametrize("soft", [0.0, 0.7])
def test_a_cut_out_trimmed_to_its_size_is_whole(soft: float) -> None:
    ring = garment("t-shirt", yaw_rad=0.0)
    seen = see(cut_out([ring], is_trimmed=True, soft=soft), "shirt", f"{np.ptp(ring[:, 0]):.3f}m:width")
    assert seen.sure.unknown is None
    assert size_off(seen, ring) < 0.01


@pytest.mark.parametrize("others", [1, 2])
def test_several_garments_in_a_cut_out_are_counted(others: int) -> None:
    rings = [garment("vest", 0.7 * k, 0.0, 0.2) for k in range(1 + others)]
    seen = see(cut_out(rings), "vests", "0.6m:height")
    assert code(seen) == "several_cloths"
    assert seen.sure.unknown is not None and seen.sure.unknown.values["cloths"] == 1 + others


@pytest.mark.parametrize("along_rad", [0.3, pytest.param(0.3 + np.pi / 2, marks=pytest.mark.long)])
@pytest.mark.parametrize("width_m", [pytest.param(0.05, marks=pytest.mark.long), 0.1])
def test_cloth_with_stripes_of_the_tables_colour_is_one_and_not_sure(along_rad: float, width_m: float) -> None:
    towel = garment("hand-towel")
    image = taken([(towel, WOOD), *((ring, BLUE) for ring in striped(towel, along_rad, width_m)), SHEET])
    seen = see(jpeg(image), "towel", "a4")
    assert code(seen) == "striped_cloth"
    assert size_off(seen, towel) < 0.05
    assert len(seen.garment.outline) == 4


@pytest.mark.parametrize("other", ["t-shirt", pytest.param("hand-towel", marks=pytest.mark.long)])
def test_two_garments_in_a_picture_are_told_as_two(other: str) -> None:
    shirt = garment("t-shirt", -0.5, 0.2)
    image = taken([(shirt, BLUE), (garment(other, 0.45, 0.25, 1.2), (60, 60, 180)), SHEET], width_m=2.4)
    seen = see(jpeg(image), "shirt", "a4")
    assert code(seen) == "several_cloths"
    assert seen.sure.unknown is not None and "2 pieces" in seen.sure.unknown.text


@pytest.mark.parametrize("tilt_rad", [pytest.param(0.0, marks=pytest.mark.long), 0.15])
def test_a_table_top_with_the_sheet_on_it_is_not_the_garment(tilt_rad: float) -> None:
    shirt = garment("t-shirt", -0.2, 0.0, 0.1)
    top = rectangle(0.0, 0.0, (1.6, 0.98), 0.0)
    image = taken([(top, WOOD), (shirt, BLUE), (rectangle(0.55, 0.2, A4_M), PAPER)], FLOOR, tilt_rad=tilt_rad)
    seen = see(jpeg(image), "shirt", "a4")
    assert seen.sure.unknown is None, seen.sure
    assert size_off(seen, shirt) < 0.04


def test_an_empty_table_top_with_a_sheet_on_it_shows_no_garment() -> None:
    top = rectangle(0.0, 0.0, (1.6, 0.98), 0.0)
    image = taken([(top, WOOD), (rectangle(0.55, 0.2, A4_M), PAPER)], FLOOR)
    with pytest.raises(NothingToldError, match="lay the sheet beside the garment"):
        see(jpeg(image), "nothing", "a4")


def test_a_warning_of_the_size_comes_only_where_the_sheet_is_small() -> None:
    towel = garment("hand-towel", -0.1)
    near = see(jpeg(taken([(towel, BLUE), SHEET])), "towel", "a4")
    assert near.sure.unknown is None and near.sure.size_error is not None
    assert size_off(near, towel) / 2.0 < near.sure.size_error < 0.03
