"""The location of the PR2's description on disk, and functions that read it."""

from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from xml.etree import ElementTree

import pinocchio as pin

from planner.errors import FoldingError
from planner.robots.chain_reader import keep_soft_limits

_DISTRIBUTION = "example-robot-data"
_SHARE = "cmeel.prefix/share"
_URDF = "example-robot-data/robots/pr2_description/urdf/pr2.urdf"


def package_directory() -> Path:
    """Return the directory to which the URDF's ``package://`` addresses are relative.

    Raises:
        FoldingError: the package that carries the PR2 is not installed, or came without it.
    """
    try:
        directory = Path(str(distribution(_DISTRIBUTION).locate_file(_SHARE)))
    except PackageNotFoundError as error:
        raise FoldingError(f"the PR2's model is missing: install the package {_DISTRIBUTION!r}") from error
    if not (directory / _URDF).is_file():
        raise FoldingError(f"the package {_DISTRIBUTION!r} carries no PR2: there is no {directory / _URDF}")
    return directory


def urdf_path() -> Path:
    """Return the path of the PR2's URDF; raise `FoldingError` like `package_directory`."""
    return package_directory() / _URDF


def read_model() -> pin.Model:
    """Return the kinematic tree of the PR2, its root fixed to ``base_footprint``, with its soft limits (10 ms)."""
    path = urdf_path()
    return keep_soft_limits(pin.buildModelFromUrdf(str(path)), ElementTree.parse(path).getroot())
