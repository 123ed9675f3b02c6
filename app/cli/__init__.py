"""The command line: ``pleat serve``, ``plan``, ``show``, ``timeline``, ``export``, ``dag``, ``check``."""

from app.cli import export, garment, plan, serve
from app.cli.program import cli

__all__ = ["cli", "export", "garment", "main", "plan", "serve"]


def main() -> None:
    """Run the program: the entry point of the package."""
    cli()
