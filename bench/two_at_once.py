"""The processor time of two plans asked for at once over REST, beside the same two one after the other.

They take turns, on one server that has planned both before. Counted is the time of all its processes, those included
that have ended: each plan runs in one of its own. In one interpreter two searches at once took 1.45 times the work.
"""

import threading
from collections.abc import Sequence
from functools import partial
from statistics import median

from bench.paper import TABLE_2
from bench.processes import family, family_cpu_s
from bench.report import Report, Row
from bench.served import ask, served

COLUMNS = ("plans", "in turn, CPU [ms]", "at once, CPU [ms]", "times the work")
PAIR = 2


def two_at_once(garments: Sequence[str], repetitions: int) -> Report:
    """Measure each two garments that follow each other, in turn and at once."""
    asked = [garment for garment in TABLE_2 if garment in garments]
    pairs = [asked[start : start + PAIR] for start in range(0, len(asked) - 1, PAIR)]
    rows: list[Row] = []
    if pairs:
        with served() as (url, process):
            rows = [_row(pair, *_measured(url, process.pid, pair, repetitions)) for pair in pairs]
    return Report("two-at-once", "Two plans at once over REST, and in turn", COLUMNS, tuple(rows), repetitions)


def _measured(url: str, pid: int, pair: Sequence[str], repetitions: int) -> tuple[float, float]:
    """Return the CPU time of two plans in turn and at once (s), medians."""
    _in_turn(url, pair)  # the server has loaded all then
    linked: list[float] = []
    at_once: list[float] = []
    for _ in range(repetitions):
        for times, way in ((linked, _in_turn), (at_once, _at_once)):
            before_s = family_cpu_s(family(pid))
            way(url, pair)
            times.append(family_cpu_s(family(pid)) - before_s)
    return median(linked), median(at_once)


def _in_turn(url: str, pair: Sequence[str]) -> None:
    for garment in pair:
        ask("POST", f"{url}/api/plans", {"garment": garment})


def _at_once(url: str, pair: Sequence[str]) -> None:
    threads = [threading.Thread(target=partial(_in_turn, url, [garment])) for garment in pair]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def _row(pair: Sequence[str], in_turn_s: float, at_once_s: float) -> Row:
    times = at_once_s / in_turn_s
    line = (" and ".join(pair), f"{1e3 * in_turn_s:.0f}", f"{1e3 * at_once_s:.0f}", f"{times:.2f}")
    data = {"plans": list(pair), "in_turn_cpu_s": in_turn_s, "at_once_cpu_s": at_once_s, "times_the_work": times}
    return Row((line,), data)
