"""``pleat propose``: ways to fold a garment to a size, each planned for a robot."""

from dataclasses import replace
from typing import Annotated

import typer

from app.cli import program
from app.tables import proposals_table
from planner import propose_folds
from planner.proposals.proposals import Face, all_proposals
from planner.task.task import DEFAULT_ROBOT


@program.cli.command("propose")
def propose(
    garment: program.SourceArgument,
    to: Annotated[
        str | None,
        typer.Option(
            metavar="SIZE",
            help="25x30cm, 0.25x0.30 (m), shelf, drawer, suitcase, hanger, halves, thirds, roll or smallest.",
        ),
    ] = None,
    like: Annotated[
        str | None, typer.Option(metavar="GARMENT", help="Instead of a size: a garment whose folds are fitted.")
    ] = None,
    robot: Annotated[str, typer.Option(help="The robot: its name, or the file of its card.")] = DEFAULT_ROBOT,
    count: Annotated[int, typer.Option(help="The most proposals.")] = 6,
    max_folds: Annotated[int, typer.Option(help="The most folds of a proposal.")] = 8,
    face: Annotated[Face, typer.Option(help="The face of the cloth that looks up at the end.")] = "any",
    anew: Annotated[bool, typer.Option("--anew", help="Leave out the folds that the garment has.")] = False,
    json_to: program.JsonOption = None,
    data: program.DataOption = None,
) -> None:
    """Propose folds that bring a garment to a size, or fold it like another one, each planned for a robot.

    Folds that the garment has are kept as the beginning.
    """
    source = program.garment_of(garment)
    chosen = replace(source, folds=()) if anew else source
    if (to is None) == (like is None):
        raise program.failure("Expected either --to SIZE or --like GARMENT.")
    target = to or program.garment_of(like or "")
    with program.blaming(garment):
        found = propose_folds(chosen, target, robot=robot, count=count, max_folds=max_folds, face=face)
        program.tell_of_compiling(robot)
        answer = all_proposals(found)
    program.print_answer(answer.to_dict(), json_to, proposals_table(chosen, answer))
    if not answer.proposals and like is not None:
        program.errors.print(f"--like: no fold of {like} fits the outline of {garment}.")
    elif not answer.proposals:
        wide, long = (f"{100.0 * side_m:.0f}" for side_m in sorted(answer.tried.nearest_m))
        program.errors.print(
            f"--to: nothing fits {to}: the smallest found is {wide} x {long} cm, of {answer.tried.enumerated} ways "
            "tried. Choose a larger size or raise --max-folds"
        )
    elif not answer.is_any_solved:
        program.errors.print("The robot can do none of them.")
    raise typer.Exit(0 if answer.is_any_solved else program.NO_PLAN)
