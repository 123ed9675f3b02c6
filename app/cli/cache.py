"""``pleat cache``: what is kept for later runs, and its removal."""

import shutil
from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from app.cli.program import cli, output, refusing
from planner.user_cache import CACHES, cache_folder


@cli.command()
def cache(
    is_clearing: Annotated[
        bool, typer.Option("--clear", help="Remove all of it; it is made again when needed.")
    ] = False,
) -> None:
    """Print what is kept for later runs, and how large it is."""
    folder = cache_folder()
    if is_clearing:
        freed = _size(folder)
        with refusing(folder):
            if folder.exists():
                shutil.rmtree(folder)
        output.print(f"{folder}: {_megabytes(freed)} removed", soft_wrap=True)
        return
    table = Table(header_style="bold", caption=str(folder), caption_justify="left")
    for name in ("folder", "holds", "kept", "at most", "size"):
        table.add_column(name, justify="left" if name in ("folder", "holds") else "right")
    for name, kind in CACHES.items():
        kept = folder / name
        count = len(list(kept.iterdir())) if kept.is_dir() else 0
        table.add_row(name, kind.holds, str(count), str(kind.kept_max), _megabytes(_size(kept)))
    output.print(table)


def _size(folder: Path) -> int:
    """Return the bytes of all files in a folder; none where there is no folder."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def _megabytes(size: int) -> str:
    return f"{size / 1e6:.1f} MB"
