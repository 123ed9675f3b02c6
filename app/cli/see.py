"""``pleat see``: the garment in a picture."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from app.cli import program
from app.rehearsal.camera.calibration import Calibration, CalibrationError
from app.rehearsal.vision.seen_garment import Seen
from app.rehearsal.vision.seen_garment import see as see_garment
from app.rehearsal.vision.seen_state import SeenState, see_state
from app.rehearsal.vision.stack_fit import FoldFit
from app.rehearsal.vision.vision_errors import LARGEST_PICTURE, NothingToldError, PictureError, ScaleNeededError
from app.templates.catalogue import find_template
from planner.cloth.garment import Garment
from planner.task.plan import Plan


@program.cli.command()
def see(
    image: Annotated[Path, typer.Argument(metavar="IMAGE", help="A PNG or JPEG of a garment on a table.")],
    scale: Annotated[
        str | None,
        typer.Option(
            metavar="SCALE",
            help="What gives the scale: a4, letter, marker:50mm (an ArUco marker's black square), or a length of the "
            "garment: 0.60m:longest, 24in:width, 70cm:height. Without it a sheet of A4 or Letter is looked for.",
        ),
    ] = None,
    like: Annotated[
        str | None,
        typer.Option(
            metavar="GARMENT|TEMPLATE",
            help="What it is like: a template's measures, or a garment's width and height, are fitted, and its folds "
            "brought along.",
        ),
    ] = None,
    state: Annotated[
        str | None,
        typer.Option(
            "--state-of",
            metavar="GARMENT|PLAN",
            help="Say which of this garment's folds are done in the picture, how far off the last crease is, and how "
            "neat the stack is.",
        ),
    ] = None,
    calibration: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="The camera that took it, as `pleat camera calibrate` found it: no --scale."),
    ] = None,
    json_to: program.JsonOption = None,
) -> None:
    """Read a garment from a picture: its outline, where it lies, how sure that is; or how far it is folded."""
    if like is not None and state is not None:
        raise program.failure("--like and --state-of cannot be given together")
    if calibration is not None and scale is not None:
        raise program.failure("--scale and --calibration cannot be given together")
    scaled = scale if calibration is None else calibration_file(calibration)
    if state is not None:
        _see_state(image, scaled, program.load_source(state), json_to)
        return
    kind = None if like is None else find_template(like) or program.garment_of(like)
    with telling(image):
        found = see_garment(picture_file(image), image.stem, scaled, kind)
    program.print_answer(found.to_dict(), json_to, _seen_text(found))
    if found.sure.unknown is not None:
        program.errors.print(f"{image}: not sure: {found.sure.unknown.text}")


def _see_state(image: Path, scale: str | Calibration | None, of: Garment | Plan, json_to: str | None) -> None:
    """Print and write which state of a garment's folds a picture shows."""
    garment, plan = (of.garment, of) if isinstance(of, Plan) else (of, None)
    with telling(image):
        found = see_state(picture_file(image), scale, garment, plan)
    program.print_answer(found.to_dict(), json_to, _state_text(found))
    if found.unknown is not None:
        program.errors.print(f"{image}: not sure: {found.unknown.text}")


def calibration_file(path: Path) -> Calibration:
    """Return the calibration in a file; exit the program if it is none."""
    try:
        return Calibration.read(path)
    except OSError as error:
        raise program.failure(f"{path}: {error.strerror}") from None
    except CalibrationError as error:
        raise program.failure(f"{path}: {error}") from None


def picture_file(path: Path) -> bytes:
    """Return a picture's content; exit the program if it cannot be read."""
    try:
        if path.stat().st_size > LARGEST_PICTURE:
            raise program.failure(f"{path}: has {path.stat().st_size} bytes, more than {LARGEST_PICTURE}")
        return path.read_bytes()
    except OSError as error:
        raise program.failure(f"{path}: {error.strerror}") from None


@contextmanager
def telling(source: Path) -> Iterator[None]:
    """Exit the program if a picture is bad input or shows nothing that can be recognised."""
    with program.blaming(source):
        try:
            yield
        except NothingToldError as error:
            program.errors.print(f"{source}: {error}")
            raise typer.Exit(program.NO_PLAN) from None
        except ScaleNeededError as error:
            raise program.failure(f"{source}: --scale: {error}") from None
        except PictureError as error:
            if error.field != "scale":
                raise
            raise program.failure(f"--scale: {error.message}") from None


def _state_text(found: SeenState) -> str:
    """Return which state was seen, in a few lines."""
    done = ", ".join(str(index + 1) for index in found.folds) or "none"
    lines = [f"{found.garment.title}: folds done: {done}; the scale from the {found.scale_from}"]
    fit = found.found.fit
    if isinstance(fit, FoldFit):
        lines.append(
            f"the last crease is {fit.offset_m:+.3f} m (within {fit.offset_error_m:.3f} m) to the left of its line, "
            f"turned by {fit.turn_rad:+.3f} rad; the part that moved is {fit.off_m:.3f} m off"
        )
    place = found.found.stack.placement
    lines.append(f"it lies in the frame of the {found.frame} at ({place.x_m:.3f}, {place.y_m:.3f}) m, ")
    lines[-1] += f"turned by {place.yaw_rad:.3f} rad"
    lines.append(found.neatness.text)
    return "\n".join(lines)


def _seen_text(found: Seen) -> str:
    """Return what was read, in a few lines."""
    width, height = (max(axis) - min(axis) for axis in zip(*found.garment.outline, strict=True))
    place, sure = found.placement, found.sure
    return "\n".join(
        [
            f"{found.garment.title}: {width:.3f} m by {height:.3f} m, {len(found.garment.outline)} corners, "
            f"{len(found.garment.folds)} folds; the scale from the {found.scale_from}",
            f"it lies in the frame of the {found.frame} at ({place.x_m:.3f}, {place.y_m:.3f}) m, "
            f"turned by {place.yaw_rad:.3f} rad",
            f"{sure.share:.0%} of the outline within {sure.within_m:.3f} m; two ways to find it agree on "
            f"{sure.agreement:.0%}",
            *(note.text for note in found.notes),
        ]
    )
