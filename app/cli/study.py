"""``pleat study`` and ``pleat study-plan``."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

from app.cli.program import blaming, cli, errors, failure, output, refusing
from app.studies.report import FILE as REPORT
from app.studies.results import Results
from app.studies.run_study import Progress, run_study
from app.studies.study import Study
from app.studies.study_file import read_study
from app.studies.table import written_files
from app.studies.workers import InProcess, LocalWorkers, Workers, cluster, planner
from planner.task.plan_files import write_plan

INTERRUPTED = 130
"""The exit status after Ctrl-C."""


@cli.command()
def study(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A study: garments, tables, placements... as TOML.")],
    out: Annotated[Path, typer.Option(metavar="DIR", help="The folder of the results.")],
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes; 1 plans in this one.", show_default="one a core")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="A Dask scheduler, such as tcp://host:8786.")
    ] = None,
    resume: Annotated[bool, typer.Option(help="Go on where the study was interrupted, or begin anew.")] = True,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Plan the cells again that failed.")] = False,
    keep_plans: Annotated[bool, typer.Option("--keep-plans", help="Keep every plan's file, compressed.")] = False,
    count: Annotated[bool, typer.Option("--count", help="Only say how many cells there are.")] = False,
) -> None:
    """Plan the product of garments, robots, tables, placements and limits: one table, one report."""
    if workers is not None and scheduler is not None:
        raise failure("--workers: not together with --scheduler")
    with blaming(file):
        asked = read_study(file)
    output.print(_size(asked), soft_wrap=True)
    if count:
        return
    with blaming(file), refusing(out), Results(out) as results:
        results.begin(asked, resume=resume)
        if retry_failed:
            results.forget_failed()
        with _workers(workers, scheduler) as team:
            try:
                end = _run(asked, results, team, keep_plans)
            except KeyboardInterrupt:
                errors.print(f"Stopped. The answers so far are in {out}; the same command goes on from there.")
                raise typer.Exit(INTERRUPTED) from None
    output.print(f"{end.count:,} cells, {end.failed:,} of those planned now failed.")
    output.print(f"{out}: {', '.join((REPORT, *written_files()))}", soft_wrap=True)


@cli.command()
def study_plan(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="The folder of a study's results.")],
    cell: Annotated[int, typer.Argument(metavar="CELL", help="The cell's number in the table.")],
    out: Annotated[Path, typer.Option(metavar="FILE", help="The plan file to write.")],
) -> None:
    """Make the plan of one cell of a study again, and write it as a plan file."""
    if not folder.is_dir():
        raise failure(f"{folder}: is no folder")
    with blaming(folder):
        with Results(folder) as results:
            known = results.study()
        if known is None:
            raise failure(f"{folder}: holds no study")
        if not 0 <= cell < known.product:
            raise failure(f"CELL: {cell} is not between 0 and {known.product - 1}")
        found = known.cell(cell)
        if found.task is None:
            raise failure(f"cell {cell}: {found.error}")
        plan = planner()(found.task)
    with refusing(out):
        write_plan(plan, out)
    output.print(f"{out}: {plan.status}" + ("" if plan.cost_s is None else f", {plan.cost_s:.2f} s"))


def _size(asked: Study) -> str:
    varied = " x ".join(f"{len(axis.values)} {axis.name}" for axis in asked.all_axes if len(axis.values) > 1)
    drawn = f", drawn from {asked.product:,}" if asked.count < asked.product else ""
    return f"{asked.title}: {asked.count:,} cells{drawn}" + (f" ({varied})" if varied else "")


@contextmanager
def _workers(count: int | None, scheduler: str | None) -> Iterator[Workers]:
    if scheduler is not None:
        with cluster(scheduler) as team:
            yield team
        return
    processes = count or os.cpu_count() or 1
    yield InProcess() if processes == 1 else LocalWorkers(processes)


def _run(asked: Study, results: Results, team: Workers, keep_plans: bool) -> Progress:
    columns = (BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn())
    with Bar(TextColumn("{task.description}"), *columns, console=errors, refresh_per_second=2) as bar:
        line = bar.add_task("Planning", total=asked.count)

        def tell(now: Progress) -> None:
            if now.done == now.begun_with:
                bar.reset(line, completed=now.done)  # the speed is that of this run alone
            bar.update(line, completed=now.done, description=f"{now.solved:,} solved, {now.failed:,} failed")

        return run_study(asked, results, team, tell, keep_plans=keep_plans)
