"""Calibrate a camera over a table from pictures of a printed board of markers; in one of them its place is known.

The board is OpenCV's ChArUco: a chessboard with markers in its white squares, so that a part of it tells. Its frame has
its middle as the origin, x to its right and y up as it is printed. Pictures of it at slants tell the lens; the picture
of it as it lies on the table tells where the camera is in the table's frame, which is the frame that a plan's base
stands in: so the board, whose place beside the base is measured, ties all three together.
"""

import json
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Annotated, Any, Literal

import cv2
import numpy as np
from annotated_types import Interval, Len

from app.rehearsal.camera.camera import Camera
from planner.errors import FieldError
from planner.geometry.pose import FloatArray, Point3, Pose2
from planner.json_form import STRICT, JsonForm

SQUARE_M = 0.035
"""The side of a square of the board as it is printed (m)."""

PICTURES_MIN = 3
"""The least number of pictures from which a lens can be calibrated."""

_COLUMNS, _ROWS, _MARKER = 7, 5, 0.74
_DPI, _PAPER_M = 300, (0.297, 0.210)
_CORNERS_MIN = 8
_WORST_PX = 2.0
"""The largest error of a valid fit (pixels); more means another board, or a lens unlike a pinhole."""

Image = np.ndarray[Any, np.dtype[np.uint8]]
_Pixels = Annotated[float, Interval(ge=1.0, le=1e5)]


class CalibrationError(FieldError):
    """Bad input: pictures that do not suffice to calibrate a camera, or a file that holds no calibration."""


@dataclass(frozen=True, slots=True)
class Calibration:
    """A camera: its lens, and where it is.

    Attributes:
        pleat_camera: the version of this form.
        size_px: the width and height of its pictures.
        focal_px: its focal lengths across and down.
        middle_px: where its axis meets the picture.
        distortion: the lens's, as OpenCV has it: k1, k2, p1, p2, k3.
        position_m: the lens, table frame.
        rotation: its axes as columns in the table frame, x right, y down, z ahead; row by row.
        error_px: how far the board's corners were from where it would see them, rms.
    """

    __pydantic_config__ = STRICT

    size_px: tuple[Annotated[int, Interval(ge=160, le=20_000)], Annotated[int, Interval(ge=120, le=20_000)]]
    focal_px: tuple[_Pixels, _Pixels]
    middle_px: tuple[float, float]
    distortion: Annotated[tuple[float, ...], Len(5, 5)]
    position_m: Point3
    rotation: tuple[Point3, Point3, Point3]
    error_px: Annotated[float, Interval(ge=0.0)]
    pleat_camera: Literal[1] = 1

    def __post_init__(self) -> None:
        """Check that the axes are right-handed and of length 1; raises `CalibrationError`."""
        turn = np.array(self.rotation)
        if not np.allclose(turn @ turn.T, np.eye(3), atol=1e-3) or np.linalg.det(turn) < 0.0:
            raise CalibrationError("rotation", "its columns are no right-handed axes")

    @staticmethod
    def read(path: Path) -> "Calibration":
        """Return the calibration in a file.

        Raises:
            CalibrationError: the file holds no calibration.
            OSError: the system refuses to read.
        """
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
        except ValueError:
            raise CalibrationError("", "is no JSON") from None
        return _FORM.read(content)

    def file(self) -> str:
        """Return the content of a calibration's file."""
        return json.dumps(_FORM.write(self), indent=1) + "\n"

    def view(self, image: Image) -> tuple[Image, Camera]:
        """Return a picture as a pinhole camera would have taken it, and that camera.

        Raises:
            CalibrationError: the picture's sides have another ratio than those that were calibrated.
        """
        height, width = image.shape[:2]
        across, down = width / self.size_px[0], height / self.size_px[1]
        if abs(across / down - 1.0) > 0.01:
            sizes = f"{width} by {height} pixels, the calibration is of {self.size_px[0]} by {self.size_px[1]}"
            raise CalibrationError("size_px", f"the picture is {sizes}")
        focal_px = float(np.mean(self.focal_px)) * across
        camera = Camera(self.position_m, self.rotation, focal_px, (width, height))
        seen = self._matrix(across, down)
        middle = ((width - 1.0) / 2.0, (height - 1.0) / 2.0)
        wanted = np.array([[focal_px, 0.0, middle[0]], [0.0, focal_px, middle[1]], [0.0, 0.0, 1.0]])
        maps = cv2.initUndistortRectifyMap(
            seen, np.array(self.distortion), np.eye(3), wanted, (width, height), cv2.CV_32FC1
        )
        return np.asarray(cv2.remap(image, *maps, cv2.INTER_LINEAR), np.uint8), camera

    def _matrix(self, across: float, down: float) -> FloatArray:
        """Return the camera matrix for pictures that are larger by factors, across and down."""
        (fx, fy), (cx, cy) = self.focal_px, self.middle_px
        x, y = (cx + 0.5) * across - 0.5, (cy + 0.5) * down - 0.5
        return np.array([[fx * across, 0.0, x], [0.0, fy * down, y], [0.0, 0.0, 1.0]])


_FORM = JsonForm(Calibration, CalibrationError)


def calibrated(pictures: list[Image], square_m: float, board: Pose2) -> Calibration:
    """Return the calibration found from pictures of the board.

    Args:
        pictures: the board as it lies on the table, then the same at slants; blue, green, red, all of one size.
        square_m: the side of its squares as printed (m).
        board: where its middle lies in the first picture and how it is turned, table frame.

    Raises:
        CalibrationError: the pictures are too few or of several sizes, the board is hardly in one, or nothing fits.
    """
    if len(pictures) < PICTURES_MIN:
        text = f"expected {PICTURES_MIN} pictures at least: the board in its place, and others at slants"
        raise CalibrationError("pictures", f"{text}; got {len(pictures)}")
    size_px = (pictures[0].shape[1], pictures[0].shape[0])
    if odd := [number for number, one in enumerate(pictures) if (one.shape[1], one.shape[0]) != size_px]:
        raise CalibrationError(f"pictures[{odd[0]}]", "is of another size than the first")
    corners = [_corners(number, one, square_m) for number, one in enumerate(pictures)]
    flags = cv2.CALIB_ZERO_TANGENT_DIST | cv2.CALIB_FIX_K3
    points, pixels = ([one[part].astype(np.float32) for one in corners] for part in (0, 1))
    error_px, matrix, distortion, turns, places = cv2.calibrateCamera(points, pixels, size_px, None, None, flags=flags)
    if not error_px <= _WORST_PX:
        raise CalibrationError("pictures", f"no camera sees the board so: corners are {error_px:.1f} pixels off")
    turn, _ = cv2.Rodrigues(turns[0])
    lens = -turn.T @ places[0].ravel()
    over = np.eye(3)
    over[:2, :2] = board.to_outer(np.eye(2)).T - np.array([[board.x_m], [board.y_m]])
    x_m, y_m, z_m = (over @ lens + [board.x_m, board.y_m, 0.0]).tolist()
    if z_m <= 0.0:
        raise CalibrationError("pictures[0]", "the camera is below the board")
    rows = [(x, y, z) for x, y, z in (over @ turn.T).tolist()]
    return Calibration(
        size_px,
        (float(matrix[0, 0]), float(matrix[1, 1])),
        (float(matrix[0, 2]), float(matrix[1, 2])),
        tuple(np.ravel(distortion)[:5].tolist()),
        (x_m, y_m, z_m),
        (rows[0], rows[1], rows[2]),
        float(error_px),
    )


def _corners(number: int, picture: Image, square_m: float) -> tuple[FloatArray, FloatArray]:
    """Return the board's corners in a picture: in its frame, shape (n, 3), m, and in pixels, shape (n, 2)."""
    board = _board(square_m)
    found: Any
    ids: Any  # None where there is none, whatever OpenCV's types say
    found, ids, _, _ = cv2.aruco.CharucoDetector(board).detectBoard(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY))
    count = 0 if ids is None else len(ids)
    if count < _CORNERS_MIN:
        most = (_COLUMNS - 1) * (_ROWS - 1)
        raise CalibrationError(
            f"pictures[{number}]", f"shows {count} of the board's {most} corners, not {_CORNERS_MIN}"
        )
    at = np.asarray(board.getChessboardCorners(), float)[np.ravel(ids)]
    middle = np.array([_COLUMNS * square_m / 2.0, _ROWS * square_m / 2.0, 0.0])
    return (at - middle) * [1.0, -1.0, 1.0], np.asarray(found, float).reshape(-1, 2)


def board_picture(dots_per_m: float) -> Image:
    """Return the board alone, grey, at a resolution (dots per metre)."""
    size = (round(_COLUMNS * SQUARE_M * dots_per_m), round(_ROWS * SQUARE_M * dots_per_m))
    return np.asarray(_board(SQUARE_M).generateImage(size), np.uint8)


def board_page(kind: Literal["pdf", "png"]) -> bytes:
    """Return the board on a sheet of A4, with its size and its axes, as a file."""
    from PIL import Image as Pillow  # here, because only pictures need it
    from PIL import ImageDraw, ImageFont

    dots_per_m = _DPI / 0.0254
    width, height = (round(side * dots_per_m) for side in _PAPER_M)
    page, board = Pillow.new("L", (width, height), 255), Pillow.fromarray(board_picture(dots_per_m))
    left, top = (width - board.width) // 2, (height - board.height) // 2
    page.paste(board, (left, top))
    text = f"Pleat: a square is {1000 * SQUARE_M:g} mm wide; print at 100 %.  x to the right, y up, from the middle."
    font = ImageFont.load_default(size=36)
    ImageDraw.Draw(page).text((left, top + board.height + 24), text, fill=0, font=font)
    written = BytesIO()
    if kind == "pdf":
        page.save(written, "PDF", resolution=_DPI)
    else:
        page.save(written, "PNG", dpi=(_DPI, _DPI))
    return written.getvalue()


def _board(square_m: float) -> cv2.aruco.CharucoBoard:
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_5X5_100)
    return cv2.aruco.CharucoBoard((_COLUMNS, _ROWS), square_m, _MARKER * square_m, dictionary)
