"""How much may hang: the pulls of two edges as vectors, and the largest share of a strip against the friction."""

import math

import numpy as np

from docs.figures.drawing import BACK, BLUE, EDGE, FAINT, FRONT, INK, NONE, RED, TABLE, Drawing, Style, View
from planner.cloth.cloth_state import ClothState
from planner.cloth.g_state import TableInGarment, stability_violation
from planner.geometry.pose import Point2, Pose2
from planner.geometry.region import Region
from planner.geometry.table import Table

_HERE = Pose2(0.0, 0.0, 0.0)
_TABLE = Table()
_TOP = TableInGarment.seen_from(_HERE, _TABLE)
_LENGTH_M = 1.0
_FRICTIONS = np.linspace(0.0, 4.0, 41)
_MARKED = (0.5, 1.0, 4.0)


def most_hanging(friction: float) -> float:
    """The largest share of a strip that may hang over one edge, found by asking the planner ever closer."""
    low, high = 0.0, 1.0
    for _ in range(18):
        share = (low + high) / 2
        is_at_rest = stability_violation(_strip(share), _TOP, friction, 0.0) is None
        low, high = (share, high) if is_at_rest else (low, share)
    return low


def _strip(share: float) -> ClothState:
    """A strip 0.2 m wide, so much of which hangs over the near edge, x = -0.8."""
    x = -_TABLE.depth_m / 2 - share * _LENGTH_M
    return ClothState.spread_out(_rectangle(x, -0.1, x + _LENGTH_M, 0.1))


def draw() -> Drawing:
    """From above, a cloth that hangs from two edges; beside it the limit for one edge."""
    sheet = Drawing(900, 420, "The friction law: pulls of hanging parts add up as vectors, and the most that may hang")
    _two_edges(sheet.view((215, 195), 270.0, (-0.55, 0.25)))
    _curve(sheet.view((500, 330), 1.0))
    return sheet


def _two_edges(view: View) -> None:
    """A bent strip of 0.2 m: 0.3 m of it hang from the near edge, 0.4 m from the left one."""
    x, y = -_TABLE.depth_m / 2, _TABLE.width_m / 2
    cloth = Region.union([_rectangle(x - 0.3, -0.1, -0.2, 0.1), _rectangle(-0.4, -0.1, -0.2, y + 0.4)])
    # Drawn as one stands before the near edge: the table's x goes up, its y to the left.
    seen = View(view.sheet, view.origin, view.scale, (-view.middle[1], view.middle[0]))
    table = _rectangle(x, -0.26, -0.08, y)
    seen.polygon("table", _turned(table), Style(NONE, TABLE))
    seen.polygon("cloth", _turned(cloth), Style(EDGE, FRONT))
    parts = cloth.difference(Region.polygon(_TABLE.corners)).pieces
    for part in parts:
        seen.polygon("hanging", _turned(part), Style(EDGE, BACK))
    seen.line("table-edge", [_turn(p) for p in ((x, -0.26), (x, y), (-0.08, y))], Style(INK, width=2.0))
    for part in parts:
        low_x, low_y, high_x, high_y = part.bounds
        middle = ((low_x + high_x) / 2, (low_y + high_y) / 2)
        is_near = low_x < x - 0.1
        pull = (-part.area, 0.0) if is_near else (0.0, part.area)
        _arrow(seen, middle, pull, FAINT, 2.5)
        words = f"{part.area:.2f} m²"
        shift = (34.0, 6.0) if is_near else (0.0, -36.0)
        seen.text(_turn(middle), words, shift=shift, anchor="start" if is_near else "middle")
    corner = (-0.3, 0.0)
    _arrow(
        seen,
        corner,
        (-sum(p.area for p in parts if p.bounds[0] < x - 0.1), sum(p.area for p in parts if p.bounds[3] > y + 0.1)),
        RED,
        3.0,
    )
    net = math.hypot(*(part.area for part in parts))
    lying = cloth.area - sum(part.area for part in parts)
    limit = _least_friction(ClothState.spread_out(cloth))
    view.sheet.text((215, 24), "From above: pulls add up as vectors", anchor="middle", bold=True)
    words = f"net pull {net:.2f} m², lying {lying:.3f} m²: it stays from μ = {limit:.3f} on"
    view.sheet.text((215, 400), words, anchor="middle")


def _least_friction(cloth: ClothState) -> float:
    """The least friction with which a cloth stays, found by asking the planner ever closer."""
    low, high = 0.0, 10.0
    for _ in range(24):
        friction = (low + high) / 2
        is_at_rest = stability_violation(cloth, _TOP, friction, 0.0) is None
        low, high = (low, friction) if is_at_rest else (friction, high)
    return high


def _arrow(view: View, start: Point2, pull: Point2, stroke: str, width: float) -> None:
    """A pull, 2 m long for each square metre of cloth that pulls."""
    end = (start[0] + 2.0 * pull[0], start[1] + 2.0 * pull[1])
    view.line("pull", (_turn(start), _turn(end)), Style(stroke, width=width), arrow=True)


def _curve(view: View) -> None:
    """Friction to the right, 80 px a unit; the share that may hang upwards, 250 px for all of it."""

    def at(friction: float, share: float) -> Point2:
        return (80.0 * friction, 250.0 * share)

    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        view.line("grid", (at(0.0, share), at(4.0, share)), Style(FAINT, width=0.4))
        view.text(at(0.0, share), f"{share:.0%}", shift=(-8, 4), anchor="end", size=12)
    for friction in range(5):
        view.text(at(friction, 0.0), f"{friction}", shift=(0, 18), anchor="middle", size=12)
    view.line("axis", (at(0.0, 1.0), at(0.0, 0.0), at(4.0, 0.0)), Style(INK, width=1.0))
    view.line("limit", [at(float(mu), most_hanging(float(mu))) for mu in _FRICTIONS], Style(BLUE, width=2.5))
    for mu in _MARKED:
        share = most_hanging(mu)
        view.dot("marked", at(mu, share), 4.5, Style(RED, RED))
        shift, anchor = ((-10, -8), "end") if mu == 4.0 else ((10, 16), "start")
        view.text(at(mu, share), f"μ = {mu:g}: {share:.0%}", shift=shift, anchor=anchor)
    view.text(at(2.0, 0.0), "friction coefficient μ", shift=(0, 38), anchor="middle")
    view.sheet.text((660, 24), "The most of a strip that may hang over one edge", anchor="middle", bold=True)


def _rectangle(x0: float, y0: float, x1: float, y1: float) -> Region:
    return Region.polygon([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def _turn(place: Point2) -> Point2:
    return (-place[1], place[0])


def _turned(region: Region) -> list[Point2]:
    return [_turn((float(x), float(y))) for x, y in region.ring]
