"""The growth of search time and expansions with the number of folds, the number of stations, and the comfort radius.

The cases are solvable (see `bench.growth_cases`). Where the time runs out, the counts at that moment are given.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

from bench.chart import Panel, Point, Series, draw
from bench.growth_cases import crowded, ribbon, tabs, tabs_on_two_sides
from bench.paper import TABLE_2
from bench.report import Report, Row, count, seconds
from planner import Garment, Plan, Scene, load_garment, make_plan

COLUMNS = ("case", "size", "answer", "C [s]", "expanded", "IK queries", "search [s]", "joints [s]")
COMFORT_M = 0.03
BUDGET_S = 10.0
OUT_OF_TIME = "out of time"
SLOW_S = 2.0
"""Duration from which a search is not repeated (s)."""

FOLDS = (2, 5, 10, 20, 40)
STATIONS = (5, 10, 20, 50)
COMFORTS_CM = (1, 2, 3, 4, 5)
CHAINED, FREE, SCATTERED = "ribbon rolled up", "tabs within reach", "tabs on two sides"
WITH_STATIONS = ("t-shirt", "jeans", "shirt")
WITH_COMFORT = ("t-shirt", "tie", "hand-towel")
NINE = "the nine together"

FOLDS_PANEL, STATIONS_PANEL, COMFORT_PANEL = "folds", "stations", "comfort radius [cm]"


@dataclass(frozen=True, slots=True)
class Case:
    """A case: a problem of one size.

    Attributes:
        panel: the quantity that grows.
        series: the name of the problem.
        size: the value of the quantity.
        garments: the garments planned, whose results are added up.
        scene: the scene.
        comfort_radius_m: the comfort radius (m).
    """

    panel: str
    series: str
    size: int
    garments: tuple[Garment, ...]
    scene: Scene
    comfort_radius_m: float = COMFORT_M


@dataclass(frozen=True, slots=True)
class Grown:
    """A case and its results: median times (s), costs (s) and counts, summed over the garments."""

    case: Case
    status: str
    cost_s: float | None
    expanded: int
    explored: int
    ik_queries: int
    search_time_s: float
    joint_time_s: float


def growth(_: Sequence[str], repetitions: int) -> Report:
    """Measure all cases, or the smallest of each series in a quick run; no garment is chosen by name."""
    found = [_grown(case, repetitions) for case in cases(is_quick=repetitions == 1)]
    rows = tuple(_row(one) for one in found)
    title = f"Growth with folds, stations and comfort (at most {BUDGET_S:g} s a search)"
    return Report("growth", title, COLUMNS, rows, repetitions, figure=draw(_panels(found)))


def cases(*, is_quick: bool) -> Iterator[Case]:
    """Yield the cases; in a quick run the smallest of each series, without the nine together."""
    some: Callable[[Sequence[int]], Sequence[int]] = (lambda sizes: sizes[:1]) if is_quick else (lambda sizes: sizes)
    scene = Scene()
    for name, make in ((CHAINED, ribbon), (FREE, tabs), (SCATTERED, tabs_on_two_sides)):
        for size in some(FOLDS):
            yield Case(FOLDS_PANEL, name, size, (make(size),), scene)
    for name in WITH_STATIONS:
        for size in some(STATIONS):
            yield Case(STATIONS_PANEL, name, size, (load_garment(name),), crowded(size))
    alone: dict[str, tuple[str, ...]] = {name: (name,) for name in WITH_COMFORT}
    for name, names in (alone if is_quick else alone | {NINE: tuple(TABLE_2)}).items():
        for size in some(COMFORTS_CM):
            garments = tuple(load_garment(one) for one in names)
            yield Case(COMFORT_PANEL, name, size, garments, scene, size / 100)


def _grown(case: Case, repetitions: int) -> Grown:
    runs: list[list[Plan]] = []
    while len(runs) < repetitions and (not runs or _search_s(runs[0]) <= SLOW_S):
        runs.append([_planned(case, garment) for garment in case.garments])
    plans = runs[0]
    statuses = {OUT_OF_TIME if plan.statistics.is_cut_short else plan.status for plan in plans}
    is_solved = statuses == {"solved"}
    return Grown(
        case,
        "solved" if is_solved else ", ".join(sorted(statuses - {"solved"})),
        sum(plan.cost_s or 0.0 for plan in plans) if is_solved else None,
        sum(plan.statistics.expanded for plan in plans),
        sum(plan.statistics.explored for plan in plans),
        sum(plan.statistics.ik_queries for plan in plans),
        median(_search_s(run) for run in runs),
        median(sum(plan.statistics.joint_time_s for plan in run) for run in runs),
    )


def _search_s(plans: Sequence[Plan]) -> float:
    return sum(plan.statistics.search_time_s for plan in plans)


def _planned(case: Case, garment: Garment) -> Plan:
    return make_plan(garment, case.scene, comfort_radius_m=case.comfort_radius_m, time_limit_s=BUDGET_S)


def _row(grown: Grown) -> Row:
    case = grown.case
    fields = ("status", "cost_s", "expanded", "explored", "ik_queries", "search_time_s", "joint_time_s")
    data: dict[str, Any] = {name: getattr(grown, name) for name in fields}
    line = (
        case.series,
        f"{case.size} {case.panel}" if case.panel != COMFORT_PANEL else f"{case.size} cm",
        grown.status,
        seconds(grown.cost_s),
        count(grown.expanded),
        count(grown.ik_queries),
        seconds(grown.search_time_s, 3),
        seconds(grown.joint_time_s, 3),
    )
    return Row((line,), {"grows": case.panel, "series": case.series, "size": case.size, **data})


def _panels(found: Sequence[Grown]) -> list[list[Panel]]:
    """Return search times above, expansions below; one column for each quantity that grows."""
    measures: tuple[tuple[str, Callable[[Grown], float]], ...] = (
        ("search time [s]", lambda one: one.search_time_s),
        ("states expanded", lambda one: float(one.expanded)),
    )
    return [
        [_panel(found, grows, words, measure) for grows in (FOLDS_PANEL, STATIONS_PANEL, COMFORT_PANEL)]
        for words, measure in measures
    ]


def _panel(found: Sequence[Grown], grows: str, words: str, measure: Callable[[Grown], float]) -> Panel:
    here = [one for one in found if one.case.panel == grows]
    names = list(dict.fromkeys(one.case.series for one in here))
    return Panel(
        grows,
        words,
        tuple(
            Series(
                name,
                tuple(
                    Point(one.case.size, measure(one), one.status == "solved")
                    for one in here
                    if one.case.series == name
                ),
            )
            for name in names
        ),
    )
