"""Proposals of folds: how soon the first ones come, and how soon robots have plans for them.

Outlines of many kinds, beside the nine garments. Without a robot the search is timed alone: until the first packet,
and until three different ways. With a robot it is timed until the first proposal that can be done, and the third. All
times are those of the processor, in one process, with nothing known but compiled kernels. The nine are also folded to
the size of their own packets, and the quickest proposal is set beside the garment's own folds.
"""

from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass, replace
from time import process_time
from typing import Final

from bench.paper import TABLE_2
from bench.report import ABSENT, Report, Row
from planner import Garment, load_garment, make_plan, propose_folds
from planner.folds.fold_sequence import replayed
from planner.geometry.pose import Point2
from planner.motion.transfer_planner import forget_paths
from planner.planning.problem import forget_garments
from planner.planning.robot_task import default_scene, near_placement
from planner.planning.warm_up import compile_kernels
from planner.proposals.packet import Way
from planner.proposals.packet_search import PacketSearch
from planner.proposals.target import Target
from planner.robots.load_robot import load_robot
from planner.task.task import DEFAULT_ROBOT

ROBOTS: Final = (DEFAULT_ROBOT, "ur5e-pair")

COLUMNS: Final = (
    "outline",
    "to",
    "first [s]",
    "three ways [s]",
    *(f"{robot} {rank} [s]" for robot in ROBOTS for rank in ("1st", "3rd")),
    "own folds [s]",
    "quickest [s]",
)

YAW_RAD: Final = -1.5707963267948966
"""How outlines lie on the default robot's table: lengthwise, as most garments do (rad)."""

MAX_FOLDS: Final = 8

OUTLINES: Final[Mapping[str, tuple[str, Sequence[Point2]]]] = {
    "apron": (
        "shelf",
        ((0, 0), (0.6, 0), (0.6, 0.5), (0.45, 0.55), (0.42, 0.8), (0.18, 0.8), (0.15, 0.55), (0, 0.5)),
    ),
    "romper": (
        "20x25cm",
        (
            (0.05, 0),
            (0.18, 0),
            (0.2, 0.12),
            (0.22, 0),
            (0.35, 0),
            (0.33, 0.3),
            (0.45, 0.26),
            (0.48, 0.36),
            (0.3, 0.45),
            (0.1, 0.45),
            (-0.08, 0.36),
            (-0.05, 0.26),
            (0.07, 0.3),
        ),
    ),
    "kimono": (
        "shelf",
        ((0.3, 0), (0.7, 0), (0.7, 0.35), (1, 0.35), (1, 0.7), (0, 0.7), (0, 0.35), (0.3, 0.35)),
    ),
    "pillow-case": ("shelf", ((0, 0), (0.8, 0), (0.8, 0.5), (0, 0.5))),
    "bandana": ("20x25cm", ((0, 0), (0.56, 0), (0.28, 0.28))),
    "hexagon": ("20x25cm", ((0.15, 0), (0.45, 0), (0.6, 0.26), (0.45, 0.52), (0.15, 0.52), (0, 0.26))),
    "poncho": ("shelf", ((0, 0.45), (0.45, 0), (0.9, 0.45), (0.55, 0.8), (0.35, 0.8))),
    "hood": ("20x25cm", ((0, 0), (0.28, 0), (0.28, 0.2), (0.22, 0.34), (0.08, 0.36), (0, 0.3))),
    "glove": (
        "12x15cm",
        (
            (0.02, 0),
            (0.12, 0),
            (0.14, 0.12),
            (0.2, 0.16),
            (0.18, 0.2),
            (0.14, 0.19),
            (0.12, 0.28),
            (0.02, 0.28),
            (0, 0.12),
        ),
    ),
    "sock": (
        "12x15cm",
        ((0, 0.1), (0.02, 0.02), (0.08, 0), (0.26, 0), (0.26, 0.1), (0.12, 0.12), (0.12, 0.4), (0, 0.4)),
    ),
    "dress": (
        "shelf",
        (
            (0, 0),
            (0.6, 0),
            (0.45, 0.45),
            (0.48, 0.8),
            (0.4, 0.8),
            (0.36, 0.72),
            (0.24, 0.72),
            (0.2, 0.8),
            (0.12, 0.8),
            (0.15, 0.45),
        ),
    ),
    "bib": (
        "12x15cm",
        ((0, 0), (0.24, 0), (0.24, 0.22), (0.18, 0.3), (0.15, 0.24), (0.09, 0.24), (0.06, 0.3), (0, 0.22)),
    ),
    "shorts": ("20x25cm", ((0, 0), (0.26, 0), (0.28, 0.14), (0.3, 0), (0.56, 0), (0.5, 0.42), (0.06, 0.42))),
    "leggings": ("20x25cm", ((0, 0), (0.1, 0), (0.16, 0.55), (0.22, 0), (0.32, 0), (0.3, 0.85), (0.02, 0.85))),
    "sweater": (
        "shelf",
        (
            (0.2, 0),
            (0.65, 0),
            (0.65, 0.38),
            (0.78, 0.02),
            (0.85, 0.05),
            (0.72, 0.6),
            (0.5, 0.65),
            (0.35, 0.65),
            (0.13, 0.6),
            (0, 0.05),
            (0.07, 0.02),
            (0.2, 0.38),
        ),
    ),
    "cape": ("shelf", ((0, 0.1), (0.2, 0), (0.6, 0), (0.8, 0.1), (0.5, 0.6), (0.3, 0.6))),
    "bathrobe": (
        "shelf",
        (
            (0.25, 0),
            (0.7, 0),
            (0.66, 0.45),
            (0.95, 0.4),
            (0.95, 0.6),
            (0.62, 0.78),
            (0.33, 0.78),
            (0, 0.6),
            (0, 0.4),
            (0.29, 0.45),
        ),
    ),
    "tea-towel": ("20x25cm", ((0, 0), (0.5, 0), (0.5, 0.7), (0, 0.7))),
    "stole": ("20x25cm", ((0, 0), (0.95, 0), (0.85, 0.3), (0.1, 0.3))),
    "tabard": ("shelf", ((0, 0), (0.5, 0), (0.5, 0.7), (0.35, 0.7), (0.25, 0.58), (0.15, 0.7), (0, 0.7))),
}
"""Outlines that are no garments of the paper's, each with the size to which it is folded (m)."""


@dataclass(frozen=True, slots=True)
class Measured:
    """The measurements of an outline.

    Attributes:
        outline: its name.
        to: the size to which it is folded.
        first_s: the CPU time to the first packet, no robot being asked (s); None if nothing fits.
        three_s: the CPU time to three ways (s); None if there are fewer.
        planned_s: for each robot the CPU time to the first and to the third proposal that it can do (s).
        own_s: the time that the garment's own folds take (s); None for an outline without folds.
        quickest_s: the time of the quickest proposal to the size of the garment's own packet (s).
    """

    outline: str
    to: str
    first_s: float | None
    three_s: float | None
    planned_s: Mapping[str, tuple[float | None, float | None]]
    own_s: float | None = None
    quickest_s: float | None = None


def fold_to_size(garments: Sequence[str], _repetitions: int) -> Report:
    """Measure proposals for the nine garments and, if all are asked for, for other outlines."""
    nine = [name for name in TABLE_2 if name in garments]
    others = OUTLINES if len(nine) == len(TABLE_2) else {}
    for robot in ROBOTS:
        compile_kernels(robot)
    measured = [*(_measured(load_garment(name), "shelf") for name in nine)]
    measured += [_measured(_garment(name, outline), to) for name, (to, outline) in others.items()]
    title = f"Proposals of at most {MAX_FOLDS} folds: CPU times"
    return Report("fold-to-size", title, COLUMNS, tuple(_row(one) for one in measured), 1)


def _garment(name: str, outline: Sequence[Point2]) -> Garment:
    garment = Garment.from_dict({"name": name, "outline": [list(point) for point in outline]})
    return replace(garment, placement=near_placement(garment, default_scene().table, YAW_RAD))


def _measured(garment: Garment, to: str) -> Measured:
    bare = replace(garment, folds=())
    first_s, three_s = _searched(bare, to)
    planned_s = {robot: _planned(bare, to, robot) for robot in ROBOTS}
    own_s, quickest_s = _own(garment) if garment.folds else (None, None)
    return Measured(garment.name, to, first_s, three_s, planned_s, own_s, quickest_s)


def _searched(bare: Garment, to: str) -> tuple[float | None, float | None]:
    """Return the CPU time to the first packet and to three ways (s), without a robot."""
    forget_garments()
    begun, ways = process_time(), dict[Way, float]()
    for packet in PacketSearch(bare, Target.of(to), MAX_FOLDS).packets():
        ways.setdefault(packet.way, process_time() - begun)
        if len(ways) == 3:
            break
    return _first_and_third([*ways.values()])


def _planned(bare: Garment, to: str, robot: str) -> tuple[float | None, float | None]:
    """Return the CPU time to the first and to the third proposal that a robot can do (s)."""
    _forget(robot)
    begun, times_s = process_time(), dict[int, float]()
    with closing(propose_folds(bare, to, robot=robot, count=3, max_folds=MAX_FOLDS)) as found:
        for proposal in found:
            if proposal.status == "solved":  # a better one may stand in for it later
                times_s.setdefault(proposal.number, process_time() - begun)
    return _first_and_third([*times_s.values()])


def _own(garment: Garment) -> tuple[float | None, float | None]:
    """Return the time of a garment's own folds, and of the quickest proposal to their size (s)."""
    x0, y0, x1, y1 = replayed(garment).final.silhouette.bounds
    found = propose_folds(replace(garment, folds=()), (x1 - x0, y1 - y0), count=3, max_folds=MAX_FOLDS)
    costs_s = [one.cost_s for one in found if one.cost_s is not None]
    return make_plan(garment).cost_s, min(costs_s, default=None)


def _forget(robot: str) -> None:
    forgetting: tuple[Callable[[], None], ...] = (forget_garments, forget_paths, load_robot(robot).forget_reach)
    for forget in forgetting:
        forget()


def _first_and_third(times_s: Sequence[float]) -> tuple[float | None, float | None]:
    return (times_s[0] if times_s else None, times_s[2] if len(times_s) > 2 else None)


def _row(one: Measured) -> Row:
    planned = [time_s for robot in ROBOTS for time_s in one.planned_s[robot]]
    times = (one.first_s, one.three_s, *planned, one.own_s, one.quickest_s)
    cells = (ABSENT if time_s is None else f"{time_s:.2f}" for time_s in times)
    return Row(((one.outline, one.to, *cells),), asdict(one))
