"""Locates the files served to the browser."""

from pathlib import Path

_HERE = Path(__file__).resolve().parent


def static_dir() -> Path:
    """Return the page's folder: inside an installed package, beside the packages in a checkout."""
    installed = _HERE / "static"
    return installed if installed.is_dir() else _HERE.parent / "static"
