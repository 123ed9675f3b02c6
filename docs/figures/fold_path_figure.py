"""How a grip moves in a fold, seen from the side: over the table, and beginning beside its edge."""

import numpy as np

from docs.figures.drawing import BLUE, EDGE, FAINT, INK, NONE, RED, TABLE, Drawing, Style, View
from planner.folds.fold_path import FoldPath
from planner.geometry.pose import Point2
from planner.geometry.segment import Segment
from planner.geometry.table import Table, TableTop
from planner.task.scene import Scene

_DEPTH_M, _GRIP_M = 0.40, 0.30
_HANGING_M, _LINE_M = 0.15, 0.10
_SCALE = 430.0
_CLOTH = Style(EDGE, width=4.0)
_MOVING = Style("#7f97b5", width=4.0)


def draw() -> Drawing:
    """A grip at 3/4 of the moving part's depth; and one that hangs 0.15 m beside the edge."""
    sheet = Drawing(900, 350, "The path of a grip in a fold, from the side: over the table, and from beside its edge")
    _over_the_table(sheet.view((255, 262), _SCALE))
    _beside_the_edge(sheet.view((650, 222), _SCALE))
    return sheet


def _over_the_table(view: View) -> None:
    top = TableTop.of(Table())
    path = FoldPath(Segment((0.0, 0.2), (0.0, -0.2)), _DEPTH_M, top, top)
    view.polygon("table", ((-0.52, 0), (0.52, 0), (0.52, -0.04), (-0.52, -0.04)), Style(NONE, TABLE))
    # The sweep at which the baseline is at half the depth.
    shown = 0.5
    baseline = _DEPTH_M * (1.0 - shown)
    view.line("cloth", ((-0.5, 0.0), (baseline, 0.0)), _CLOTH)
    view.line("moving", ((0.0, 0.0), (baseline, 0.0), (baseline, _DEPTH_M - baseline)), _MOVING)
    _way(view, path, (_GRIP_M, 0.0), 1.0)
    _tool(view, path, (_GRIP_M, 0.0), shown)
    view.line("fold-line", ((0.0, 0.0), (0.0, 0.44)), Style(BLUE, width=1.5, dash="5 4"))
    view.text((0.0, 0.44), "over the fold line", shift=(0, -8), anchor="middle", fill=BLUE)
    view.text((baseline, 0.0), "b", shift=(0, 20), anchor="middle")
    view.line("baseline", ((baseline, -0.02), (baseline, 0.005)), Style(INK))
    _measure(view, 0.0, _GRIP_M, -0.085, "d")
    _measure(view, 0.0, _DEPTH_M, -0.14, "D")
    view.text((0.0, _GRIP_M), "apex (0, d)", shift=(12, -14))
    view.text((0.235, 0.13), "(b, d - b)", shift=(2, 0))
    view.text((-0.23, 0.13), "(-b, d - b)", shift=(-4, 0), anchor="end")
    view.sheet.text((255, 24), "Over the table", anchor="middle", bold=True)


def _beside_the_edge(view: View) -> None:
    """The edge is at 0; the grip hangs beside it, the line lies inside. What moves comes from the right."""
    table = Table(depth_m=2.0)
    top = TableTop.of(table)
    at_edge = table.depth_m / 2
    line = Segment((at_edge - _LINE_M, 0.2), (at_edge - _LINE_M, -0.2))
    path = FoldPath(line, _LINE_M + _HANGING_M, top, top, Scene().edge_clear_m)
    seen = View(view.sheet, view.origin, view.scale, (at_edge, 0.0))
    seen.polygon(
        "table", [(at_edge + x, z) for x, z in ((-0.5, 0), (0, 0), (0, -0.04), (-0.5, -0.04))], Style(NONE, TABLE)
    )
    seen.line("cloth", ((at_edge - 0.48, 0.0), (at_edge, 0.0)), _CLOTH)
    hanging = ((line.start[0], 0.0), (at_edge, 0.0), (at_edge, -_HANGING_M))
    seen.line("moving", hanging, _MOVING)
    grip = (at_edge + _HANGING_M, 0.0)
    _way(seen, path, grip, 1.0)
    _tool(seen, path, grip, 0.0)
    foot = line.start[0]
    seen.line("fold-line", ((foot, 0.0), (foot, 0.36)), Style(BLUE, width=1.5, dash="5 4"))
    seen.text((foot, 0.36), "over the fold line", shift=(0, -8), anchor="middle", fill=BLUE)
    seen.line("depth", ((at_edge + 0.05, 0.0), (at_edge + 0.05, -_HANGING_M)), Style(FAINT, width=1.0), arrow=True)
    seen.text((at_edge + 0.05, -_HANGING_M / 2), "h", shift=(8, 5))
    seen.text((at_edge, _HANGING_M), "up beside the edge, from -h to h", shift=(12, 6))
    seen.sheet.text((700, 24), "From beside the edge", anchor="middle", bold=True)


def _way(view: View, path: FoldPath, grip: Point2, start: float) -> None:
    """A tool's path, and the waypoints at which the planner asks whether an arm reaches it."""
    points = np.array([grip])
    dense = path.tool_paths(points, np.linspace(0.0, 2.0, 161))[0]
    view.line("path", [(float(x), float(z)) for x, _, z in dense], Style(RED, width=2.0))
    for x, _, z in path.tool_paths(points, path.sweeps(points))[0]:
        view.dot("waypoint", (float(x), float(z)), 3.0, Style(RED, "#ffffff", 1.5))


def _tool(view: View, path: FoldPath, grip: Point2, sweep: float) -> None:
    x, _, z = path.tool_points(np.array([grip]), sweep)[0]
    view.dot("grip", (float(x), float(z)), 6.0, Style(INK, INK))


def _measure(view: View, start: float, end: float, z: float, name: str) -> None:
    view.line("measure", ((start, z), (end, z)), Style(FAINT, width=1.0), arrow=True)
    view.text(((start + end) / 2, z), name, shift=(0, -5), anchor="middle")
