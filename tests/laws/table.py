"""Print a table of random hoods, ponchos and jumpers: cost, bound, gap, and by how much each law is broken.

python -m tests.laws.table --count 100
"""

import argparse
import math
from random import Random
from time import process_time

from planner import deadline
from tests.laws.plan_laws import LAWS, Differences, differences
from tests.laws.wear import wear_task


def main() -> None:
    """Print a line for each garment, then the largest of each column, and how many garments break a law."""
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("--count", type=int, default=20, help="garments")
    asked.add_argument("--first", type=int, default=0, help="the seed of the first one")
    asked.add_argument("--laws", nargs="*", default=list(LAWS), choices=list(LAWS), help="the laws that are tried")
    options = asked.parse_args()
    deadline.clock_s = process_time
    print("seed  folds  status      cost s  bound s   gap %  cpu s  " + "  ".join(f"{law:>8}" for law in options.laws))
    found: list[Differences] = []
    for seed in range(options.first, options.first + options.count):
        begun_s = process_time()
        problem = wear_task(Random(seed))
        found.append(differences(problem, seed, tuple(options.laws)))
        print(_line(seed, len(problem.garment.folds), found[-1], process_time() - begun_s), flush=True)
    _print_totals(found, options.laws)


def _line(seed: int, folds: int, one: Differences, spent_s: float) -> str:
    plan = one.plan
    cost_s = math.nan if plan.cost_s is None else plan.cost_s
    bound_s = math.nan if plan.statistics.bound_s is None else plan.statistics.bound_s
    told = "proven" if plan.is_solved and plan.is_proven else plan.status[:10]
    gap = 1e2 * one.gap_s / cost_s
    head = f"{seed:4}  {folds:5}  {told:10}  {cost_s:6.2f}  {bound_s:7.2f}  {gap:6.2f}  {spent_s:5.0f}"
    return "  ".join((head, *(f"{broken:8.3f}" for broken in one.by_law.values())))


def _print_totals(found: list[Differences], laws: list[str]) -> None:
    gaps = [1e2 * one.gap_s / (one.plan.cost_s or math.nan) for one in found if one.plan.is_solved]
    wide = sum(gap > 3.0 for gap in gaps)
    print(f"\n{len(found)} garments, {len(gaps)} plans, gap: {wide} over 3 %, mean {sum(gaps) / len(gaps):.2f} %")
    print(f"{'law':>10}  broken  largest s  mean s")
    for law in laws:
        broken = [one.by_law[law] for one in found]
        finite = [one for one in broken if math.isfinite(one)]
        print(f"{law:>10}  {sum(map(bool, broken)):6}  {max(broken):9.3f}  {sum(finite) / max(1, len(finite)):6.3f}")


if __name__ == "__main__":
    main()
