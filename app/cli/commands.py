"""The commands by name. A command's module is imported when it is run, not when it is listed."""

import gc
from importlib import import_module
from typing import Annotated, Any, NamedTuple

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_group_from_info
from typer.models import TyperInfo


class _Command(NamedTuple):
    """A command: its module in `app.cli`, what it does, an example, and its exit status."""

    module: str
    does: str
    example: str
    status: str = "0 done, 2 bad input"

    @property
    def epilog(self) -> str:
        """What its help ends with."""
        return f"Example: {self.example}\n\nExit status: {self.status}."


_OF_PLAN = "0 there is a plan, 2 bad input, 3 there is none, 4 the search ended before its answer"

COMMANDS = {
    "plan": _Command(
        "plan", "Plan a garment's folds, and print the plan.", "pleat plan t-shirt --robot ur5e-pair", _OF_PLAN
    ),
    "show": _Command(
        "plan", "Print the plan in a plan file, or why there is none.", "pleat show tie.plan.json", _OF_PLAN
    ),
    "timeline": _Command(
        "plan",
        "Sample a plan from its start to its end: base, joints, velocities, grippers.",
        "pleat timeline tie.plan.json --rate-hz 50 --json -",
    ),
    "compare": _Command(
        "compare",
        "Plan a garment for several robots, each at its own table: who can fold it, how long it takes, what it would"
        " take.",
        "pleat compare t-shirt --robots pr2,ur5e-pair",
    ),
    "propose": _Command(
        "propose",
        "Propose folds that bring a garment to a size, or fold it like another one, each planned for a robot.",
        "pleat propose vest --to 25x30cm --anew",
        "0 the robot can do one, 2 bad input, 3 it can do none",
    ),
    "dag": _Command("garment", "Print which fold waits for which.", "pleat dag shirt"),
    "check": _Command(
        "garment",
        "Check that a garment file is good, its folds are legal, and each can be held by the robot's grippers.",
        "pleat check garments/vest.json",
        "0 good, 2 bad input, 3 a fold cannot be held",
    ),
    "export": _Command(
        "export",
        "Make a file of a plan, or of a garment, which is planned first where the kind needs that.",
        "pleat export tie.plan.json --to recording.html",
    ),
    "run": _Command(
        "run",
        "Perform a plan: lead the arms to its first pose, then do step by step, each confirmed.",
        "pleat run tie.plan.json --speed 0.5",
        "0 done, 2 bad input, 3 stopped, or the robot was lost",
    ),
    "rehearse": _Command(
        "rehearse",
        "Perform a plan in simulated physics, and say of every step whether it holds.",
        "pleat rehearse letter-towel --noise real --runs 3",
        "0 all runs held, 2 bad input, 3 one was lost, or there is no plan",
    ),
    "demonstrate": _Command(
        "demonstrate",
        "Make demonstrations in simulated physics: a LeRobot dataset with pictures, of those alone in which all held.",
        "pleat demonstrate hand-towel --robot so101-pair --episodes 10 --out towels",
        "0 all episodes were written, 2 bad input, 3 fewer",
    ),
    "see": _Command(
        "see",
        "Read a garment from a picture: its outline, where it lies, how sure that is; or how far it is folded.",
        "pleat see shirt.jpg --json -",
        "0 read, 2 bad input, or no scale, 3 nothing can be read from the picture",
    ),
    "camera": _Command(
        "camera",
        "Print a board of markers, and calibrate a camera over the table with pictures of it.",
        "pleat camera calibrate *.jpg --out camera.json",
    ),
    "robots": _Command("robots", "Print the robots that are shipped, and your own.", "pleat robots"),
    "robot": _Command("robots", "List the robots, check a card, draft one of a URDF.", "pleat robot check so101-pair"),
    "study": _Command(
        "study",
        "Plan the product of garments, robots, tables, placements and limits: one table, one report.",
        "pleat study heights.toml --out heights",
    ),
    "study-plan": _Command(
        "study",
        "Make the plan of one cell of a study again, and write it as a plan file.",
        "pleat study-plan heights 17 --out cell.plan.json",
    ),
    "serve": _Command("serve", "Serve the designer until Ctrl-C.", "pleat serve --port 8000"),
    "cache": _Command("cache", "Print what is kept for later runs, and how large it is.", "pleat cache --clear"),
    "backup": _Command(
        "backup",
        "Write a data folder and its database to one file; the server may be running.",
        "pleat backup pleat.zip",
    ),
    "restore": _Command(
        "backup",
        "Make a data folder and a database of a backup; both must be new or empty.",
        "pleat restore pleat.zip --data new",
    ),
}


class _Listed(TyperCommand):
    """A command as it is listed; to be run it is imported."""

    def make_context(self, *arguments: Any, **options: Any) -> Any:  # noqa: ANN401
        """Return the context of the command that is to be run."""
        return loaded(str(self.name)).make_context(*arguments, **options)


class _Commands(TyperGroup):
    """The program: all of `COMMANDS`."""

    def __init__(self, **options: Any) -> None:  # noqa: ANN401
        """Take the commands as they are listed."""
        listed = {name: _Listed(name, help=command.does) for name, command in COMMANDS.items()}
        super().__init__(**{**options, "commands": listed})


cli = typer.Typer(
    cls=_Commands,
    help="Plan how a robot can really fold a garment, and show it.",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
)


def _print_version(is_asked: bool) -> None:
    if is_asked:
        from app.distribution import own_version

        typer.echo(own_version())
        raise typer.Exit


@cli.callback()
def _program(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print Pleat's version.")
    ] = False,
) -> None:
    """Take the options of the program itself."""


def loaded(name: str) -> Any:  # noqa: ANN401
    """Import a command and return it."""
    # Modules stay, so the garbage collector does not look through them meanwhile: that takes a fifth of the time.
    is_collecting = gc.isenabled()
    gc.disable()
    import_module(f"app.cli.{COMMANDS[name].module}")
    if is_collecting:
        gc.freeze()
        gc.enable()
    program = get_group_from_info(
        TyperInfo(cli, cls=TyperGroup),
        suggest_commands=False,
        pretty_exceptions_short=cli.pretty_exceptions_short,
        rich_markup_mode=cli.rich_markup_mode,
    )
    found = program.commands[name]
    found.epilog = COMMANDS[name].epilog
    return found
