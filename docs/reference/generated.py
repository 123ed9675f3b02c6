"""Write the pages of the reference that the code itself says: the command line and the REST routes."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the generated pages to those of the folder."""
    for name, lines in (("cli", _command_line()), ("rest", _routes())):
        files.append(File.generated(config, f"reference/{name}.md", content="\n".join(lines) + "\n"))
    return files


def _command_line() -> Iterator[str]:
    """Yield the lines of a page with every command, its arguments and options."""
    from app.cli.commands import COMMANDS, loaded

    yield "# Command line"
    yield ""
    yield "`pleat --install-completion` has the shell complete commands and options."
    for name in COMMANDS:
        yield from _command(f"pleat {name}", loaded(name))


def _command(name: str, command: click.Command) -> Iterator[str]:
    yield from ("", f"## {name}", "", _plain(command.help))
    yield from ("", *(command.epilog or "").splitlines())
    if isinstance(command, click.Group):
        for inner, below in command.commands.items():
            yield from _command(f"{name} {inner}", below)
        return
    context = click.Context(command, info_name=name)
    yield from ("", "```", " ".join([name, *command.collect_usage_pieces(context)]), "```", "")
    shown = [one for one in command.params if not getattr(one, "hidden", False) and one.name != "help"]
    if not shown:
        return
    yield from ("| | what |", "|---|---|")
    for one in shown:
        written = ", ".join(f"`{text}`" for text in one.opts) if one.param_type_name == "option" else f"`{one.name}`"
        default = getattr(one, "default", None)
        is_told = default is not None and not callable(default) and default is not False and str(default) != ""
        yield f"| {written} | {_plain(getattr(one, 'help', ''))}{f' Default: `{default}`.' if is_told else ''} |"


def _routes() -> Iterator[str]:
    """Yield the lines of a page with every REST route; a running server describes their fields under /docs."""
    from app.api.create_app import create_app
    from app.settings import Settings

    yield "# REST"
    yield ""
    yield "A running server describes every field under `/docs`. Errors are `application/problem+json`: a status and"
    yield "`errors`, each with the field's name and a sentence. What may take long is a job: 202, and its address."
    described: dict[str, Any] = create_app(Settings(data=Path("nowhere"))).openapi()  # no data folder is opened
    by_tag: dict[str, list[tuple[str, str, dict[str, Any]]]] = {}
    for path, methods in described["paths"].items():
        for method, route in methods.items():
            by_tag.setdefault(path.split("/")[2], []).append((method.upper(), path, route))
    for tag, routes in sorted(by_tag.items()):
        yield from ("", f"## {tag}", "", "| route | what it does |", "|---|---|")
        for method, path, route in routes:
            yield f"| `{method} {path}` | {_plain(route.get('description') or route.get('summary'))} |"


def _plain(text: str | None) -> str:
    """Return a text's first paragraph on one line, safe in a table."""
    first = re.sub(r"\s+", " ", (text or "").strip().partition("\n\n")[0])
    return first.replace("|", "\\|").replace("<", "&lt;")
