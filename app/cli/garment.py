"""``pleat dag`` and ``pleat check``: information about a garment that needs no robot."""

from typing import Annotated

import typer

from app.cli.program import (
    NO_PLAN,
    STANDARD_OUTPUT,
    DataOption,
    JsonOption,
    SourceArgument,
    blaming,
    cli,
    errors,
    garment_of,
    output,
    write_json,
)
from app.tables import check_table, dag_table
from planner import check_garment, fold_dag
from planner.planning.robot_task import default_scene
from planner.task.task import DEFAULT_ROBOT
from planner.words.catalogue import sentence


@cli.command()
def dag(garment: SourceArgument, json_to: JsonOption = None) -> None:
    """Print which fold waits for which."""
    chosen = garment_of(garment)
    with blaming(garment):
        answer = fold_dag(chosen).to_dict()
    write_json(answer, json_to)
    if json_to != STANDARD_OUTPUT:
        output.print(dag_table(chosen, answer["edges"]))


@cli.command()
def check(
    garment: SourceArgument,
    robot: Annotated[
        str, typer.Option(help="The robot whose grippers hold them: its name, or the file of its card.")
    ] = DEFAULT_ROBOT,
    json_to: JsonOption = None,
    data: DataOption = None,
) -> None:
    """Check that a garment file is good, its folds are legal, and each can be held by the robot's grippers."""
    chosen = garment_of(garment)
    with blaming(garment):
        report = check_garment(chosen, default_scene(robot), robot=robot)
    write_json(report.to_dict(), json_to)
    if json_to != STANDARD_OUTPUT:
        output.print(check_table(chosen, report))
    for index, fold in enumerate(report.folds):
        if fold.reason is not None:
            why = sentence(fold.reason.says, chosen.folds, index)
            errors.print(f"{garment}: folds[{index}]: the grippers cannot hold it: {why}")
    if not report.is_holdable:
        raise typer.Exit(NO_PLAN)
