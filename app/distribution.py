"""Pleat as it is installed: its distribution, version, and the command that adds an extra."""

from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Literal

NAME = "pleat-fold"
"""The distribution: on the package index `pleat` is another project."""

Extra = Literal["physics", "cluster", "postgres"]

_ROOT = Path(__file__).parents[1]


def own_version() -> str:
    """Return Pleat's version; "0" if it is not installed."""
    try:
        return version(NAME)
    except PackageNotFoundError:
        return "0"


def installing(extra: Extra) -> str:
    """Return the command that installs an extra: from the checkout, if Pleat runs from one, else from the index."""
    is_checkout = (_ROOT / "pyproject.toml").is_file()
    return f"pip install -e '.[{extra}]'" if is_checkout else f"pip install '{NAME}[{extra}]'"
