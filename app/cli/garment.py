"""``pleat dag`` and ``pleat check``: information about a garment that needs no robot."""

from typing import Annotated

import typer

from app.cli import program
from app.tables import check_table, dag_table
from planner import check_garment, fold_dag
from planner.planning.robot_task import default_scene
from planner.task.task import DEFAULT_ROBOT
from planner.words.catalogue import sentence


@program.cli.command()
def dag(garment: program.SourceArgument, json_to: program.JsonOption = None) -> None:
    """Print which fold waits for which."""
    chosen = program.garment_of(garment)
    with program.blaming(garment):
        answer = fold_dag(chosen).to_dict()
    program.print_answer(answer, json_to, dag_table(chosen, answer["edges"]))


@program.cli.command()
def check(
    garment: program.SourceArgument,
    robot: Annotated[
        str, typer.Option(help="The robot whose grippers hold them: its name, or the file of its card.")
    ] = DEFAULT_ROBOT,
    json_to: program.JsonOption = None,
    data: program.DataOption = None,
) -> None:
    """Check that a garment file is good, its folds are legal, and each can be held by the robot's grippers."""
    chosen = program.garment_of(garment)
    with program.blaming(garment):
        report = check_garment(chosen, default_scene(robot), robot=robot)
    program.print_answer(report.to_dict(), json_to, check_table(chosen, report))
    for index, fold in enumerate(report.folds):
        if fold.reason is not None:
            why = sentence(fold.reason.says, chosen.folds, index)
            program.errors.print(f"{garment}: folds[{index}]: the grippers cannot hold it: {why}")
    if not report.is_holdable:
        raise typer.Exit(program.NO_PLAN)
