"""Which vertices must be held: in a fold, and where cloth hangs from the table (Theorem 1)."""

import math

import numpy as np

from docs.figures.drawing import BACK, BLUE, EDGE, FAINT, FRONT, INK, NONE, RED, TABLE, Drawing, Style, View
from planner.cloth.garment_files import load_garment
from planner.cloth.must_hold import must_hold
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.task.scene import Scene

_SCALE = 330.0
_SUPPORT_RAD = Scene().support_angle_rad
_CLOTH = Style(EDGE, FRONT)
_PART = Style(EDGE, BACK)
_DOT_PX = 5.0


def draw() -> Drawing:
    """The T-shirt's left sleeve in its fold; its bottom over the table's edge; its shoulders over the edge."""
    sheet = Drawing(
        900, 400, "Vertices that must be held: a T-shirt's sleeve in its fold, its bottom and its shoulders hanging"
    )
    _fold(sheet.view((168, 205), _SCALE, (0.2285, 0.305)))
    sheet.text((168, 345), "Folding a sleeve: up is away from the line.", anchor="middle")
    sheet.text((168, 363), "One grip holds both vertices.", anchor="middle")
    body = load_garment("t-shirt").pattern
    _hanging(sheet.view((455, 155), _SCALE, (0.2285, 0.25)), body, 0.25)
    sheet.text((455, 345), "The bottom hangs: every lower corner", anchor="middle")
    sheet.text((455, 363), "has cloth straight above it. It stays.", anchor="middle")
    upside_down = body.moved(Isometry.rotation(math.pi, 0.457, 0.61))
    _hanging(sheet.view((735, 155), _SCALE, (0.2285, 0.26)), upside_down, 0.26)
    sheet.text((735, 345), "The shoulders hang: nothing is above", anchor="middle")
    sheet.text((735, 363), "the sleeves' corners. It does not stay.", anchor="middle")
    _legend(sheet)
    return sheet


def _fold(view: View) -> None:
    sequence = FoldSequence.of(load_garment("t-shirt"))
    fold, moving = sequence.folds[0], sequence.folded(0, 0).moving
    covers = sequence.covers(0, _SUPPORT_RAD, 2)
    view.polygon("cloth", sequence.cloth(0).silhouette.ring, _CLOTH)
    view.polygon("part", moving.ring, _PART)
    for grip in covers.covers[0]:
        view.circle("grip-radius", grip, fold.grip_radius_m, Style(INK, INK, 1.0, "4 3", 0.06))
        view.dot("grip", grip, 4.5, Style(INK, INK))
    view.line("fold-line", (fold.line.start, fold.line.end), Style(BLUE, width=3.0))
    _vertices(view, moving, np.array(covers.vertices), fold.line.left, (fold.line,))
    middle = fold.line.at(fold.line.length / 2)
    _up(view, (middle[0] + 0.13, middle[1]), fold.line.left)


def _hanging(view: View, cloth: Region, edge_y: float) -> None:
    """Cloth over a table's edge, unrolled: what is below the edge hangs."""
    edge = Segment((-0.2, edge_y), (0.66, edge_y))
    hanging = cloth.parted_by(edge)[1]
    top = ((-0.16, edge_y), (0.617, edge_y), (0.617, edge_y + 0.4), (-0.16, edge_y + 0.4))
    view.polygon("table", top, Style(NONE, TABLE))
    view.polygon("cloth", cloth.ring, _CLOTH)
    view.polygon("part", hanging.ring, _PART)
    view.line("table-edge", ((-0.16, edge_y), (0.617, edge_y)), Style(INK, width=2.0))
    loose = must_hold(hanging, (0.0, 1.0), (edge,), _SUPPORT_RAD)
    _vertices(view, hanging, loose, (0.0, 1.0), (edge,))
    _up(view, (0.2285, edge_y - 0.15), (0.0, 1.0))


def _up(view: View, start: Point2, up: Point2) -> None:
    end = (start[0] + 0.09 * up[0], start[1] + 0.09 * up[1])
    view.line("up", (start, end), Style(INK, width=2.0), arrow=True)
    view.text(start, "up", shift=(6.0, 14.0))


def _vertices(view: View, piece: Region, held: FloatArray, up: Point2, baseline: tuple[Segment, ...]) -> None:
    """Every vertex of a piece by what holds it."""
    for vertex in piece.ring:
        place = (float(vertex[0]), float(vertex[1]))
        if len(held) and np.hypot(*(held - vertex).T).min() < 1e-6:
            view.dot("must-hold", place, _DOT_PX + 1, Style(RED, RED))
        elif min(float(line.distances(vertex[None])[0]) for line in baseline) < 1e-5:
            view.dot("on-baseline", place, _DOT_PX - 1, Style(INK, FAINT))
        elif np.abs(piece.hull - vertex).max(axis=1).min() < 1e-5:
            _arrow_up(view, place, up)
            view.dot("supported", place, _DOT_PX, Style(BLUE, FRONT, 2.0))
        else:
            view.dot("not-on-hull", place, _DOT_PX - 2, Style(FAINT, FRONT, 1.0))


def _arrow_up(view: View, place: Point2, up: Point2) -> None:
    end = (place[0] + 0.06 * up[0], place[1] + 0.06 * up[1])
    view.line("into-cloth", (place, end), Style(BLUE, width=1.5), arrow=True)


def _legend(sheet: Drawing) -> None:
    view = sheet.view((0, 388), 1.0)
    kinds = (
        (30, "legend", Style(RED, RED), "must be held"),
        (150, "legend", Style(BLUE, FRONT, 2.0), "cloth above: need not be"),
        (352, "legend", Style(INK, FAINT), "on the baseline: held already"),
        (584, "legend", Style(FAINT, FRONT, 1.0), "not on the hull"),
        (722, "legend", Style(INK, INK), "grip and its radius"),
    )
    for x, kind, style, words in kinds:
        view.dot(kind, (x, 4), _DOT_PX, style)
        sheet.text((x + 12, 388), words, size=12.5)
