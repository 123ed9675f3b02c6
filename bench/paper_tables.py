"""The paper's Tables 1 and 2 reproduced: the nine garments, our results above the paper's."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from statistics import median
from typing import Any

from bench.measurement import Case, Measurement, measure
from bench.paper import SOURCE, TABLE_1, TABLE_2, PaperRow
from bench.report import Report, Row, count, seconds

COLUMNS = ("garment", "by", "folds", "L", "C [s]", "expanded", "explored", "IK queries", "IK time [s]", "search [s]")


def table_1(garments: Sequence[str], repetitions: int) -> Report:
    """Measure Table 1: a point counts as reachable without a comfort radius."""
    return _report("table-1", 0.0, TABLE_1, garments, repetitions)


def table_2(garments: Sequence[str], repetitions: int) -> Report:
    """Measure Table 2: a comfort radius of 3 cm."""
    return _report("table-2", 0.03, TABLE_2, garments, repetitions)


def _report(
    name: str, comfort_m: float, paper: Mapping[str, PaperRow], garments: Sequence[str], repetitions: int
) -> Report:
    rows = []
    for garment in (garment for garment in paper if garment in garments):
        (measured,) = measure(Case(garment, comfort_m), repetitions=repetitions)
        rows.append(_row(measured, paper[garment]))
    title = f"{name.replace('-', ' ').capitalize()}: plans with a comfort radius of {comfort_m:g} m"
    return Report(name, title, COLUMNS, tuple(rows), repetitions, SOURCE)


def _row(measured: Measurement, paper: PaperRow) -> Row:
    outcome = measured.outcome
    ours = (
        measured.case.garment,
        "Pleat",
        count(outcome.folds),
        count(outcome.primitives),
        seconds(outcome.cost_s) if outcome.status == "solved" else outcome.status,
        count(outcome.expanded),
        count(outcome.explored),
        count(outcome.ik_queries),
        seconds(median(measured.ik_times_s), 3),
        seconds(median(measured.search_times_s), 3),
    )
    theirs = (
        "",
        "paper",
        count(paper.folds),
        count(paper.primitives),
        seconds(paper.cost_s),
        count(paper.expanded),
        count(paper.explored),
        count(paper.ik_queries),
        seconds(paper.ik_time_s),
        seconds(paper.search_time_s),
    )
    data: dict[str, Any] = {"pleat": measured.to_dict(), "paper": asdict(paper)}
    return Row((ours, theirs), {"garment": measured.case.garment, **data})
