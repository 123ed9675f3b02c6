"""The command line: ``pleat serve``, ``plan``, ``show``, ``timeline``, ``export``, ``dag``, ``check``, ``see``..."""

from app.cli import backup, compare, export, garment, plan, rehearse, robots, see, serve, study
from app.cli.program import cli

__all__ = [
    "backup",
    "cli",
    "compare",
    "export",
    "garment",
    "main",
    "plan",
    "rehearse",
    "robots",
    "see",
    "serve",
    "study",
]


def main() -> None:
    """Run the program: the entry point of the package."""
    cli()
