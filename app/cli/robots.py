"""``pleat robots`` and ``pleat robot check``: list the robots, and check a robot's card."""

from dataclasses import asdict
from typing import Annotated

import typer
from rich.progress import Progress

from app.cli.program import STANDARD_OUTPUT, DataOption, JsonOption, blaming, cli, errors, output, write_json
from app.tables import robot_check_table, robots_table
from planner.robots.known_robots import robot_cards, robot_entry

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

    It first warns of what is allowed but probably not meant: a part in another unit, arms in one
    place, a tool point off the fingertips, a station in the table or turned away from it. The first time it then looks
    where the arms can go, which takes up to half a minute an arm.
    """
    from app.robot_warnings import warnings_of
    from planner.robots.described_robot import read_robot
    from planner.robots.table_reach import table_reach
    from planner.robots.tool_point import tool_points

    with blaming(card):
        found = read_robot(card)
        points, warnings = tool_points(found), warnings_of(found)
    told_on = errors if json_to == STANDARD_OUTPUT else output
    for warning in warnings:
        told_on.print(f"Warning: {warning['message']}.", markup=False, soft_wrap=True)
    with Progress(console=errors, transient=True) as progress:
        task = progress.add_task("Looking where the arms can go", total=1.0)
        reach = table_reach(found, lambda share: progress.update(task, completed=share))
    reached = {"arms": reach.arms, "any_arm": reach.any_arm, "two_arms": reach.two_arms}
    told = {"tool_points": [asdict(point) for point in points], "warnings": warnings}
    write_json({"name": found.card.name, "title": found.card.title, "table_reached": reached, **told}, json_to)
    if json_to != STANDARD_OUTPUT:
        output.print(robot_check_table(found.card, reach))
