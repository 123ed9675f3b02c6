"""The command line: ``pleat serve``, ``plan``, ``show``, ``timeline``, ``export``, ``dag``, ``check``, ``see``..."""

import os
import sys

from app.cli.commands import cli

__all__ = ["cli", "main"]


def main() -> None:
    """Run the program: the entry point of the package.

    Processes that it starts run none of the current folder's modules: Python would look for any module there first.
    """
    os.environ["PYTHONSAFEPATH"] = "1"
    try:
        cli()
    except ModuleNotFoundError as error:
        from app.distribution import explained

        if (message := explained(error)) is None:
            raise
        sys.exit(message.text)
