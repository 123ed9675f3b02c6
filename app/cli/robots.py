"""``pleat robots`` and ``pleat robot check``: list the robots, and check a robot's card."""

from typing import Annotated

import typer
from rich.progress import Progress

from app.cli.program import STANDARD_OUTPUT, DataOption, JsonOption, blaming, cli, errors, output, write_json
from app.tables import robot_check_table, robots_table
from planner.robots.described_robot import read_robot, robot_entry
from planner.robots.known_robots import robot_cards
from planner.robots.table_reach import table_reach

robot = typer.Typer(help="Look at the card of a robot.", no_args_is_help=True)
cli.add_typer(robot, name="robot")


@cli.command()
def robots(json_to: JsonOption = None, data: DataOption = None) -> None:
    """Print the robots that are shipped, and your own."""
    cards = robot_cards()
    write_json([robot_entry(card) for card in cards], json_to)
    if json_to != STANDARD_OUTPUT:
        output.print(robots_table(cards))


@robot.command()
def check(
    card: Annotated[str, typer.Argument(metavar="CARD", help="The name of a robot, or a card's file.")],
    json_to: JsonOption = None,
    data: DataOption = None,
) -> None:
    """Check that a card is complete, that what it names is there, and how much of its table it reaches.

    The first time it looks where the arms can go, which takes up to half a minute an arm.
    """
    with blaming(card):
        found = read_robot(card)
    with Progress(console=errors, transient=True) as progress:
        task = progress.add_task("Looking where the arms can go", total=1.0)
        reach = table_reach(found, lambda share: progress.update(task, completed=share))
    reached = {"arms": reach.arms, "any_arm": reach.any_arm, "two_arms": reach.two_arms}
    write_json({"name": found.card.name, "title": found.card.title, "table_reached": reached}, json_to)
    if json_to != STANDARD_OUTPUT:
        output.print(robot_check_table(found.card, reach))
