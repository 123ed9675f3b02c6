"""The command line: ``pleat serve``, ``plan``, ``dag``, ``check``.

Exit status: 0 done; 2 bad input or usage; 3 there is no plan, or a fold cannot be held; 4 the budget ran out.
"""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, TypedDict

import typer
from pydantic import ValidationError
from rich.console import Console

from app.settings import Settings
from app.tables import check_table, dag_table, plan_table, suggestion_table
from planner import check_garment, fold_dag, load_garment, make_plan
from planner.cloth.garment_files import read_json
from planner.errors import FieldError, FoldingError, RequestError, SceneError
from planner.plan.plan import Plan
from planner.plan.suggestions import suggestions
from planner.strict_model import first_error
from planner.task.scene import Scene

BAD_INPUT, NO_PLAN, OUT_OF_BUDGET = 2, 3, 4
STANDARD_OUTPUT = "-"

_OPTION_OF = {"start_station": "start"}

cli = typer.Typer(
    help="Plan how a robot can really fold a garment, and show it.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
_errors = Console(stderr=True, highlight=False, soft_wrap=True, markup=False)
_output = Console(highlight=False, markup=False)

GarmentArgument = Annotated[str, typer.Argument(metavar="GARMENT", help="The name of a garment, or a file.")]
JsonOption = Annotated[
    str | None, typer.Option("--json", metavar="FILE|-", help="Write JSON there; - prints it alone.")
]


class HeuristicName(StrEnum):
    """What the search may know about the way that is left."""

    ARM_TIME = "arm_time"
    ZERO = "zero"


class _Options(TypedDict):
    """Options of a plan request."""

    start_station: str
    comfort_radius_m: float
    heuristic: str
    time_limit_s: float


def main() -> None:
    """The entry point of the package."""
    cli()


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
    from app.server.serve import serve as serve_settings  # takes a second: only when it is needed

    proxy = {"root_path": root_path, "origin": origin}
    given: dict[str, Any] = {"host": host, "port": port, "data": data, "insecure": insecure, **proxy}
    try:
        settings = Settings(**{name: value for name, value in given.items() if value is not None})
    except ValidationError as error:
        raise _failure(str(first_error(error, RequestError))) from None
    try:
        serve_settings(settings, lambda url: _output.print(f"Pleat is on {url} (Ctrl-C stops it)"))
    except KeyboardInterrupt:
        return
    except FoldingError as error:
        raise _failure(str(error)) from None
    except OSError as error:
        raise _failure(f"cannot serve on {settings.host}:{settings.port}: {error.strerror}") from None


@cli.command()
def plan(
    garment: GarmentArgument,
    comfort_radius_m: Annotated[float, typer.Option(help="How much slack every reach has (m).")] = 0.03,
    scene: Annotated[Path | None, typer.Option(help="A scene file.")] = None,
    start: Annotated[str, typer.Option(help="The station where the robot starts.")] = "front",
    heuristic: HeuristicName = HeuristicName.ARM_TIME,
    time_limit_s: Annotated[float, typer.Option(help="How long to search (s).")] = 10.0,
    json_to: JsonOption = None,
    suggest: Annotated[bool, typer.Option("--suggest", help="Look for changes that give a (quicker) plan.")] = False,
) -> None:
    """Plan a garment's folds, and print the plan."""
    with _blaming(garment):
        chosen = load_garment(garment)
    with _blaming(scene):
        where = Scene() if scene is None else _scene(scene)
    options = _Options(
        start_station=start,
        comfort_radius_m=comfort_radius_m,
        heuristic=heuristic.value,
        time_limit_s=time_limit_s,
    )
    with _blaming(garment):
        answer = make_plan(chosen, where, **options)
    _write_json(answer.to_dict(), json_to)
    if answer.is_solved and json_to != STANDARD_OUTPUT:
        _output.print(plan_table(answer))
    status = _status(answer)
    if suggest and json_to != STANDARD_OUTPUT:
        _print_suggestions(answer, options)
    raise typer.Exit(status)


@cli.command()
def dag(garment: GarmentArgument, json_to: JsonOption = None) -> None:
    """Print which fold waits for which."""
    with _blaming(garment):
        chosen = load_garment(garment)
        answer = fold_dag(chosen).to_dict()
    _write_json(answer, json_to)
    if json_to != STANDARD_OUTPUT:
        _output.print(dag_table(chosen, answer["edges"]))


@cli.command()
def check(garment: GarmentArgument, json_to: JsonOption = None) -> None:
    """Check that a garment file is good, its folds are legal, and each can be held by two grippers."""
    with _blaming(garment):
        chosen = load_garment(garment)
        report = check_garment(chosen)
    _write_json(report.to_dict(), json_to)
    if json_to != STANDARD_OUTPUT:
        _output.print(check_table(chosen, report))
    for index, fold in enumerate(report.folds):
        if fold.problem is not None:
            _errors.print(f"{garment}: folds[{index}]: two grippers cannot hold it: {fold.problem}")
    if not report.is_holdable:
        raise typer.Exit(NO_PLAN)


def _scene(path: Path) -> Scene:
    data = read_json(path)
    if not isinstance(data, dict):
        raise SceneError("", "a scene file holds one JSON object")
    return Scene.from_dict(data)


def _print_suggestions(answer: Plan, options: _Options) -> None:
    found = list(suggestions(answer.garment, answer.scene, plan=answer, **options))
    if found:
        _output.print(suggestion_table(answer.garment, found))
    else:
        _output.print(f"No change was found within {options['time_limit_s']:g} s.")


def _status(answer: Plan) -> int:
    """The exit status for a plan; says why there is none."""
    if answer.status == "budget_exceeded":
        bound = answer.statistics.bound_s
        _errors.print("The budget ran out" + (f"; no plan is quicker than {bound:.2f} s" if bound else ""))
        return OUT_OF_BUDGET
    if answer.is_solved and not answer.is_proven:
        bound = answer.statistics.bound_s or 0.0
        why = "The budget ran out. " if answer.statistics.is_cut_short else ""
        _errors.print(f"{why}There may be a quicker plan, but none takes less than {bound:.2f} s")
    for reason in answer.reasons:
        met = "" if reason.is_tried else "; met on the way, not tried whether it is the cause"
        _errors.print(f"{reason.code.value}: {reason.message}{met}")
    return 0 if answer.is_solved else NO_PLAN


def _write_json(answer: dict[str, Any], target: str | None) -> None:
    if target is None:
        return
    text = json.dumps(answer, indent=1) + "\n"
    if target == STANDARD_OUTPUT:
        typer.echo(text, nl=False)
        return
    try:
        Path(target).write_text(text, encoding="utf-8")
    except OSError as error:
        raise _failure(f"{target}: {error.strerror}") from None


@contextmanager
def _blaming(source: object) -> Iterator[None]:
    """Have bad input end the program with the file, the field and what is wrong with it."""
    try:
        yield
    except RequestError as error:
        option = _OPTION_OF.get(error.field, error.field).replace("_", "-")
        raise _failure(f"--{option}: {error.message}") from None
    except FieldError as error:
        raise _failure(f"{source}: {error}") from None
    except FoldingError as error:
        raise _failure(str(error)) from None


def _failure(message: str) -> typer.Exit:
    _errors.print(message)
    return typer.Exit(BAD_INPUT)
