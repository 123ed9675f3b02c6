"""``pleat plan``, ``pleat show`` and ``pleat timeline``."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from app.cli import program
from app.tables import plan_table, suggestion_table
from planner import Plan, Scene, Task, Timeline, make_plan, suggestions
from planner.cloth.garment import Garment
from planner.cloth.garment_files import read_json
from planner.errors import SceneError
from planner.planning.robot_task import default_scene, scene_filled_up, task_for
from planner.robots.known_robots import robot_names
from planner.task.plan_files import read_plan, write_plan
from planner.task.task import DEFAULT_ROBOT, TIME_LIMIT_S, HeuristicName, TaskOptions
from planner.words.catalogue import sentence

_SLOWDOWN_MAX = 6.0
"""The time that a search for suggestions may take, as a multiple of its counted work, on a slow or busy machine."""

PlanFileArgument = Annotated[Path, typer.Argument(metavar="FILE", help="A plan file, as `pleat plan --out` writes it.")]


@program.cli.command()
def plan(
    garment: program.SourceArgument,
    comfort_radius_m: Annotated[float | None, typer.Option(help="Reach margin (m).", show_default="0.03")] = None,
    scene: Annotated[Path | None, typer.Option(help="A scene file.")] = None,
    start: Annotated[str | None, typer.Option(help="The station where the robot starts.", show_default="front")] = None,
    heuristic: Annotated[HeuristicName | None, typer.Option(help="Search heuristic.", show_default="arm_time")] = None,
    time_limit_s: Annotated[
        float | None, typer.Option(help="Processor time for the search (s).", show_default="10")
    ] = None,
    robot: Annotated[
        str | None, typer.Option(help="The robot: its name, or the file of its card.", show_default=DEFAULT_ROBOT)
    ] = None,
    from_plan: Annotated[
        Path | None, typer.Option("--from", metavar="PLAN", help="A plan file: start where it is after a step.")
    ] = None,
    after_step: Annotated[
        int | None, typer.Option(help="With --from: the step, counted from 0, that has been done.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            callback=program.in_a_folder,
            metavar="FILE",
            help="Write a plan file, which show, timeline and export read.",
        ),
    ] = None,
    json_to: program.JsonOption = None,
    suggest: Annotated[bool, typer.Option("--suggest", help="Look for changes that give a (quicker) plan.")] = False,
    data: program.DataOption = None,
) -> None:
    """Plan a garment's folds, and print the plan."""
    options = TaskOptions()
    if start is not None:
        options["start_station"] = start
    if comfort_radius_m is not None:
        options["comfort_radius_m"] = comfort_radius_m
    if heuristic is not None:
        options["heuristic"] = heuristic
    if time_limit_s is not None:
        options["time_limit_s"] = time_limit_s
    if robot is not None:
        options["robot"] = robot
    where = None if scene is None else _read_scene(scene, robot or DEFAULT_ROBOT)
    task = _task(program.load_source(garment), where, options, garment)
    if from_plan is not None:
        task = _going_on(task, from_plan, after_step, has_scene=scene is not None)
    elif after_step is not None:
        raise program.failure("--after-step: needs --from")
    with program.blaming(garment):
        program.tell_of_compiling(task.robot)
        answer = make_plan(task)
    program.write_json(answer.answer(), json_to)
    if out is not None:
        with program.refusing(out):
            write_plan(answer, out)
    is_quiet = json_to == program.STANDARD_OUTPUT
    if answer.is_solved and not is_quiet:
        program.output.print(plan_table(answer))
    status = _status(answer)
    if suggest and not is_quiet:
        _print_suggestions(answer)
    raise typer.Exit(status)


@program.cli.command()
def show(file: PlanFileArgument) -> None:
    """Print the plan in a plan file, or why there is none."""
    with program.blaming(file):
        answer = read_plan(file)
    if answer.is_solved:
        program.output.print(plan_table(answer))
    raise typer.Exit(_status(answer))


@program.cli.command()
def timeline(
    file: PlanFileArgument,
    rate_hz: Annotated[float, typer.Option(help="Samples a second (1..200).")] = 30.0,
    json_to: Annotated[str, typer.Option("--json", metavar="FILE|-", help="Write it there; - prints it.")] = "-",
) -> None:
    """Sample a plan from its start to its end: base, joints, velocities, grippers."""
    with program.blaming(file):
        played = Timeline.of(read_plan(file))
        samples = [frame.to_dict() for frame in played.samples(rate_hz)]
    program.write_json({"rate_hz": rate_hz, "samples": samples}, json_to)


def _task(source: Garment | Plan, scene: Scene | None, options: TaskOptions, name: str) -> Task:
    """Return the task of a garment, or that of a plan with the given options changed."""
    with program.blaming(name):
        if isinstance(source, Garment):
            return task_for(source, scene, **options)
        if options.get("robot", source.task.robot) != source.task.robot:
            return task_for(source.task.garment, scene, **options)
        task = source.task if scene is None else source.task.in_scene(scene)
        fresh = Task.of(task.garment, task.scene, **options)
        limits = {field: getattr(fresh.limits, field) for field in options if field not in ("start_station", "robot")}
        moved = replace(task.start, base=fresh.start.base) if "start_station" in options else task.start
        return replace(task, start=moved, limits=replace(task.limits, **limits))


def _going_on(task: Task, path: Path, after_step: int | None, *, has_scene: bool) -> Task:
    """Return the task with the start taken from a plan after a step, and the plan's scene unless another is given."""
    with program.blaming(path):
        before = read_plan(path)
        start = before.state_after(len(before.steps) - 1 if after_step is None else after_step)
        return replace(task if has_scene else task.in_scene(before.scene), start=start)


def _read_scene(path: Path, robot: str) -> Scene:
    with program.blaming(path):
        data = read_json(path)
        if not isinstance(data, dict):
            raise SceneError("", "a scene file holds one JSON object")
        return Scene.from_dict(scene_filled_up(data, default_scene(robot).to_dict()))


def _print_suggestions(answer: Plan) -> None:
    limits = answer.task.limits
    work_s = limits.work_limit_s or limits.time_limit_s
    time_s = min(_SLOWDOWN_MAX * work_s, TIME_LIMIT_S[1])
    task = replace(answer.task, limits=replace(limits, work_limit_s=work_s, time_limit_s=time_s))
    folds, found = answer.garment.folds, []
    with program.errors.status("Looking for changes that give a plan...") as line:
        for one in suggestions(
            task,
            plan=answer,
            on_trial=lambda trial: line.update(Text(f"Trying: {sentence(trial.says, folds)}")),
            other_robots=robot_names(),
        ):
            found.append(one)
            program.errors.print(Text(f"Found: {sentence(one.says, folds)} ({one.cost_s:.2f} s)"))
    if found:
        program.output.print(suggestion_table(answer.garment, found))
    else:
        program.output.print(f"No change was found within {work_s:g} s of work.")


def _status(answer: Plan) -> int:
    """Return the exit status for a plan; print why there is none."""
    if answer.status == "budget_exceeded":
        bound = answer.statistics.bound_s
        program.errors.print(
            "The search ran out of time. Raise --time-limit-s" + (f"; lower bound {bound:.2f} s" if bound else "")
        )
        return program.OUT_OF_BUDGET
    if answer.is_solved and not answer.is_proven:
        bound = answer.statistics.bound_s or 0.0
        why = "The search ran out of time. " if answer.statistics.is_cut_short else ""
        program.errors.print(f"{why}There may be a quicker plan, but none takes less than {bound:.2f} s")
    for reason in answer.reasons:
        met = "" if reason.is_tried else "; met on the way, not tried whether it is the cause"
        why = sentence(reason.says, answer.garment.folds, reason.fold)
        program.errors.print(f"{reason.code.value}: {why}{met}")
    return 0 if answer.is_solved else program.NO_PLAN
