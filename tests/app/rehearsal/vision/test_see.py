import struct

import cv2
import httpx
import numpy as np
import pytest

from app.rehearsal.camera.look import Look
from app.rehearsal.vision.like import Like, liken
from app.rehearsal.vision.outline_edges import OutlineEdges
from app.rehearsal.vision.picture import read_picture
from app.rehearsal.vision.scale_said import LengthSaid, MarkerSaid, SheetSaid, read_scale
from app.rehearsal.vision.seen_garment import Seen, see
from app.rehearsal.vision.straighten import straighten
from app.rehearsal.vision.vision_errors import NothingToldError, PictureError, ScaleNeededError
from app.templates.catalogue import find_template
from bench.table_photo import Photo, photo
from planner import load_garment
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from tests.required import required

BLUE_ON_WOOD = Look((110.0, 150.0, 190.0), (150.0, 70.0, 40.0), tilt_rad=0.25)
WHITE_ON_LIGHT_WOOD = Look((165.0, 195.0, 215.0), (245.0, 246.0, 247.0), wrinkles=0.1, tilt_rad=0.1)
DARK_ON_DARK = Look((45.0, 50.0, 55.0), (75.0, 40.0, 35.0), wood=0.2, noise=3.0)
PATTERNED = Look((80.0, 110.0, 90.0), (60.0, 60.0, 190.0), pattern="checks", tilt_rad=0.3)


def ring(name: str = "t-shirt", yaw_rad: float = 0.4) -> FloatArray:
    outline = np.array(load_garment(name).outline)
    return Pose2(0.0, 0.0, yaw_rad).to_outer(outline - (outline.min(axis=0) + outline.max(axis=0)) / 2.0)


def picture(look: Look, name: str = "t-shirt", **beside: object) -> Photo:
    return photo([ring(name)], look, 5, **beside)  # type: ignore[arg-type]


def size(seen: Seen) -> float:
    return Region.polygon(seen.garment.outline).length


@pytest.fixture(scope="module")
def alone() -> Photo:
    """Return a picture of a T-shirt with nothing beside it."""
    return picture(BLUE_ON_WOOD)


@pytest.mark.parametrize(
    "look", [*(pytest.param(look, marks=pytest.mark.long) for look in (WHITE_ON_LIGHT_WOOD, DARK_ON_DARK)), PATTERNED]
)
def test_a_t_shirt_beside_a_sheet_is_seen_with_its_corners_and_its_size(look: Look) -> None:
    seen = see(picture(look, sheet=(0.62, -0.3, 0.4)).jpeg, "shirt", "a4")
    assert seen.sure.unknown is None, seen.sure
    assert 9 <= len(seen.garment.outline) <= 11
    assert size(seen) == pytest.approx(Region.polygon(ring()).length, rel=0.03)
    assert seen.scale_from == "a4" and seen.frame == "sheet"


SHIRT_PX = np.array(
    [
        (300, 150),
        (140, 220),
        (180, 340),
        (280, 310),
        (280, 760),
        (720, 760),
        (720, 310),
        (820, 340),
        (860, 220),
        (700, 150),
    ]
)
UPRIGHT_SHEET, LYING_SHEET = ((950, 560), (1120, 800)), ((920, 560), (1160, 730))


@pytest.mark.parametrize(
    ("sheet", "quarters"), [(UPRIGHT_SHEET, 0), (UPRIGHT_SHEET, 1), (LYING_SHEET, 1), (LYING_SHEET, 2), (None, 1)]
)
def test_what_is_up_in_a_picture_is_up_on_the_board(
    sheet: tuple[tuple[int, int], tuple[int, int]] | None, quarters: int
) -> None:
    drawn = np.full((900, 1200, 3), (60, 85, 120), np.uint8)
    cv2.fillPoly(drawn, [SHIRT_PX.astype(np.int32)], (190, 110, 70))
    if sheet is not None:
        cv2.rectangle(drawn, *sheet, (250, 250, 250), -1)
    turned = np.ascontiguousarray(np.rot90(cv2.GaussianBlur(drawn, (0, 0), 0.8), quarters))
    seen = see(cv2.imencode(".png", turned)[1].tobytes(), "shirt", "0.9m:height" if sheet is None else "a4")
    metres = SHIRT_PX * (0.297 / 240.0 if sheet is not None else 0.9 / 720.0) * np.array([1.0, -1.0])
    expected = Pose2(0.0, 0.0, quarters * np.pi / 2).to_outer(metres)
    gaps = np.array(seen.garment.outline)[:, None] - (expected - expected.min(axis=0))
    assert np.hypot(*gaps.transpose(2, 0, 1)).min(axis=1).max() < 0.02


def test_a_marker_gives_the_scale_and_the_frame_too() -> None:
    seen = see(picture(BLUE_ON_WOOD, "jeans", marker=(0.5, 0.2, 0.6, 0.15)).jpeg, "jeans", "marker:150mm")
    assert size(seen) == pytest.approx(Region.polygon(ring("jeans")).length, rel=0.04)
    middle = Pose2(0.5, 0.2, 0.6).to_inner(ring("jeans")).mean(axis=0)
    lies = seen.placement.to_outer(np.array(seen.garment.outline)).mean(axis=0)
    assert lies == pytest.approx(middle, abs=0.03)


def test_one_length_gives_the_scale_of_a_picture_from_straight_above() -> None:
    straight = Look((110.0, 150.0, 190.0), (150.0, 70.0, 40.0), tilt_rad=0.0)
    seen = see(picture(straight, "hand-towel").jpeg, "towel", "0.9m:longest")
    corners = np.array(seen.garment.outline)
    assert np.hypot(*(corners[:, None] - corners).transpose(2, 0, 1)).max() == pytest.approx(0.9, rel=0.02)
    assert len(corners) == 4


@pytest.mark.parametrize(("name", "like"), [("t-shirt", find_template("t-shirt")), ("jeans", load_garment("jeans"))])
def test_what_is_like_a_known_garment_has_its_corners_and_its_folds(name: str, like: Like) -> None:
    contour = 1.15 * Pose2(0.1, 0.2, 2.0).to_outer(OutlineEdges.of(load_garment(name).pattern).spaced(500))
    found = liken(contour, like)
    assert len(found.garment.outline) == len(load_garment(name).outline)
    assert len(found.garment.folds) == len(load_garment(name).folds)
    assert found.garment.pattern.length == pytest.approx(1.15 * load_garment(name).pattern.length, rel=0.01)
    assert np.abs(found.distances).max() < 0.005


def test_the_corners_of_narrow_cloth_are_not_lost_within_the_tolerance_of_its_length() -> None:
    tie = load_garment("tie").pattern
    points = OutlineEdges.of(tie).spaced(700)
    points = points + np.random.default_rng(2).normal(0.0, 0.0015, points.shape)
    assert Region.polygon(straighten(points).corners).area == pytest.approx(tie.area, rel=0.04)


def test_without_anything_of_known_size_the_scale_is_asked_for(alone: Photo) -> None:
    with pytest.raises(ScaleNeededError, match="A4 or Letter"):
        see(alone.jpeg, "shirt", None)


def test_an_empty_table_shows_no_garment() -> None:
    with pytest.raises(NothingToldError):
        see(photo([], BLUE_ON_WOOD, 3).jpeg, "nothing", "0.5m")


def test_a_garment_that_runs_out_of_the_picture_is_doubted(alone: Photo) -> None:
    _, cut = cv2.imencode(".png", alone.image[:640])
    assert required(see(cut.tobytes(), "half", "0.5m").sure.unknown).code == "cut_off"


@pytest.mark.parametrize(
    ("said", "read"),
    [
        ("a4", SheetSaid("a4")),
        ("Letter", SheetSaid("letter")),
        ("marker:50mm", MarkerSaid(0.05)),
        ("0.60m", LengthSaid(0.6, "longest")),
        ("24in:width", LengthSaid(24 * 0.0254, "width")),
        ("500 mm:height", LengthSaid(0.5, "height")),
    ],
)
def test_a_scale_is_read(said: str, read: object) -> None:
    assert read_scale(said) == read


@pytest.mark.parametrize("said", ["", "0.6", "a5", "0m", "1e9m", "marker:2m", "nanm", "-1m", "0.6m:depth", "٣m"])
def test_a_scale_that_is_none_is_refused(said: str) -> None:
    with pytest.raises(PictureError) as refused:
        read_scale(said)
    assert refused.value.field == "scale"


JPEG = cv2.imencode(".jpg", np.full((200, 300, 3), 90, np.uint8))[1].tobytes()
PNG = cv2.imencode(".png", np.full((200, 300, 3), 90, np.uint8))[1].tobytes()
HUGE = b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + b"IHDR" + struct.pack(">II", 60_000, 60_000) + PNG[24:]


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"", "empty"),
        (b"\0\0\0\x18ftypheic" + b"\0" * 50, "HEIC"),
        (b"RIFF\0\0\0\0WEBP" + b"\0" * 50, "WebP"),
        (b"GIF89a" + b"\0" * 50, "GIF"),
        (b"<svg/>", "no kind that is known"),
        (JPEG[: len(JPEG) // 2], "damaged or cut off"),
        (PNG[: len(PNG) // 2], "damaged or cut off"),
        (PNG[:20], "damaged"),
        (JPEG[:12], "damaged or cut off"),
        (HUGE, "60000 by 60000 pixels"),
        (cv2.imencode(".png", np.zeros((20, 20, 3), np.uint8))[1].tobytes(), "20 by 20 pixels"),
    ],
)
def test_a_file_that_is_no_picture_is_refused_by_what_is_wrong(data: bytes, why: str) -> None:
    with pytest.raises(PictureError, match=why) as refused:
        read_picture(data)
    assert refused.value.field == "file"


def test_a_jpeg_is_turned_upright_as_its_exif_says() -> None:
    exif = b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0"
    turned = JPEG[:2] + b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif + JPEG[2:]
    assert read_picture(JPEG).image.shape[:2] == (200, 300)
    assert read_picture(turned).image.shape[:2] == (300, 200)


@pytest.mark.anyio
async def test_a_picture_that_is_imported_may_be_like_a_template_or_a_garment(
    shirt_photo: Photo, client: httpx.AsyncClient
) -> None:
    for like in ("t-shirt", "big-towel"):
        query = {"filename": "mine.jpg", "like": like}
        answer = await client.post("/api/imports", params=query, content=shirt_photo.jpeg)
        assert answer.status_code == 200, answer.text
        folds = answer.json()["garment"]["folds"]
        assert [fold["name"] for fold in folds] == [fold.name for fold in load_garment(like).folds]
