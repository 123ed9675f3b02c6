"""Plans of the shipped garments as plain JSON, each made once in a test run, whichever process is the first."""

import fcntl
import os
import pickle
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from planner import Plan, load_garment
from planner.planning.found_plan import FoundPlan
from tests.planning.found import found_plan
from tests.sweep import sweep

SOLVABLE = (
    "t-shirt",
    "jeans",
    "shirt",
    "tie",
    "scarf",
    "vest",
    "skirt",
    "big-towel",
    "hand-towel",
    "letter-towel",
)
IMPOSSIBLE = ("tie-halved", "scarf-halved")

each_solvable = sweep("name", SOLVABLE)
"""Give a test the name of each of them."""


PLANS = "PLEAT_TEST_PLANS"
"""Names the folder in which the processes of a test run leave plans for each other."""


@dataclass(frozen=True)
class Planned:
    """The checker's input, and the search that found the plan."""

    garment: dict[str, Any]
    scene: dict[str, Any]
    plan: dict[str, Any]
    found: FoundPlan


@cache
def planned(name: str) -> Planned:
    """Return the plan of a shipped garment in the default scene, with time enough for a cold machine."""
    garment = load_garment(name)
    with (Path(os.environ[PLANS]) / name).open("a+b") as file:
        fcntl.flock(file, fcntl.LOCK_EX)  # whoever comes meanwhile waits for the plan
        file.seek(0)
        if kept := file.read():
            found: FoundPlan = pickle.loads(kept)
        else:
            found = found_plan(garment, time_limit_s=60.0)
            file.write(pickle.dumps(found))
    return Planned(garment.to_dict(), found.plan.scene.to_dict(), found.plan.to_dict(), found)


def shipped_plan(name: str) -> Plan:
    """Return the plan of a shipped garment, which all tests of a process share."""
    return planned(name).found.plan
