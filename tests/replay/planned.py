"""Plans of the shipped garments as plain JSON, each made once in a test run."""

from dataclasses import dataclass
from functools import cache
from typing import Any

from planner import Plan, Scene, load_garment, make_plan

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


@dataclass(frozen=True)
class Planned:
    """What the checker is given."""

    garment: dict[str, Any]
    scene: dict[str, Any]
    plan: dict[str, Any]
    answer: Plan


@cache
def planned(name: str) -> Planned:
    """The plan of a shipped garment in the default scene, with time enough for a cold machine."""
    garment = load_garment(name)
    answer = make_plan(garment, Scene(), time_limit_s=60.0)
    return Planned(garment.to_dict(), answer.scene.to_dict(), answer.to_dict(), answer)
