"""``pleat robots`` and ``pleat robot``: list the robots, and check or draft a robot's card."""

import shutil
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.progress import Progress

from app.cli import program
from app.tables import robot_check_table, robots_table
from planner.robots.known_robots import robot_cards, robot_entry
from planner.robots.own_robots import CARD

robot = typer.Typer(help="List the robots, check a card, draft one of a URDF.", no_args_is_help=True)
program.cli.add_typer(robot, name="robot")


@program.cli.command()
@robot.command("list")
def robots(json_to: program.JsonOption = None, data: program.DataOption = None) -> None:
    """Print the robots that are shipped, and your own."""
    cards = robot_cards()
    program.print_answer([robot_entry(card) for card in cards], json_to, robots_table(cards))


@robot.command()
def check(
    card: Annotated[str, typer.Argument(metavar="CARD", help="The name of a robot, or a card's file.")],
    json_to: program.JsonOption = None,
    data: program.DataOption = None,
) -> None:
    """Check that a card is complete, that what it names is there, and how much of its table it reaches.

    It first warns of what is allowed but probably not meant: a part in another unit, arms in one
    place, a tool point off the fingertips, a station in the table, or a station or a mount turned away from it. The
    first time it then looks where the arms can go, which takes up to half a minute an arm.
    """
    from app.robot_warnings import warnings_of
    from planner.robots.described_robot import read_robot
    from planner.robots.table_reach import table_reach
    from planner.robots.tool_point import tool_points

    with program.blaming(card):
        found = read_robot(card)
        points, warnings = tool_points(found), warnings_of(found)
    output = program.errors if json_to == program.STANDARD_OUTPUT else program.output
    for warning in warnings:
        output.print(f"Warning: {warning['message']}.", markup=False, soft_wrap=True)
    with Progress(console=program.errors, transient=True) as progress:
        task = progress.add_task("Looking where the arms can go", total=1.0)
        reach = table_reach(found, lambda share: progress.update(task, completed=share))
    reached = {"arms": reach.arms, "any_arm": reach.any_arm, "two_arms": reach.two_arms}
    answer: dict[str, Any] = {"tool_points": [asdict(point) for point in points], "warnings": warnings}
    answer |= {"name": found.card.name, "title": found.card.title, "table_reached": reached}
    program.print_answer(answer, json_to, robot_check_table(found.card, reach))


@robot.command()
def draft(
    file: Annotated[
        Path,
        typer.Argument(metavar="FILE", help="A URDF, xacro, MuJoCo's XML, or a zip archive of one with its meshes."),
    ],
    out: Annotated[Path, typer.Option(metavar="DIR", help="The folder of the card; it must be new or empty.")],
    name: Annotated[str | None, typer.Option(help="The robot's name.", show_default="that of DIR")] = None,
) -> None:
    """Draft a robot's card of its description: arms, grippers, tool points, home, base and table; say what was guessed.

    Exit status: 0 drafted; 2 bad input, or no arm that ends in a gripper.
    """
    from app.files.robot_draft import drafted
    from app.robot_warnings import warnings_of
    from planner.robots.described_robot import read_described

    with program.refusing(out):
        if out.exists() and any(out.iterdir()):
            raise program.failure(f"--out: {out} is not empty")
        is_new = not out.exists()
        out.mkdir(parents=True, exist_ok=True)
    try:
        with program.blaming(file), program.refusing(file):
            draft = drafted(file, name or out.resolve().name, out)
            warnings = warnings_of(read_described(out / CARD))
    except typer.Exit:
        if is_new:
            shutil.rmtree(out)
        raise
    program.output.print(f"{out / CARD}: {len(draft.card.arms)} arms, each with a gripper", soft_wrap=True)
    for title, entries in (("Guessed", draft.guesses), ("Not known", draft.unknown)):
        for one in entries:
            program.output.print(f"{title}: {one}.", soft_wrap=True)
    for warning in warnings:
        program.output.print(f"Warning: {warning['message']}.", soft_wrap=True)
    program.output.print(f"Look through it, then: pleat robot check {out / CARD}", soft_wrap=True)
