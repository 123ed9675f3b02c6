"""What a benchmark was run on, as far as its figures depend on it."""

import os
import platform
from importlib.metadata import version

LIBRARIES = ("networkx", "numba", "numpy", "pin", "shapely")


def environment() -> dict[str, object]:
    """The number of cores and the versions of Python and of the libraries that planning rests on."""
    return {
        "cores": os.cpu_count(),
        "architecture": platform.machine(),
        "system": platform.system(),
        "python": platform.python_version(),
        "libraries": {name: version(name) for name in LIBRARIES},
    }
