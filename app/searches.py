"""Work that may take long, as it runs in a process of its own: it takes and gives what can be sent there."""

from dataclasses import dataclass
from typing import Any, TypedDict

from app.files.crease_reading import Creases
from app.files.import_file import Imported, import_file
from app.jobs.apart import Tell
from app.store.recorded_plan import RecordedPlan
from planner import make_plan
from planner.cloth.garment import Garment
from planner.geometry.pose import Pose2
from planner.plan.suggestion_map import PlacementMap, placement_map
from planner.plan.suggestions import suggestions
from planner.task.scene import Scene


class Options(TypedDict):
    """Options of `make_plan`, `suggestions` and `placement_map` alike."""

    placement: Pose2 | None
    start_station: str
    robot: str
    comfort_radius_m: float
    heuristic: str
    time_limit_s: float
    work_limit_s: float | None
    max_expanded: int


@dataclass(frozen=True, slots=True)
class Suggested:
    """A suggestion as JSON, and the plan that proves it."""

    body: dict[str, Any]
    plan: RecordedPlan


def plan(_: Tell, garment: Garment, scene: Scene, options: Options) -> RecordedPlan:
    """Plan, as `make_plan` does."""
    return RecordedPlan.of(make_plan(garment, scene, **options))


def suggest(tell: Tell, garment: Garment, scene: Scene, options: Options) -> bool:
    """Tell None once the request is found good, then each suggestion; return whether all changes were tried."""
    found = suggestions(garment, scene, **options)
    tell(None)
    while True:
        try:
            suggestion = next(found)
        except StopIteration as end:
            return bool(end.value)
        tell(Suggested(suggestion.to_dict(), RecordedPlan.of(suggestion.plan)))


def map_places(_: Tell, garment: Garment, scene: Scene, step_m: float, options: dict[str, Any]) -> PlacementMap:
    """Plan wherever the garment could be laid, as `placement_map` does."""
    return placement_map(garment, scene, step_m=step_m, **options)


def read_file(
    _: Tell, filename: str, data: bytes, units: str | None, scale: float, creases: Creases | None
) -> Imported:
    """Read a garment from a file, as `import_file` does."""
    return import_file(filename, data, units, scale, creases)
