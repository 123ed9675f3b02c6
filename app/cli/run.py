"""``pleat run``: perform a plan with a real robot or a simulated one."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.progress import BarColumn, Progress, TaskID, TextColumn

from app.cli.plan import PlanFileArgument
from app.cli.program import NO_PLAN, DataOption, blaming, cli, errors, failure, output, refusing

if TYPE_CHECKING:
    from app.drivers.driver import Driver, Joints
    from app.drivers.run import Leg, Look
    from planner.robots.card import RobotCard
    from planner.task.plan import Plan


class DriverName(StrEnum):
    """What moves the robot."""

    SIMULATED = "simulated"
    LEROBOT = "lerobot"
    ROS2 = "ros2"
    UR = "ur"


@cli.command()
def run(
    file: PlanFileArgument,
    driver: Annotated[DriverName, typer.Option(help="What moves the robot.")] = DriverName.SIMULATED,
    speed: Annotated[float, typer.Option(help="The motion's speed as a share of the planned one (0.05..1).")] = 1.0,
    auto: Annotated[bool, typer.Option("--auto", help="Do not ask before each step.")] = False,
    from_step: Annotated[int, typer.Option(metavar="K", help="The first step to perform, counted from 0.")] = 0,
    record: Annotated[
        Path | None, typer.Option(metavar="FILE.mcap", help="Keep what was sent and read, as ROS 2 messages.")
    ] = None,
    address: Annotated[
        str | None,
        typer.Option(help="Where the robot is: ARM=PORT or ARM=HOST for each arm, a comma between; a URL for ros2."),
    ] = None,
    camera: Annotated[
        str | None,
        typer.Option(
            metavar="IMAGE|NUMBER", help="Go on with the step that a picture, or the camera NUMBER, shows to be next."
        ),
    ] = None,
    calibration: Annotated[
        Path | None, typer.Option(metavar="FILE", help="The camera, as `pleat camera calibrate` found it.")
    ] = None,
    data: DataOption = None,
) -> None:
    """Perform a plan: lead the arms to its first pose, then do step by step, each confirmed.

    Ctrl-C stops the arms.
    """
    from app.drivers.run import Recording, run_plan
    from app.files.slowed import require_speed
    from planner.robots.load_robot import load_robot
    from planner.task.plan_files import read_plan

    with blaming(file):
        require_speed(speed)
        plan = read_plan(file)
        card = load_robot(plan.task.robot).card
        look = _look(plan, camera, calibration)
        kept = Recording(card)
        with _Console(auto) as console:
            ended = run_plan(
                plan,
                card,
                _driver(driver, card, address),
                console.confirm,
                console.progress,
                kept,
                from_step,
                speed,
                look=look,
            )
    if record is not None:
        about = {"garment": plan.garment.name, "robot": card.name, "driver": driver.value, "speed": speed}
        with refusing(record):
            record.write_bytes(
                kept.mcap({**about, "from_step": from_step, "camera": camera, "ended": ended.how, "why": ended.why})
            )
    if ended.how == "done":
        output.print(f"Done: {ended.done} of {len(plan.steps)} steps")
        return
    errors.print(f"{ended.how.capitalize()} after {ended.done} of {len(plan.steps)} steps: {ended.why}")
    raise typer.Exit(NO_PLAN)


def _look(plan: "Plan", camera: str | None, calibration: Path | None) -> "Look | None":
    """Return what finds the step that a camera shows to be next; None without one."""
    if camera is None and calibration is None:
        return None
    if camera is None or calibration is None:
        raise failure("--camera and --calibration need each other")
    from app.cli.see import calibration_file, picture_file
    from app.drivers.camera_look import step_seen
    from app.rehearsal.vision.picture import device_image, read_picture
    from app.rehearsal.vision.vision_errors import PictureError

    known = calibration_file(calibration)

    def look(joints: "Joints") -> int:
        try:
            image = device_image(int(camera)) if camera.isdigit() else read_picture(picture_file(Path(camera))).image
        except PictureError as error:
            raise failure(f"--camera: {camera}: {error.message}") from None
        found = step_seen(plan, image, known, joints)
        place = f"{1000 * found.off_m:.0f} mm and {found.turned_rad:.3f} rad from where the plan has it"
        errors.print(f"Seen: step {found.step} of {len(plan.steps)} is next; the cloth lies {place}")
        return found.step

    return look


class _Console:
    """Asks and tells in the terminal."""

    def __init__(self, is_auto: bool) -> None:
        self._is_auto = is_auto
        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.completed:.1f} of {task.total:.1f} s"),
        )
        self._bar = Progress(*columns, console=errors, transient=True)
        self._task: TaskID | None = None

    def __enter__(self) -> "_Console":
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.stop()

    def confirm(self, leg: "Leg") -> bool:
        """Ask whether a part is to be performed."""
        self._bar.stop()
        words = leg.what if leg.step is None else f"step {leg.step}: {leg.what}"
        if not self._is_auto:
            try:
                if not typer.confirm(f"{words} ({leg.duration_s:.1f} s)?", default=True, err=True):
                    return False
            except typer.Abort:  # Ctrl-C, or the end of the input
                raise KeyboardInterrupt from None
        if self._task is not None:
            self._bar.remove_task(self._task)
        self._task = self._bar.add_task(words, total=leg.duration_s)
        self._bar.start()
        return True

    def progress(self, _leg: "Leg", t_s: float) -> None:
        """Show how far a part is."""
        if self._task is not None:
            self._bar.update(self._task, completed=t_s)


def _driver(name: DriverName, card: "RobotCard", address: str | None) -> "Driver":
    match name:
        case DriverName.SIMULATED:
            from app.drivers.simulated import SimulatedDriver

            return SimulatedDriver(card)
        case DriverName.LEROBOT:
            from app.drivers.lerobot_arms import LerobotDriver, so_followers

            return LerobotDriver(card, so_followers(_addresses(address, card)))
        case DriverName.ROS2:
            from app.drivers.rosbridge import ADDRESS, RosbridgeDriver

            return RosbridgeDriver(card, address or ADDRESS)
        case DriverName.UR:
            from app.drivers.ur_arms import UrDriver

            return UrDriver(card, _addresses(address, card))


def _addresses(address: str | None, card: "RobotCard") -> dict[str, str]:
    """Return the address of each arm; one without a name is that of the only arm."""
    if not address:
        return {}
    if "=" not in address and len(card.arms) == 1:
        return {card.arms[0].name: address}
    parts = [part.partition("=") for part in address.split(",")]
    if not all(name and sign and where for name, sign, where in parts):
        raise failure(f"--address: expected ARM=WHERE for each arm, as in {card.arms[0].name}=...; got {address!r}")
    return {name: where for name, _, where in parts}
