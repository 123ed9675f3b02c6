"""``pleat rehearse``: perform a plan in simulated worlds, and judge every step."""

from enum import StrEnum
from typing import Annotated

import typer
from rich.progress import Progress
from rich.table import Table

from app.cli import program
from app.rehearsal.rehearse import RehearsalOptions, rehearse
from app.rehearsal.result import RehearsalResult
from app.step_kinds import step_words
from planner import Plan, make_plan
from planner.errors import RequestError
from planner.planning.robot_task import task_for
from planner.task.task import DEFAULT_ROBOT


class NoiseName(StrEnum):
    """The errors of a rehearsal."""

    NONE = "none"
    REAL = "real"


class Switch(StrEnum):
    """A choice between on and off."""

    ON = "on"
    OFF = "off"


@program.cli.command("rehearse")
def rehearse_command(
    source: program.SourceArgument,
    robot: Annotated[str | None, typer.Option(help="The robot, for a garment.", show_default=DEFAULT_ROBOT)] = None,
    runs: Annotated[int, typer.Option(help="How often the plan is performed.")] = 1,
    seed: Annotated[int, typer.Option(help="The seed of the first run; each after it has the next.")] = 0,
    noise: Annotated[NoiseName, typer.Option(help="The errors of robot, cloth and camera.")] = NoiseName.NONE,
    feedback: Annotated[Switch, typer.Option(help="Look before each step, and correct it.")] = Switch.ON,
    json_to: program.JsonOption = None,
    data: program.DataOption = None,
) -> None:
    """Perform a plan in simulated physics, and say of every step whether it holds."""
    with program.blaming(source):
        options = RehearsalOptions(runs, seed, noise.value, feedback is Switch.ON)
        found = program.load_source(source)
        if isinstance(found, Plan) and robot not in (None, found.task.robot):
            raise RequestError("robot", f"the plan is one for {found.task.robot}")
        if not isinstance(found, Plan):
            program.tell_of_compiling(robot or DEFAULT_ROBOT)
        plan = found if isinstance(found, Plan) else make_plan(task_for(found, robot=robot or DEFAULT_ROBOT))
        if not plan.is_solved:
            program.errors.print(f"{source}: the plan is {plan.status}, so there is nothing to rehearse")
            raise typer.Exit(program.NO_PLAN)
        with Progress(console=program.errors, transient=True) as bar:
            task = bar.add_task("Rehearsing", total=1.0)
            result = rehearse(plan, options, lambda share: bar.update(task, completed=share))
    program.print_answer(result.to_dict(), json_to, _table(plan, result))
    if not result.is_held:
        raise typer.Exit(program.NO_PLAN)


def _table(plan: Plan, result: RehearsalResult) -> Table:
    """Return the verdicts of the first run as a table, one row for each step, below how many runs held."""
    low, high = (result.to_dict()[name] for name in ("success_low", "success_high"))
    held = f"{result.held} of {len(result.runs)} held (95 % confidence: {low:.0%} to {high:.0%})"
    table = Table(title=f"{plan.garment.title}: {held}", title_justify="left", header_style="bold")
    for name in ("step", "what", "overlap", "mean [mm]", "95 % [mm]", "slid [mm]", "verdict"):
        table.add_column(name, justify="left" if name in ("what", "verdict") else "right")
    for verdict in result.runs[0].steps:
        what = "" if verdict.of_plan is None else step_words(plan.steps[verdict.of_plan], plan.garment)
        empty = f", {' and '.join(verdict.empty)} found no cloth" if verdict.empty else ""
        numbers = (f"{number:.1f}" for number in (verdict.mean_mm, verdict.p95_mm, verdict.slid_mm))
        verdict_text = ("held" if verdict.held else "lost") + empty
        table.add_row(str(verdict.step), what, f"{verdict.iou:.3f}", *numbers, verdict_text)
    if reason := result.runs[0].reason:
        table.add_row("", reason, *[""] * 5)
    return table
