"""Writes a garment as SVG: lengths in cm, outline and folds as lines, to be read again without loss.

Arrows show the direction of a fold; the cloth to its left moves. The drawing's coordinates are the garment frame's in
centimetres, with y down.
"""

import json
import math
from collections.abc import Iterator, Sequence
from xml.sax.saxutils import escape, quoteattr

from app.drawing.curve import Ellipse
from app.drawing.drawing import Corner
from app.files.sketch_garment import KEPT_FIELDS
from app.files.svg_sketch import GRIP_RADIUS, KEPT
from app.fold_looks import FOLD_LOOKS
from planner.cloth.garment import DrawnFold, Garment
from planner.geometry.pose import Point2

CLOTH, EDGE = "#f0e6d2", "#5a5142"
_CM_PER_M = 100.0
_MARGIN_CM = 2.0
_STROKE_CM = 0.25


def svg_drawing(garment: Garment, corners: Sequence[Corner] = ()) -> str:
    """Return the garment, folds included, as an SVG document.

    Args:
        garment: the garment.
        corners: the corners it was drawn with, by which curves are written as arcs; none where it has only points.
    """
    points = [_cm(point) for point in garment.outline]
    ends = [_cm(end) for fold in garment.folds for end in (fold.start, fold.end)]
    is_curved = any(corner.curve is not None for corner in corners)
    outline = _arcs(corners) if is_curved else f"M {_joined(points)} Z"
    xs, ys = zip(*points, *ends, strict=True)
    x, y = min(xs) - _MARGIN_CM, min(ys) - _MARGIN_CM
    width, height = max(xs) + _MARGIN_CM - x, max(ys) + _MARGIN_CM - y
    whole = garment.to_dict()
    kept = json.dumps({name: whole[name] for name in KEPT_FIELDS})
    lines = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.6f}cm" height="{height:.6f}cm" '
        f'viewBox="{x:.6f} {y:.6f} {width:.6f} {height:.6f}" {KEPT}={quoteattr(kept)}>',
        f"<title>{_text(garment.title)}</title>",
        "<defs>",
        *(_arrow(kind) for kind in FOLD_LOOKS),
        "</defs>",
        f'<g fill="none" stroke-width="{_STROKE_CM}" stroke-linejoin="round">',
        f'<path id="outline" fill="{CLOTH}" stroke="{EDGE}" d="{outline}"/>',
        *_folds(garment.folds),
        "</g>",
        "</svg>",
    )
    return "\n".join(lines) + "\n"


def _arrow(kind: str) -> str:
    return (
        f'<marker id="{kind}-arrow" viewBox="0 0 6 6" refX="5.5" refY="3" markerWidth="6" markerHeight="6" '
        f'orient="auto"><path d="M 0 0 L 6 3 L 0 6 Z" fill="#{FOLD_LOOKS[kind].light}"/></marker>'
    )


def _folds(folds: tuple[DrawnFold, ...]) -> Iterator[str]:
    for number, fold in enumerate(folds):
        line, look = _joined([_cm(fold.start), _cm(fold.end)]), FOLD_LOOKS[fold.kind]
        dashes = f' stroke-dasharray="{" ".join(map(str, look.dashes_cm))}"' if look.dashes_cm else ""
        yield (
            f'<path id="fold-{number}" stroke="#{look.light}"{dashes} '
            f'marker-end="url(#{fold.kind}-arrow)" {GRIP_RADIUS}="{fold.grip_radius_m!r}" d="M {line}">'
            f"<title>{_text(fold.name)}</title></path>"
        )


def _arcs(corners: Sequence[Corner]) -> str:
    """Return the path of an outline, each edge a line or an elliptical arc."""
    return " ".join(("M {:.6f} {:.6f}".format(*_cm(corners[0].point)), *_edges(corners), "Z"))


def _edges(corners: Sequence[Corner]) -> Iterator[str]:
    for corner, following in zip(corners, (*corners[1:], corners[0]), strict=True):
        x, y = _cm(following.point)
        if corner.curve is None:
            yield f"L {x:.6f} {y:.6f}"
            continue
        ellipse = Ellipse.of(corner.curve, corner.point, following.point)
        major, minor = (_CM_PER_M * radius for radius in ellipse.radii_m)
        is_large, is_left = 2 * ellipse.half_angle_rad > math.pi, corner.curve.across > 0.0
        # A point that is left of the chord is passed clockwise; the drawing's y is down, as SVG's flags see it.
        turn_deg = -math.degrees(ellipse.turn_rad)
        yield f"A {major:.6f} {minor:.6f} {turn_deg:.6f} {is_large:d} {is_left:d} {x:.6f} {y:.6f}"


def _cm(point: Point2) -> Point2:
    return (point[0] * _CM_PER_M, -point[1] * _CM_PER_M)


def _joined(points: list[Point2]) -> str:
    return " L ".join(f"{x:.6f} {y:.6f}" for x, y in points)


def _text(title: str) -> str:
    """Return a title escaped for XML, with unprintable characters replaced."""
    return escape("".join(char if char.isprintable() else " " for char in title))
