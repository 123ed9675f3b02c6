"""What a benchmark was run on, as far as its figures depend on it."""

import os
import platform
from importlib.metadata import version

LIBRARIES = ("networkx", "numba", "numpy", "pin", "shapely", "viser")


def environment() -> dict[str, object]:
    """Cores, processes that wanted them in the last minute, and versions of what planning and showing rest on."""
    return {
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
        "architecture": platform.machine(),
        "system": platform.system(),
        "python": platform.python_version(),
        "libraries": {name: version(name) for name in LIBRARIES},
    }
