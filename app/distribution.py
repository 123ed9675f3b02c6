"""Pleat as it is installed: its distribution and version, and the extras that a library belongs to."""

import sys
import tomllib
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path
from typing import Final, Literal

from planner.errors import RequestError
from planner.message import Message

NAME = "pleat-fold"
"""The distribution: on the package index `pleat` is another project."""

Extra = Literal[
    "cluster",
    "exports",
    "imports",
    "lerobot",
    "metrics",
    "physics",
    "postgres",
    "ur",
    "usd",
    "video",
    "vision",
    "xacro",
]

_LIBRARIES: Final[Mapping[str, tuple[str, Extra]]] = {
    "av": ("PyAV", "video"),
    "cv2": ("OpenCV", "vision"),
    "distributed": ("Dask", "cluster"),
    "ezdxf": ("ezdxf", "imports"),
    "lerobot": ("LeRobot", "lerobot"),
    "matplotlib": ("Matplotlib", "exports"),
    "mujoco": ("MuJoCo", "physics"),
    "prometheus_client": ("prometheus-client", "metrics"),
    "psycopg": ("psycopg", "postgres"),
    "pxr": ("usd-core", "usd"),
    "pyarrow": ("PyArrow", "exports"),
    "rosbags": ("rosbags", "exports"),
    "rtde_control": ("ur-rtde", "ur"),
    "ruamel": ("ruamel.yaml", "exports"),
    "xacro": ("xacro", "xacro"),
}
"""The libraries of the extras by their modules: what people call each, and the extra that installs it."""

_PROJECT = Path(__file__).parents[1] / "pyproject.toml"


def own_version() -> str:
    """Return Pleat's version, as it is installed, or as a checkout that is not installed says it."""
    try:
        return version(NAME)
    except PackageNotFoundError:
        return str(tomllib.loads(_PROJECT.read_text(encoding="utf-8"))["project"]["version"])


def installing(extra: Extra) -> str:
    """Return the command that installs an extra: from the checkout, if Pleat runs from one, else from the index."""
    if not _PROJECT.is_file():
        return f"pip install '{NAME}[{extra}]'"
    own = Path(".venv") / "bin" / "pip"  # of `make run`, which nobody needs to have activated
    return f"{own if Path(sys.prefix) == _PROJECT.parent / '.venv' else 'pip'} install -e '.[{extra}]'"


def is_installed(module: str) -> bool:
    """Return whether a library of an extra is installed."""
    return find_spec(module) is not None


def missing(*modules: str) -> Message | None:
    """Return how to install the first of these libraries that is not installed; None if all are."""
    return next((_missing(module) for module in modules if not is_installed(module)), None)


def require(*modules: str, field: str = "") -> None:
    """Raise a `RequestError` about a field unless these libraries are installed."""
    if (message := missing(*modules)) is not None:
        raise RequestError(field, message)


def explained(error: ModuleNotFoundError) -> Message | None:
    """Return how to install the library that an import did not find; None if it is in no extra."""
    module = (error.name or "").partition(".")[0]
    return _missing(module) if module in _LIBRARIES else None


def _missing(module: str) -> Message:
    library, extra = _LIBRARIES[module]
    install = installing(extra)
    return Message(
        "library_missing", f"{library} is not installed: {install}", {"library": library, "install": install}
    )
