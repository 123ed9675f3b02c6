"""``pleat backup`` and ``pleat restore``: a data folder and its database as one file, and back."""

from pathlib import Path
from typing import Annotated

import typer

from app.cli.program import DatabaseOption, blaming, cli, output
from app.settings import Settings
from app.store import backup as backups
from app.store.data_folder import DataFolder

DataOption = Annotated[Path | None, typer.Option(help="The data folder. [default: the one that `serve` uses]")]


@cli.command()
def backup(
    file: Annotated[Path, typer.Argument(help="The file to write, as in pleat.tar.gz.")],
    data: DataOption = None,
    database: DatabaseOption = None,
) -> None:
    """Write a data folder and its database to one file; the server may be running."""
    folder = _folder(data)
    with blaming(file):
        count = backups.back_up(folder, file, database or Settings().database)
    output.print(f"{count} files of {folder.path} are in {file}", soft_wrap=True)


@cli.command()
def restore(
    file: Annotated[Path, typer.Argument(help="A file that `backup` has written.")],
    data: DataOption = None,
    database: DatabaseOption = None,
) -> None:
    """Make a data folder and a database of a backup; both must be new or empty."""
    folder = _folder(data)
    with blaming(file):
        count = backups.restore(file, folder, database or Settings().database)
    output.print(f"{count} files are in {folder.path}", soft_wrap=True)


def _folder(data: Path | None) -> DataFolder:
    return DataFolder(Settings().data if data is None else data)
