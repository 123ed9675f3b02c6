"""The cost of a "no": the same cloth with its folds in a feasible order, and in an order that is too long for a PR2.

A "no" is a proof: the search has visited every reachable state. It is told then, with the reasons that the search met;
trying these takes longer than the proof, so both times are given. Without a comfort radius the robot may find a way
that it does not find with one, so both are measured.
"""

from collections.abc import Sequence
from dataclasses import asdict
from statistics import median

from bench.measurement import Case, Measurement, Ratio, measure
from bench.report import Report, Row, count, seconds

COLUMNS = (
    "garment",
    "comfort [m]",
    "answer",
    "C [s]",
    "expanded",
    "told [s]",
    "times as long",
    "IK queries",
    "all [s]",
)
PAIRS = (("scarf", "scarf-halved"), ("tie", "tie-halved"))
COMFORTS_M = (0.0, 0.03)


def yes_and_no(garments: Sequence[str], repetitions: int) -> Report:
    """Measure both orders of the folds of scarf and tie, in turns."""
    rows = []
    for pair in PAIRS:
        for comfort_m in COMFORTS_M if set(pair) & set(garments) else ():
            quarter, half = measure(*(Case(name, comfort_m) for name in pair), repetitions=repetitions)
            rows.append(_row(quarter, half))
    title = "A yes and a no: begun with the quarter, begun with the half"
    return Report("yes-and-no", title, COLUMNS, tuple(rows), repetitions)


def _row(quarter: Measurement, half: Measurement) -> Row:
    longer = Ratio.of(half.told_times_s, quarter.told_times_s)
    data = {
        "quarter_first": quarter.to_dict(),
        "half_first": half.to_dict(),
        "told_time_ratio": asdict(longer),
    }
    return Row((_line(quarter, ""), _line(half, str(longer))), data)


def _line(measured: Measurement, ratio: str) -> tuple[str, ...]:
    outcome = measured.outcome
    return (
        measured.case.garment,
        f"{measured.case.comfort_radius_m:g}",
        outcome.status,
        seconds(outcome.cost_s),
        count(outcome.expanded),
        seconds(median(measured.told_times_s), 3),
        ratio,
        count(outcome.ik_queries),
        seconds(median(measured.plan_times_s), 3),
    )
