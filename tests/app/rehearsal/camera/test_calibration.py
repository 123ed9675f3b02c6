"""A camera calibrated with synthetic pictures of the board, and used."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from app.cli import cli
from app.rehearsal.camera.calibration import SQUARE_M, Calibration, CalibrationError, board_picture, calibrated
from planner.geometry.pose import Pose2

SIZE = (960, 720)
MATRIX = np.array([[820.0, 0.0, 500.0], [0.0, 824.0, 345.0], [0.0, 0.0, 1.0]])
DISTORTION = np.array([-0.12, 0.03, 0.0, 0.0, 0.0])
BOARD = Pose2(0.2, -0.1, 0.4)
DOTS_PER_M = 4000.0

Drawn = tuple[np.ndarray, Callable[[np.ndarray], np.ndarray]]


def taken(position: tuple[float, float, float], turned_rad: tuple[float, float, float], drawn: Drawn) -> np.ndarray:
    """Return what a camera of that lens sees of something drawn on the table.

    Args:
        position: the lens, table frame.
        turned_rad: its roll, pitch and yaw away from straight down.
        drawn: grey dots, and where points of the table are among them.
    """
    columns, rows = np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))
    pixels = np.column_stack([columns.ravel(), rows.ravel()]).astype(np.float64)
    rays = np.column_stack([cv2.undistortPoints(pixels[:, None], MATRIX, DISTORTION)[:, 0], np.ones(len(pixels))])
    ways = rays @ axes(turned_rad).T
    on_table = position[:2] - position[2] / ways[:, 2:] * ways[:, :2]
    dots, at = drawn
    places = at(on_table).astype(np.float32).reshape(SIZE[1], SIZE[0], 2)
    grey = cv2.remap(dots, places[..., 0], places[..., 1], cv2.INTER_LINEAR, borderValue=200)
    return cv2.cvtColor(cv2.GaussianBlur(grey, (0, 0), 0.7), cv2.COLOR_GRAY2BGR)


def axes(turned_rad: tuple[float, float, float]) -> np.ndarray:
    down = np.diag([1.0, -1.0, -1.0])
    return np.asarray(Rotation.from_euler("xyz", turned_rad).as_matrix() @ down)


def board(lies: Pose2) -> Drawn:
    dots = board_picture(DOTS_PER_M)

    def at(points: np.ndarray) -> np.ndarray:
        middle = (np.array(dots.shape[::-1]) - 1.0) / 2.0
        return np.asarray(lies.to_inner(points) * [DOTS_PER_M, -DOTS_PER_M] + middle)

    return dots, at


LENS = (0.05, -0.2, 0.9)
TURNED = (0.15, -0.1, 0.3)


@pytest.fixture(scope="module")
def pictures() -> list[np.ndarray]:
    others = []
    for turned in ((0.5, 0.1, 0.2), (-0.4, 0.3, 1.2), (0.1, -0.5, -0.4)):
        ahead = axes(turned)[:, 2]
        x_m, y_m = (0.5 * ahead[:2] / -ahead[2]).tolist()
        others.append(taken((0.0, 0.0, 0.5), turned, board(Pose2(x_m, y_m, 0.3))))
    return [taken(LENS, TURNED, board(BOARD)), *others]


@pytest.fixture(scope="module")
def found(pictures: list[np.ndarray]) -> Calibration:
    return calibrated(pictures, SQUARE_M, BOARD)


def test_pictures_of_the_board_tell_where_the_camera_is_over_the_table(found: Calibration) -> None:
    assert found.error_px < 0.3
    assert found.position_m == pytest.approx(LENS, abs=0.01)
    np.testing.assert_allclose(np.array(found.rotation), axes(TURNED), atol=0.02)


def test_a_straightened_picture_shows_points_of_the_table_where_they_are(
    pictures: list[np.ndarray], found: Calibration
) -> None:
    for size in (SIZE, (640, 480)):
        image, camera = found.view(cv2.resize(pictures[0], size, interpolation=cv2.INTER_AREA))
        grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        corner = BOARD.to_outer(np.array([[0.5 * SQUARE_M, 0.5 * SQUARE_M], [-1.5 * SQUARE_M, -0.5 * SQUARE_M]]))
        expected = camera.pixels(np.column_stack([corner, np.zeros(2)]))
        seen = cv2.cornerSubPix(
            grey, np.ascontiguousarray(expected[:, None], np.float32), (5, 5), (-1, -1), (3, 30, 0.01)
        )[:, 0]
        away_m = np.hypot(*(camera.on_plane(seen.astype(float)) - corner).T)
        assert away_m.max() < 0.001
    with pytest.raises(CalibrationError, match="the calibration is of 960 by 720"):
        found.view(np.zeros((400, 640, 3), np.uint8))


def test_pictures_that_do_not_tell_are_refused_by_their_number(pictures: list[np.ndarray]) -> None:
    with pytest.raises(CalibrationError, match="expected 3 pictures at least"):
        calibrated(pictures[:2], SQUARE_M, BOARD)
    with pytest.raises(CalibrationError, match=r"pictures\[1\]: shows 0 of the board's 24 corners"):
        calibrated([pictures[0], np.full_like(pictures[0], 128), pictures[1]], SQUARE_M, BOARD)
    with pytest.raises(CalibrationError, match=r"pictures\[2\]: is of another size"):
        calibrated([*pictures[:2], pictures[2][:600]], SQUARE_M, BOARD)


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"pleat_camera": 2}, "pleat_camera"),
        ({"focal_px": [0.0, 1.0]}, "focal_px[0]"),
        ({"rotation": [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]}, "rotation"),
        ({"lens": 1}, "lens"),
    ],
)
def test_a_file_that_is_no_calibration_is_refused_by_its_field(
    found: Calibration, tmp_path: Path, change: dict[str, Any], field: str
) -> None:
    path = tmp_path / "camera.json"
    path.write_text(found.file())
    assert Calibration.read(path) == found
    path.write_text(json.dumps(json.loads(found.file()) | change))
    with pytest.raises(CalibrationError) as refused:
        Calibration.read(path)
    assert refused.value.field == field


def test_the_board_is_printed_and_a_picture_measured_by_command(pictures: list[np.ndarray], tmp_path: Path) -> None:
    run = CliRunner()
    for name, head in (("board.pdf", b"%PDF"), ("board.png", b"\x89PNG")):
        assert run.invoke(cli, ["camera", "board", "--out", str(tmp_path / name)]).exit_code == 0
        assert (tmp_path / name).read_bytes().startswith(head)
    assert run.invoke(cli, ["camera", "board", "--out", "board.jpg"]).exit_code == 2
    paths = [str(tmp_path / f"{number}.png") for number in range(len(pictures))]
    for path, picture in zip(paths, pictures, strict=True):
        cv2.imwrite(path, picture)
    file = str(tmp_path / "camera.json")
    place = f"{BOARD.x_m},{BOARD.y_m},{BOARD.yaw_rad}"
    result = run.invoke(cli, ["camera", "calibrate", *paths, "--out", file, "--board-at", place])
    assert result.exit_code == 0 and "the lens is at (0.0" in result.stdout, result.output
    result = run.invoke(cli, ["camera", "calibrate", *paths, "--out", file, "--board-at", "1,2"])
    assert result.exit_code == 2 and "--board-at: expected X,Y,YAW" in result.stderr

    cloth = np.full((720, 960), 110, np.uint8)  # a dark table, and on it a napkin of 30 by 20 cm
    cloth[260:460, 330:630] = 240
    drawn: Drawn = (cloth, lambda points: np.asarray(points * [1000.0, -1000.0] + [480.0, 360.0]))
    cv2.imwrite(paths[0], taken((0.0, 0.0, 0.8), TURNED, drawn))
    Path(file).write_text(calibrated(pictures, SQUARE_M, BOARD).file())
    moved = json.loads(Path(file).read_text()) | {"position_m": [0.0, 0.0, 0.8]}
    Path(file).write_text(json.dumps(moved))
    result = run.invoke(cli, ["see", paths[0], "--calibration", file, "--json", "-"])
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert (told["frame"], told["scale_from"]) == ("table", "camera")
    sides = sorted(max(axis) - min(axis) for axis in zip(*told["garment"]["outline"], strict=True))
    assert sides == pytest.approx([0.2, 0.3], abs=0.004)
    both = run.invoke(cli, ["see", paths[0], "--calibration", file, "--scale", "a4"])
    assert both.exit_code == 2 and "cannot be given together" in both.stderr
