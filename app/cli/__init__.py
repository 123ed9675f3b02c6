"""The command line: ``pleat serve``, ``plan``, ``show``, ``timeline``, ``export``, ``dag``, ``check``, ``robots``..."""

from app.cli import backup, compare, export, garment, plan, rehearse, robots, serve, study
from app.cli.program import cli

__all__ = ["backup", "cli", "compare", "export", "garment", "main", "plan", "rehearse", "robots", "serve", "study"]


def main() -> None:
    """Run the program: the entry point of the package."""
    cli()
