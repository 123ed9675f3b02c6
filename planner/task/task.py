"""A task: all inputs on which a plan depends."""

from collections.abc import Mapping, Set
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Literal, TypeAlias, TypedDict, Unpack, get_args

from annotated_types import Interval

from planner.cloth.garment import Garment
from planner.errors import FieldError, RequestError
from planner.geometry.pose import Pose2
from planner.json_form import STRICT, JsonForm, require_intervals
from planner.task.scene import Scene
from planner.task.world_state import WORLD_STATES, BaseStop, WorldState


def require_version(data: Mapping[str, Any], key: str, newest: int, fields: Set[str]) -> None:
    """Raise `RequestError` unless JSON is an object of a known version with exactly the version's field and these.

    Args:
        data: the object.
        key: the field of the version.
        newest: the newest known version.
        fields: the names of its other fields.
    """
    if not isinstance(data, Mapping):
        raise RequestError("", "is not a JSON object")
    version = data.get(key)
    if not isinstance(version, int) or isinstance(version, bool) or version < 1:
        raise RequestError(key, "is missing" if version is None else f"{version!r} is no version")
    if version > newest:
        raise RequestError(key, f"is {version}, newer than {newest}, the newest that this program reads")
    for name in data:
        if name != key and name not in fields:
            raise RequestError(str(name), "is not a known field")
    for name in sorted(fields):
        if name not in data:
            raise RequestError(name, "is missing")


VERSION = 1

DEFAULT_ROBOT = "pr2"
"""The robot of a task that names none."""

HeuristicName: TypeAlias = Literal["arm_time", "zero"]
"""The lower bounds on the remaining time, by name."""

TIME_LIMIT_S = (0.01, 60.0)
COMFORT_MAX_M = 0.1


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of the search: the accuracy of the plan, and the effort to find it.

    Attributes:
        comfort_radius_m: a point counts as reachable only if a circle of this radius round it is (m).
        heuristic: the lower bound on the remaining time.
        time_limit_s: the processor time for the search (s); by the clock on the wall it ends after ten times that and
            5 s more.
        work_limit_s: the work for the search, in seconds of a present-day machine; None for as much as the time limit.
            If work ends the search before time does, the task has the same answer on every machine.
        max_expanded: the most states that the search may expand.
    """

    __pydantic_config__ = STRICT

    comfort_radius_m: Annotated[float, Interval(ge=0.0, le=COMFORT_MAX_M)] = 0.03
    heuristic: HeuristicName = "arm_time"
    time_limit_s: Annotated[float, Interval(ge=TIME_LIMIT_S[0], le=TIME_LIMIT_S[1])] = 10.0
    work_limit_s: float | None = None
    max_expanded: Annotated[int, Interval(ge=1, le=1_000_000)] = 100_000

    def __post_init__(self) -> None:
        """Check the fields; raises `RequestError` for a number out of range."""
        require_intervals(self, RequestError)
        if self.heuristic not in get_args(HeuristicName):
            raise RequestError("heuristic", f"expected {' or '.join(get_args(HeuristicName))}, got {self.heuristic!r}")


class TaskOptions(TypedDict, total=False):
    """The options of a task besides garment and scene; see `Task.of`."""

    placement: Pose2 | None
    start_station: str
    start: WorldState | None
    robot: str
    comfort_radius_m: float
    heuristic: str
    time_limit_s: float
    work_limit_s: float | None
    max_expanded: int


_LIMITS = frozenset(Limits.__slots__)
_KINDS = {"placement": Pose2, "start": WorldState, "robot": str}


def require_options(scene: object, options: Mapping[str, object]) -> None:
    """Check what a task is made from; raise `RequestError` for an unknown option or a value of a wrong kind.

    The values of limits and the station's name are checked where they are used.
    """
    if not isinstance(scene, Scene | None):
        raise RequestError("scene", f"{scene!r:.80} is no Scene")
    for name, value in options.items():
        if name not in TaskOptions.__annotations__:
            raise RequestError(name, f"unknown option; valid: {', '.join(TaskOptions.__annotations__)}")
        kind = _KINDS.get(name)
        if kind is not None and not isinstance(value, kind) and (value is not None or name == "robot"):
            raise RequestError(name, f"{value!r:.80} is no {'name' if kind is str else kind.__name__}")


@dataclass(frozen=True, slots=True)
class Task:
    """The problem that is planned; equal tasks have equal plans.

    Attributes:
        garment: the garment, its folds in the user's order.
        scene: table, stations and costs.
        robot: the robot's name.
        start: the state of the world before the first step.
        limits: the accuracy of the plan, and the effort to find it.
    """

    garment: Garment
    scene: Scene
    robot: str
    start: WorldState
    limits: Limits = field(default_factory=Limits)

    def __post_init__(self) -> None:
        """Check the start; raises `RequestError` if it names folds that the garment does not have."""
        folds, done = range(len(self.garment.folds)), self.start.folds_done
        for index, fold in enumerate(done):
            if fold not in folds:
                raise RequestError(f"start.folds_done[{index}]", f"there is no fold {fold}, only {len(folds)}")
            if fold in done[:index]:
                raise RequestError(f"start.folds_done[{index}]", f"fold {fold} is named twice")

    @staticmethod
    def of(garment: Garment, scene: Scene | None = None, **options: Unpack[TaskOptions]) -> "Task":
        """Return the task of folding a garment; options left out have their defaults.

        Args:
            garment: the garment.
            scene: the scene; None for the default one.
            options: `placement`, where the garment lies at the start, by default the garment's own; `start_station`,
                where the robot stands then, by default "front"; or `start`, the whole state of the world then; `robot`,
                by default `DEFAULT_ROBOT`; and the fields of `Limits`.

        Raises:
            RequestError: there is no such station or option, an option is of the wrong kind or a limit is out of range.
        """
        require_options(scene, options)
        where, given = scene or Scene(), dict(options)
        limits = Limits(**{name: given.pop(name) for name in list(given) if name in _LIMITS})  # type: ignore[arg-type]
        start = options.get("start") or at_station(
            where, options.get("placement") or garment.placement, options.get("start_station", "front")
        )
        return Task(garment, where, options.get("robot", DEFAULT_ROBOT), start, limits)

    def at(self, placement: Pose2) -> "Task":
        """Return this task with the garment elsewhere at the start."""
        return replace(self, start=replace(self.start, placement=placement))

    def within(self, comfort_radius_m: float) -> "Task":
        """Return this task with another comfort radius (m)."""
        return replace(self, limits=replace(self.limits, comfort_radius_m=comfort_radius_m))

    def in_scene(self, scene: Scene) -> "Task":
        """Return this task in another scene; a base at a station moves to the new station of that name."""
        base, stations = self.start.base, dict(scene.stations)
        if base.station in stations:
            base = BaseStop.at(base.station, stations[base.station], base.back_off_m)
        return replace(self, scene=scene, start=replace(self.start, base=base))

    def to_dict(self) -> dict[str, Any]:
        """Return the task as JSON."""
        return {
            "version": VERSION,
            "garment": self.garment.to_dict(),
            "scene": self.scene.to_dict(),
            "robot": self.robot,
            "start": self.start.to_dict(),
            "limits": _LIMITS_FORM.write(self.limits),
        }

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> "Task":
        """Return the task that JSON holds.

        Raises:
            FieldError: names the field, and says what is wrong with which number.
        """
        require_version(data, "version", VERSION, {"garment", "scene", "robot", "start", "limits"})
        if not isinstance(data["robot"], str):
            raise RequestError("robot", f"expected a string, got {data['robot']!r:.80}")
        return Task(
            _within("garment", Garment.from_dict, data["garment"]),
            _within("scene", Scene.from_dict, data["scene"]),
            data["robot"],
            _within("start", WORLD_STATES.read, data["start"]),
            _within("limits", _LIMITS_FORM.read, data["limits"]),
        )


def at_station(scene: Scene, placement: Pose2, station: str, back_off_m: float = 0.0) -> WorldState:
    """Return the state before all folds: the garment laid down, hands free, the base at a station.

    Raises:
        RequestError: there is no such station.
    """
    stations = dict(scene.stations)
    if station not in stations:
        raise RequestError("start_station", f"expected one of {', '.join(stations)}; got {station!r}")
    return WorldState((), placement, BaseStop.at(station, stations[station], back_off_m))


def _within(field_name: str, read: Any, data: object) -> Any:  # noqa: ANN401
    try:
        return read(data)
    except FieldError as error:
        raise error.within(field_name) from None


_LIMITS_FORM = JsonForm(Limits)
