"""``pleat serve``."""

from pathlib import Path
from typing import Annotated, Any

import typer
from pydantic import ValidationError

from app.cli.program import DatabaseOption, cli, failure, output, tell_of_compiling
from app.settings import Settings
from planner.errors import FoldingError, RequestError
from planner.strict_model import first_error


@cli.command()
def serve(
    host: Annotated[str | None, typer.Option(help="The address to listen on. [default: 127.0.0.1]")] = None,
    port: Annotated[int | None, typer.Option(min=0, max=65535, help="0 picks a free one. [default: 8000]")] = None,
    data: Annotated[Path | None, typer.Option(help="Folder for everything that is kept.")] = None,
    database: DatabaseOption = None,
    root_path: Annotated[
        str | None, typer.Option(help="The prefix below which a proxy shows the pages, as in /pleat.")
    ] = None,
    origin: Annotated[
        str | None, typer.Option(help="Where a proxy shows them, as in https://example.org, if it keeps that as Host.")
    ] = None,
    insecure: Annotated[
        bool | None, typer.Option("--insecure", help="Let other machines in without the token.")
    ] = None,
    token_file: Annotated[
        Path | None,
        typer.Option(help="A file with the token to ask for, on this machine too; made if it is not there."),
    ] = None,
    new_token: Annotated[
        bool | None, typer.Option("--new-token", help="Make a new token; the old one does not hold any more.")
    ] = None,
    log_json: Annotated[
        bool | None, typer.Option("--log-json", help="Write the log as JSON, an object a line.")
    ] = None,
) -> None:
    """Serve the designer until Ctrl-C.

    Where other machines can reach it, everybody is asked for a token, which is printed at the first start.
    """
    from app.server.serve import serve as serve_settings  # here, because this import takes a second

    proxy = {"root_path": root_path, "origin": origin}
    access = {"insecure": insecure, "token_file": token_file, "new_token": new_token, "log_json": log_json}
    kept = {"data": data, "database": database}
    given: dict[str, Any] = {"host": host, "port": port, **kept, **access, **proxy}
    try:
        settings = Settings(**{name: value for name, value in given.items() if value is not None})
    except ValidationError as error:
        raise failure(str(first_error(error, RequestError))) from None
    try:
        serve_settings(settings, _announce)
    except KeyboardInterrupt:
        return
    except FoldingError as error:
        raise failure(str(error)) from None
    except OSError as error:
        raise failure(f"cannot serve on {settings.host}:{settings.port}: {error.strerror}") from None


def _announce(url: str, token: str | None) -> None:
    """Print where the server is, and whether the planner is compiled first; a new token is printed this one time."""
    if token is None:
        output.print(f"Pleat is on {url} (Ctrl-C stops it)")
    else:
        output.print(f"Pleat is on {url}/?token={token} (Ctrl-C stops it)", soft_wrap=True)
        output.print("It asks for this token, which is not shown again; --new-token makes another.")
    tell_of_compiling(on=output)  # standard error is the log
