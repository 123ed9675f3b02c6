"""``pleat export``."""

from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from app.cli.program import blaming, cli, failure, load_source, output, refusing
from app.distribution import missing
from app.files.export import DEFAULT_RATE_HZ, Export
from app.files.exports import EXPORTS, find_export
from app.files.folder_file import ZIP, unpack


@cli.command()
def export(
    source: Annotated[
        str | None, typer.Argument(metavar="FILE", help="A plan file, a garment file or a garment.")
    ] = None,
    to: Annotated[str | None, typer.Option(metavar="KIND", help="The kind of file; see --list.")] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="PATH", help="Output path; by default a name here. A folder is zipped where this ends in .zip."
        ),
    ] = None,
    rate_hz: Annotated[float, typer.Option(help="Frames a second of a recording (1..30).")] = DEFAULT_RATE_HZ,
    speed: Annotated[
        float, typer.Option(help="The motion's speed as a share of the planned one (0.05..1); poses stay the same.")
    ] = 1.0,
    is_listing: Annotated[bool, typer.Option("--list", help="Print the kinds of files.")] = False,
) -> None:
    """Make a file of a plan, or of a garment, which is planned first where the kind needs that."""
    if is_listing:
        output.print(_kinds())
        return
    if source is None or to is None:
        raise failure("export: needs a FILE and --to KIND; --list prints the kinds")
    kind = find_export(to)
    if kind is None:
        raise failure(f"--to: expected one of {', '.join(one.what for one in EXPORTS)}; got {to!r}")
    from app.files.slowed import require_speed

    if (lacking := missing(*kind.needs)) is not None:  # before it is planned
        raise failure(lacking.text)
    with blaming(source):
        require_speed(speed)
    data, name = _made(kind, source, rate_hz, speed)
    path = out or Path(name)
    with refusing(path):
        if kind.is_folder and path.suffix != ZIP:
            unpack(data, path)
        else:
            path.write_bytes(data)
    output.print(f"{path}: {len(data)} bytes")


def _made(kind: Export, source: str, rate_hz: float, speed: float) -> tuple[bytes, str]:
    """Return a file's content and its default name."""
    from app.files.slowed import slowed
    from app.files.state_of_plan import state_of_garment, state_of_plan
    from planner import Garment, make_plan

    found = load_source(source)
    with blaming(source):
        if isinstance(found, Garment) and not kind.needs_plan:
            state = state_of_garment(found)
        else:
            plan = make_plan(found) if isinstance(found, Garment) else found
            state = state_of_plan(slowed(plan, speed))
        return kind.file(state, rate_hz, lambda: False), kind.filename(state).removesuffix(ZIP)


def _kinds() -> Table:
    table = Table(header_style="bold")
    for name in ("kind", "what", "file"):
        table.add_column(name)
    for one in EXPORTS:
        table.add_row(one.what, one.text, f"NAME{one.ending.removesuffix(ZIP)}")
    return table
