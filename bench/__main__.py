"""The command line of the benchmark: print each table, write each as JSON under ``bench/out/``, draw the figures."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Final

from rich.console import Console

from bench.any_robot import any_robot
from bench.crowd import crowd
from bench.environment import environment
from bench.first_plan import first_plan
from bench.fold_to_size import fold_to_size
from bench.frames import frames
from bench.goals import goals
from bench.growth import growth
from bench.hand import hand
from bench.heuristics import heuristics
from bench.load import MINUTES, load
from bench.measurement import warm_up
from bench.paper import SOURCE, TABLE_1
from bench.paper_tables import table_1, table_2
from bench.re_plan import re_plan
from bench.reach import reach
from bench.rehearsal import LETTER, held_out, rehearsal
from bench.report import Report
from bench.robot_plans import robot_plans
from bench.round_a_box import round_a_box
from bench.sights import sights
from bench.studies import studies
from bench.two_at_once import two_at_once
from bench.vision import vision
from bench.whole_plans import whole_plans
from bench.yes_and_no import PAIRS, yes_and_no

Benchmark = Callable[[Sequence[str], int], Report]

BENCHMARKS: Final[Mapping[str, Benchmark]] = {
    "goals": goals,
    "table-1": table_1,
    "table-2": table_2,
    "heuristics": heuristics,
    "yes-and-no": yes_and_no,
    "whole-plans": whole_plans,
    "first-plan": first_plan,
    "re-plan": re_plan,
    "reach": reach,
    "any-robot": any_robot,
    "round-a-box": round_a_box,
    "robot-plans": robot_plans,
    "fold-to-size": fold_to_size,
    "growth": growth,
    "frames": frames,
    "hand": hand,
    "crowd": crowd,
    "load": load,
    "two-at-once": two_at_once,
    "studies": studies,
    "vision": vision,
    "sights": sights,
    "rehearsal": rehearsal,
    "held-out": held_out,
}
APART: Final = frozenset(
    {
        "reach",
        "any-robot",
        "round-a-box",
        "growth",
        "hand",
        "crowd",
        "load",
        "two-at-once",
        "studies",
        "vision",
        "sights",
        "held-out",
    }
)
"""Tables left out if garments are named and these are not: they have no garment, or need a browser or a server."""

ASKED: Final = frozenset({"rehearsal", "held-out"})
"""Tables made only where they are named: they take hours."""

GARMENTS: Final = (*TABLE_1, *(half for _, half in PAIRS), LETTER)
OUT: Final = Path(__file__).parent / "out"
DOCS: Final = Path(__file__).parent.parent / "docs"
REPETITIONS: Final = 5
WIDTH: Final = 120


def main(arguments: Sequence[str] | None = None, out: Path = OUT, docs: Path = DOCS) -> None:
    """Run the tables asked for; leave out tables without rows.

    Args:
        arguments: the command line; None for the process's own.
        out: the folder for the JSON.
        docs: the folder for figures; results of a single repetition are not drawn.
    """
    asked = _parser().parse_args(arguments)
    named = [name for name in GARMENTS if name in asked.only]
    garments = named or list(GARMENTS)
    usual = [name for name in BENCHMARKS if not (named and name in APART) and name not in ASKED]
    chosen = [name for name in BENCHMARKS if name in asked.only] or usual
    console = Console(highlight=False)
    console.width = max(console.width, WIDTH)
    warm_up()
    for name in chosen:
        benchmark = partial(load, minutes=asked.minutes) if name == "load" else BENCHMARKS[name]
        report = benchmark(garments, 1 if asked.quick else REPETITIONS)
        if report.rows:
            report.write(out)
            if report.figure and not asked.quick:
                (docs / f"{name}.svg").write_text(report.figure, encoding="utf-8")
            console.print(report.to_table(), "")
    now = environment()
    console.print(f"On {now['cores']} cores, which had {now['load']:.1f} processes to run in the last minute.")
    console.print("Times are medians; a ratio is followed by the least and the most that was measured.")
    console.print(f"Paper: {SOURCE}.")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m bench", description=__doc__)
    parser.add_argument("--quick", action="store_true", help=f"measure once, not {REPETITIONS} times")
    parser.add_argument("--minutes", type=float, help=f"how long `load` lasts, {MINUTES:g} by default")
    parser.add_argument(
        "--only",
        nargs="+",
        default=[],
        metavar="NAME",
        choices=[*BENCHMARKS, *GARMENTS],
        help=f"only these tables ({', '.join(BENCHMARKS)}) and only these garments ({', '.join(GARMENTS)})",
    )
    return parser


if __name__ == "__main__":
    main()
