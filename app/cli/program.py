"""The program's shared options, output and exit codes.

What takes long to import is imported where it is used: not every command needs the planner.

Exit status: 0 done; 2 bad input or usage; 3 there is no plan, or a fold cannot be held; 4 the search ran out of time.
"""

import errno
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console, RenderableType

from app.cli.commands import cli as cli
from planner.errors import FieldError, FoldingError, RequestError
from planner.robots.own_robots import ROBOTS, use_robots_folder

if TYPE_CHECKING:
    from planner.cloth.garment import Garment
    from planner.task.plan import Plan

BAD_INPUT, NO_PLAN, OUT_OF_BUDGET = 2, 3, 4
STANDARD_OUTPUT = "-"

_OPTION_OF = {"start_station": "start", "to.like": "like"}

errors = Console(stderr=True, highlight=False, soft_wrap=True, markup=False)
output = Console(highlight=False, markup=False)

SourceArgument = Annotated[
    str, typer.Argument(metavar="GARMENT", help="The name of a garment, a garment file or a plan file.")
]


def in_a_folder(target: str | Path | None) -> str | Path | None:
    """Return a file to write; exit the program if its folder is missing, before what is to be written is made."""
    if target is not None and not Path(target).parent.is_dir():
        raise failure(f"{target}: {os.strerror(errno.ENOENT)}")
    return target


JsonOption = Annotated[
    str | None,
    typer.Option("--json", callback=in_a_folder, metavar="FILE|-", help="Write JSON there; - prints it alone."),
]


def _use_data(folder: Path | None) -> Path | None:
    if folder is not None:
        use_robots_folder(folder / ROBOTS)
    return folder


DataOption = Annotated[
    Path | None,
    typer.Option(
        "--data",
        callback=_use_data,
        help="The folder with your own robots, as `pleat serve` has it.",
        show_default="that of the server",
    ),
]
DatabaseOption = Annotated[
    str | None,
    typer.Option(
        metavar="URL",
        help="A PostgreSQL database, as in postgresql+psycopg://user@host/name. [default: SQLite in --data]",
    ),
]


def garment_of(source: str) -> "Garment":
    """Return the garment by name, from a garment file or from a plan file; exit the program if there is none."""
    from planner.task.plan import Plan

    found = load_source(source)
    return found.garment if isinstance(found, Plan) else found


def load_source(source: str) -> "Garment | Plan":
    """Return the garment or the plan by name or file; exit the program if there is none."""
    from planner.task.plan_files import load

    with blaming(source):
        return load(source)


def write_json(answer: Any, target: str | None) -> None:  # noqa: ANN401
    """Write JSON to a file or to standard output; do nothing for None."""
    if target is not None:
        write_text(json.dumps(answer, indent=1) + "\n", target)


def print_answer(answer: Any, json_to: str | None, shown: RenderableType) -> None:  # noqa: ANN401
    """Write an answer as JSON if that is asked for, and print it for people unless the JSON is printed alone."""
    write_json(answer, json_to)
    if json_to != STANDARD_OUTPUT:
        output.print(shown)


def write_text(text: str, target: str) -> None:
    """Write text to a file or to standard output; exit the program if the file cannot be written."""
    if target == STANDARD_OUTPUT:
        typer.echo(text, nl=False)
        return
    with refusing(target):
        Path(target).write_text(text, encoding="utf-8")


@contextmanager
def refusing(target: object) -> Iterator[None]:
    """Exit the program with the file's name if the system refuses to write it."""
    try:
        yield
    except OSError as error:
        raise failure(f"{target}: {error.strerror}") from None


def tell_of_compiling(*robots: str, on: Console = errors) -> None:
    """Say that the planner is compiled first, where it is: nothing else is seen for minutes."""
    from planner.planning.warm_up import must_compile
    from planner.task.task import DEFAULT_ROBOT

    if names := [robot for robot in robots or (DEFAULT_ROBOT,) if must_compile(robot)]:
        on.print(f"Compiling what plans for {', '.join(names)} (first use): a minute or more...")


@contextmanager
def blaming(source: object) -> Iterator[None]:
    """Exit the program on bad input, printing the file, the field and the problem."""
    try:
        yield
    except RequestError as error:
        if error.field.partition(".")[0].partition("[")[0] not in _OPTIONS:
            raise failure(f"{source}: {error}") from None
        option = _OPTION_OF.get(error.field, error.field).replace("_", "-")
        raise failure(f"--{option}: {error.message}") from None
    except FieldError as error:
        raise failure(f"{source}: {error}") from None
    except FoldingError as error:
        raise failure(str(error)) from None


_OPTIONS = frozenset(
    {"start_station", "comfort_radius_m", "heuristic", "time_limit_s", "rate_hz", "after_step", "robot", "runs", "seed"}
    | {"to", "count", "max_folds", "face", "speed", "from_step", "out"}
)


def failure(message: str) -> typer.Exit:
    """Print why the program ends; return the exception that ends it."""
    errors.print(message)
    return typer.Exit(BAD_INPUT)
