"""``pleat camera``: a board of markers to print, and a camera calibrated with pictures of it."""

from pathlib import Path
from typing import Annotated

import typer

from app.cli.program import blaming, cli, failure, output, refusing, write_text
from app.rehearsal.camera.calibration import SQUARE_M, CalibrationError, Image, board_page, calibrated
from app.rehearsal.vision.picture import read_picture
from app.rehearsal.vision.vision_errors import PictureError
from planner.geometry.pose import Pose2

camera = typer.Typer(
    help="Print a board of markers, and calibrate a camera over the table with pictures of it.", no_args_is_help=True
)
cli.add_typer(camera, name="camera")


@camera.command()
def board(out: Annotated[Path, typer.Option(metavar="FILE", help="A .pdf or .png.")]) -> None:
    """Write the board of markers to print, at 100 %, on A4."""
    kind = out.suffix.lower()
    if kind not in (".pdf", ".png"):
        raise failure(f"--out: expected a .pdf or a .png; got {str(out)!r}")
    with refusing(out):
        out.write_bytes(board_page("pdf" if kind == ".pdf" else "png"))
    output.print(
        f"{out}: print it at 100 % and measure: a square should be {1000 * SQUARE_M:g} mm wide", soft_wrap=True
    )


@camera.command()
def calibrate(
    images: Annotated[
        list[Path],
        typer.Argument(metavar="IMAGES...", help="The board as it lies on the table, then at slants: 3 or more."),
    ],
    out: Annotated[Path, typer.Option(metavar="FILE", help="The calibration, as JSON.")],
    board_at: Annotated[
        str, typer.Option(metavar="X,Y,YAW", help="Its middle in the first picture, table frame (m, rad).")
    ] = "0,0,0",
    square_mm: Annotated[float, typer.Option(help="The side of a printed square (mm).", min=5.0, max=500.0)] = (
        1000 * SQUARE_M
    ),
) -> None:
    """Find a camera's lens, and where it is over the table."""
    with blaming("camera"):
        pictures = [_picture(path) for path in images]
        try:
            found = calibrated(pictures, square_mm / 1000.0, _pose(board_at))
        except CalibrationError as error:
            number = error.field.removeprefix("pictures[").removesuffix("]")
            raise failure(f"{images[int(number)] if number.isdigit() else 'IMAGES'}: {error.message}") from None
    write_text(found.file(), str(out))
    x_m, y_m, z_m = found.position_m
    output.print(
        f"{out}: the lens is at ({x_m:.3f}, {y_m:.3f}, {z_m:.3f}) m; corners within {found.error_px:.2f} pixels (rms)",
        soft_wrap=True,
    )


def _picture(path: Path) -> Image:
    from app.cli.see import picture_file

    try:
        return read_picture(picture_file(path)).image
    except PictureError as error:
        raise failure(f"{path}: {error.message}") from None


def _pose(said: str) -> Pose2:
    try:
        x_m, y_m, yaw_rad = (float(part) for part in said.split(","))
    except ValueError:
        raise failure(f"--board-at: expected X,Y,YAW (m, rad), as in 0.1,0,1.57; got {said!r}") from None
    return Pose2(x_m, y_m, yaw_rad)
