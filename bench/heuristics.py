"""The savings of the heuristic: A* with the arms' time as lower bound, against A* without one (h = 0)."""

from collections.abc import Sequence
from dataclasses import asdict
from statistics import median

from bench.measurement import BenchmarkError, Case, Measurement, Ratio, measure
from bench.paper import TABLE_2
from bench.report import Report, Row, count, seconds
from planner.geometry.tolerance import TIME_S

COLUMNS = ("garment", "C [s]", "expanded", "by h = 0", "times as many", "search [s]", "by h = 0", "times as long")
COMFORT_M = 0.03


def heuristics(garments: Sequence[str], repetitions: int) -> Report:
    """Measure the nine garments with both heuristics, in turns.

    Raises:
        BenchmarkError: the two do not find plans of the same cost.
    """
    rows = []
    for garment in (garment for garment in TABLE_2 if garment in garments):
        cases = [Case(garment, COMFORT_M, heuristic) for heuristic in ("arm_time", "zero")]
        informed, blind = measure(*cases, repetitions=repetitions)
        _require_same_cost(informed, blind)
        rows.append(_row(informed, blind))
    title = f"Heuristic arm_time against zero (comfort radius {COMFORT_M:g} m)"
    return Report("heuristics", title, COLUMNS, tuple(rows), repetitions)


def _require_same_cost(informed: Measurement, blind: Measurement) -> None:
    a, b = informed.outcome, blind.outcome
    if "budget_exceeded" in (a.status, b.status):
        return
    same_cost = a.cost_s is None or b.cost_s is None or abs(a.cost_s - b.cost_s) <= TIME_S
    if a.status != b.status or not same_cost:
        raise BenchmarkError(f"{informed.case.garment}: heuristics disagree on the best plan: {a}, {b}")


def _row(informed: Measurement, blind: Measurement) -> Row:
    ours, theirs = informed.outcome, blind.outcome
    more = theirs.expanded / ours.expanded
    longer = Ratio.of(blind.search_times_s, informed.search_times_s)
    data = {
        "garment": informed.case.garment,
        "arm_time": informed.to_dict(),
        "zero": blind.to_dict(),
        "expanded_ratio": more,
        "search_time_ratio": asdict(longer),
    }
    line = (
        informed.case.garment,
        seconds(ours.cost_s) if ours.status == "solved" else ours.status,
        count(ours.expanded),
        count(theirs.expanded),
        f"{more:.1f}",
        seconds(median(informed.search_times_s), 3),
        seconds(median(blind.search_times_s), 3),
        str(longer),
    )
    return Row((line,), data)
