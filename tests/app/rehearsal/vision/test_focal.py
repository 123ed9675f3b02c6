"""The focal length of a picture's camera, and what it does to sizes."""

import struct
from itertools import product

import pytest

from app.rehearsal.vision.on_table import outline_on_table
from app.rehearsal.vision.picture import read_picture
from app.rehearsal.vision.scale_said import SheetSaid
from app.rehearsal.vision.table_plane import USUAL_FOCAL
from planner.geometry.region import Region
from tests.app.rehearsal.vision.painted import A4_M, BLUE, PAPER, garment, jpeg, rectangle, taken

TOWEL, SHEET = garment("hand-towel", -0.1, 0.1), rectangle(0.65, -0.4, A4_M)
FIGURES = [(TOWEL, BLUE), (SHEET, PAPER)]


def test_the_focal_length_is_that_of_the_exif_as_a_share_of_the_diagonal() -> None:
    # 26 mm on film of 36 x 24 mm, 43.27 mm across; a picture of 4:3 is 1.25 longer sides across.
    focal = read_picture(jpeg(taken([]), 26)).focal
    assert focal.sides == pytest.approx(26 / 43.267 * 1.25, rel=1e-3)
    assert focal.spread < USUAL_FOCAL.spread


@pytest.mark.parametrize("millimetres", [None, 1, 5000])
def test_a_focal_length_that_is_missing_or_impossible_is_the_usual_one(millimetres: int | None) -> None:
    assert read_picture(jpeg(taken([]), millimetres)).focal == USUAL_FOCAL


def test_damaged_exif_is_no_error() -> None:
    whole = jpeg(taken([]))
    exif = b"Exif\0\0MM\0*\0\0\0\x08\0\xff" + b"\x87\x69\0\4\0\0\0\1\xff\xff\xff\xff" * 3
    damaged = whole[:2] + b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif + whole[2:]
    assert read_picture(damaged).focal == USUAL_FOCAL


@pytest.mark.parametrize(
    ("tilt_rad", "focal"),
    [
        one if one in ((0.0, 1.4), (0.2, 0.7)) else pytest.param(*one, marks=pytest.mark.long)
        for one in product((0.0, 0.03, 0.2), (0.7, 0.95, 1.4))
    ],
)
def test_sizes_are_known_from_straight_above_and_from_the_side(tilt_rad: float, focal: float) -> None:
    seen = outline_on_table(read_picture(jpeg(taken(FIGURES, tilt_rad=tilt_rad, focal=focal))), SheetSaid("a4"))
    off = Region.polygon(seen.contour).length / Region.polygon(TOWEL).length - 1.0
    assert seen.size_error is not None and seen.size_error < 0.04
    assert abs(off) < max(seen.size_error, 0.01)
    assert seen.doubt is None


def test_a_long_lens_is_seen_to_be_one_by_its_exif() -> None:
    image = taken(FIGURES, tilt_rad=0.45, focal=4.0)
    millimetres = round(4.0 * 43.267 / 1.25)
    unknown, known = (outline_on_table(read_picture(jpeg(image, mm)), SheetSaid("a4")) for mm in (None, millimetres))
    offs = [abs(Region.polygon(one.contour).length / Region.polygon(TOWEL).length - 1.0) for one in (unknown, known)]
    assert offs[1] < 0.015
    assert known.size_error is not None and unknown.size_error is not None
    assert known.size_error < unknown.size_error
