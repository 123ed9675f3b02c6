"""Pleat's version."""

import tomllib
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_PROJECT = Path(__file__).parent.parent / "pyproject.toml"


def own_version() -> str:
    """Return Pleat's version, as it is installed, or as a checkout that is not installed says it."""
    try:
        return version("pleat")
    except PackageNotFoundError:
        return str(tomllib.loads(_PROJECT.read_text(encoding="utf-8"))["project"]["version"])
