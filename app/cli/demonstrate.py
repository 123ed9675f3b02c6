"""``pleat demonstrate``: simulated demonstrations as a LeRobot dataset."""

import os
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from app.cli import program
from app.demonstrations.dataset import DemonstrationDataset
from app.demonstrations.demonstrate import demonstrate
from app.distribution import installing, is_installed
from planner import Plan
from planner.planning.robot_task import task_for
from planner.robots.load_robot import load_robot
from planner.task.task import DEFAULT_ROBOT


@program.cli.command("demonstrate")
def demonstrate_command(
    source: program.SourceArgument,
    episodes: Annotated[int, typer.Option(min=1, max=100_000, help="How many demonstrations.")],
    out: Annotated[Path, typer.Option(metavar="DIR", help="The folder of the dataset.")],
    robot: Annotated[str | None, typer.Option(help="The robot.", show_default=DEFAULT_ROBOT)] = None,
    seed: Annotated[int, typer.Option(min=0, max=2**31 - 1, help="The seed of the first one that is tried.")] = 0,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with the dataset in DIR.")] = False,
    workers: Annotated[
        int | None, typer.Option(min=1, max=256, help="Processes.", show_default="two, or one on one core")
    ] = None,
    wrists: Annotated[bool, typer.Option("--wrists/--no-wrists", help="Cameras on the wrists, too.")] = True,
    data: program.DataOption = None,
) -> None:
    """Make demonstrations in simulated physics: a LeRobot dataset with pictures, of those alone in which all held.

    Each has another place of the cloth, another cloth, other colours, light and camera, and a plan of its own. Exit
    status: 0 where all were made, 3 where ten tries for each were not enough, or after Ctrl-C.
    """
    with program.blaming(source), program.refusing(out):
        found = program.load_source(source)
        task = found.task if isinstance(found, Plan) else task_for(found, robot=robot or DEFAULT_ROBOT)
        if robot is not None and robot != task.robot:
            task = task_for(task.garment, robot=robot)
        given = {"garment": task.garment.to_dict(), "robot": task.robot, "scene": task.scene.to_dict()}
        asked: dict[str, Any] = {**given, "seed": seed, "wrists": wrists}
        card = load_robot(task.robot).card
        dataset = DemonstrationDataset.opened(out, card, asked, seed, resume=resume, as_video=is_installed("av"))
        if not is_installed("av"):
            program.errors.print(f"Pictures are images, not videos, without PyAV: {installing('video')}", markup=False)
        program.tell_of_compiling(task.robot)
        columns = (BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
        with Progress(TextColumn("{task.description}"), *columns, console=program.errors, transient=True) as bar:
            line = bar.add_task("Demonstrating", total=episodes, completed=dataset.count)

            def tell(count: int, tried: int) -> None:
                bar.update(line, completed=count, description=f"{tried} tried")

            try:
                is_done = demonstrate(
                    task, dataset, episodes, workers or min(2, os.cpu_count() or 1), tell, has_wrists=wrists
                )
            except KeyboardInterrupt:
                so_far = f"{dataset.count} of {episodes} episodes"
                program.errors.print(f"Stopped with {so_far}; --resume goes on from there.")
                raise typer.Exit(program.NO_PLAN) from None
    tried = dataset.next_seed - seed
    program.output.print(f"{out}: {dataset.count} episodes of {tried} that were tried", soft_wrap=True)
    if not is_done:
        program.errors.print(f"Only {dataset.count} of {episodes} held in as many tries as are made.")
        raise typer.Exit(program.NO_PLAN)
