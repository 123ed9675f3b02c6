"""The environment of a benchmark, as far as its results depend on it."""

import os
import platform
from importlib.metadata import version

LIBRARIES = ("networkx", "numba", "numpy", "pin", "shapely", "viser")


def environment() -> dict[str, object]:
    """Return the cores, the load of the last minute, and the versions of the libraries that plan and show."""
    return {
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
        "architecture": platform.machine(),
        "system": platform.system(),
        "python": platform.python_version(),
        "libraries": {name: version(name) for name in LIBRARIES},
    }
