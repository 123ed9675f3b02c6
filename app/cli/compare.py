"""``pleat compare``: compare robots by their plans for one garment."""

from typing import Annotated

import typer

from app.cli import program
from app.comparison import compared
from app.tables import comparison_table
from planner.robots.known_robots import robot_names
from planner.task.task import Limits


@program.cli.command()
def compare(
    garment: program.SourceArgument,
    robots: Annotated[
        str | None, typer.Option(metavar="A,B,C", help="The robots: names, or files of cards.", show_default="all")
    ] = None,
    time_limit_s: Annotated[float, typer.Option(help="Processor time for the search for each (s).")] = 10.0,
    json_to: program.JsonOption = None,
    data: program.DataOption = None,
) -> None:
    """Plan a garment for several robots, each at its own table: who can fold it, how long it takes, what it would take.

    The first time a robot is planned for, maps of what its arms reach are made, which takes up to half a minute an arm.
    """
    names = [name.strip() for name in robots.split(",")] if robots else list(robot_names())
    if not all(names):
        raise program.failure("--robots: has an empty name")
    source = program.garment_of(garment)
    program.tell_of_compiling(*names)
    with program.blaming(garment):
        found = list(compared(source, names, Limits(time_limit_s=time_limit_s)))
    program.print_answer([one.to_dict() for one in found], json_to, comparison_table(found))
