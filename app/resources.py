"""Where the files that go to the browser are."""

from pathlib import Path

_HERE = Path(__file__).resolve().parent


def static_dir() -> Path:
    """The folder of the page: in an installed package inside it, in a checkout beside the packages."""
    installed = _HERE / "static"
    return installed if installed.is_dir() else _HERE.parent / "static"
