"""Keep shapes in the user's cache: files that exist only once they are complete."""

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from planner.robots.collision.rounded_hull import RoundedHull

Arrays = Mapping[str, NDArray[Any]]


def hull_from(arrays: Arrays, name: str) -> RoundedHull:
    """Return the hull of a name; raise one of several errors where it is missing or malformed."""
    return RoundedHull(arrays[f"{name}/corners"], arrays[f"{name}/faces"], float(arrays[f"{name}/radius"]))


def hull_arrays(name: str, hull: RoundedHull) -> dict[str, NDArray[Any]]:
    """Return the arrays by which a hull is kept."""
    return {
        f"{name}/corners": hull.corners,
        f"{name}/faces": hull.faces,
        f"{name}/radius": np.array(hull.radius_m),
    }


def write_arrays(path: Path, arrays: Arrays) -> None:
    """Write arrays to a file atomically."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent, suffix=".npz")
    try:
        with os.fdopen(handle, "wb") as file:
            np.savez(file, allow_pickle=False, **arrays)
        Path(temporary).replace(path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
