"""How near landmarks of folded stacks are found in rendered pictures, as a robot looks at them between two steps."""

from collections.abc import Sequence
from dataclasses import asdict
from statistics import median
from typing import Any

import numpy as np

from bench.report import ABSENT, Report, Row, seconds
from bench.stack_sights import NEAR_M, Sighted, overhead_bench

PICTURES, PICTURES_QUICK = 40, 2
"""Pictures of each kind."""

FIRST = 40
"""The number of the first picture: those before were used to calibrate the errors that a look tells."""

KINDS = (
    ("default table and cloth", True, False),
    ("default, an arm over a corner", True, True),
    ("by chance", False, False),
    ("by chance, an arm over a corner", False, True),
)
"""The name of each kind of picture, whether table and cloth are the default's, and whether an arm hides a corner."""

KNOWN_M = 0.02
"""A landmark that may be farther off, as it was told, counts as not known (m)."""

COLUMNS = (
    "",
    "pictures",
    "known",
    "landmarks known",
    "<= 1 cm",
    "median [mm]",
    "95 %",
    "worst",
    "error told covers",
    "picture, CPU [s]",
    "look, CPU [s]",
)


def sights(_: Sequence[str], repetitions: int) -> Report:
    """Look at stacks of random states, at the default table and at tables by chance, with and without an arm."""
    number = PICTURES if repetitions > 1 else PICTURES_QUICK
    bench = overhead_bench()
    rows = [
        row_of(kind, [bench.sight(index, is_plain=is_plain, has_arm=has_arm) for index in range(FIRST, FIRST + number)])
        for kind, is_plain, has_arm in KINDS
    ]
    return Report("sights", "Landmarks of stacks in rendered pictures", COLUMNS, tuple(rows), 1)


def row_of(kind: str, seen: Sequence[Sighted]) -> Row:
    """Return the row of some pictures; landmarks are those of stacks whose place is told as known."""
    known = [one for one in seen if one.doubt is None]
    every = np.array([off for one in known for off in one.off_m])
    told_m = np.array([told for one in known for told in one.told_m])
    off = every[told_m <= KNOWN_M]
    told: dict[str, Any] = {
        "kind": kind,
        "pictures": len(seen),
        "known": len(known),
        "landmarks": len(every),
        "landmarks_known": len(off),
        "near": float((off <= NEAR_M).mean()) if len(off) else None,
        "median_m": float(np.median(off)) if len(off) else None,
        "p95_m": float(np.quantile(off, 0.95)) if len(off) else None,
        "worst_m": float(off.max()) if len(off) else None,
        "covers": float(np.mean([_is_covered(one) for one in known])) if known else None,
        "covers_landmarks": float((every <= told_m).mean()) if len(every) else None,
        "drawn_s": median(one.drawn_s for one in seen),
        "looked_s": median(one.looked_s for one in seen),
    }
    line = (
        kind,
        str(told["pictures"]),
        str(told["known"]),
        f"{told['landmarks_known']} of {told['landmarks']}",
        _share(told["near"]),
        *(_millimetres(told[name]) for name in ("median_m", "p95_m", "worst_m")),
        _share(told["covers"]),
        seconds(told["drawn_s"]),
        seconds(told["looked_s"]),
    )
    return Row((line,), {**told, "all": [asdict(one) for one in seen]})


def _is_covered(one: Sighted) -> bool:
    """Return whether no landmark of a picture is farther off than it was told."""
    return all(off <= told for off, told in zip(one.off_m, one.told_m, strict=True))


def _share(value: float | None) -> str:
    return ABSENT if value is None else f"{value:.0%}"


def _millimetres(value_m: float | None) -> str:
    return ABSENT if value_m is None else f"{1000 * value_m:.1f}"
