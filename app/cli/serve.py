"""``pleat serve``."""

from pathlib import Path
from typing import Annotated, Any

import typer
from pydantic import ValidationError

from app.cli.program import cli, failure, output
from app.settings import Settings
from planner.errors import FoldingError, RequestError
from planner.strict_model import first_error


@cli.command()
def serve(
    host: Annotated[str | None, typer.Option(help="The address to listen on. [default: 127.0.0.1]")] = None,
    port: Annotated[int | None, typer.Option(min=0, max=65535, help="0 picks a free one. [default: 8000]")] = None,
    data: Annotated[Path | None, typer.Option(help="Folder for your own garments and documents.")] = None,
    root_path: Annotated[
        str | None, typer.Option(help="The prefix below which a proxy shows the pages, as in /pleat.")
    ] = None,
    origin: Annotated[
        str | None, typer.Option(help="Where a proxy shows them, as in https://example.org, if it keeps that as Host.")
    ] = None,
    insecure: Annotated[
        bool | None, typer.Option("--insecure", help="Let other machines in, without asking who they are.")
    ] = None,
) -> None:
    """Serve the designer until Ctrl-C."""
    from app.server.serve import serve as serve_settings  # here, because this import takes a second

    proxy = {"root_path": root_path, "origin": origin}
    given: dict[str, Any] = {"host": host, "port": port, "data": data, "insecure": insecure, **proxy}
    try:
        settings = Settings(**{name: value for name, value in given.items() if value is not None})
    except ValidationError as error:
        raise failure(str(first_error(error, RequestError))) from None
    try:
        serve_settings(settings, lambda url: output.print(f"Pleat is on {url} (Ctrl-C stops it)"))
    except KeyboardInterrupt:
        return
    except FoldingError as error:
        raise failure(str(error)) from None
    except OSError as error:
        raise failure(f"cannot serve on {settings.host}:{settings.port}: {error.strerror}") from None
