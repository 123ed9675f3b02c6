"""Pleat as it is installed: its distribution, version, and the command that adds an extra."""

import tomllib
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Literal

NAME = "pleat-fold"
"""The distribution: on the package index `pleat` is another project."""

Extra = Literal["physics", "cluster", "postgres", "video"]

_PROJECT = Path(__file__).parents[1] / "pyproject.toml"


def own_version() -> str:
    """Return Pleat's version, as it is installed, or as a checkout that is not installed says it."""
    try:
        return version(NAME)
    except PackageNotFoundError:
        return str(tomllib.loads(_PROJECT.read_text(encoding="utf-8"))["project"]["version"])


def installing(extra: Extra) -> str:
    """Return the command that installs an extra: from the checkout, if Pleat runs from one, else from the index."""
    is_checkout = _PROJECT.is_file()
    return f"pip install -e '.[{extra}]'" if is_checkout else f"pip install '{NAME}[{extra}]'"
