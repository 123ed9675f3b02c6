"""The cloth in space at one moment: every layer cut where it bends, each flat piece a few triangles.

Cloth bends along the baseline of a fold in progress and along the table's edges. So each layer is cut by the
baseline: what has not been lifted yet and what is laid down already lie flat, what is between stands. Flat parts
are cut by the table's edges, beyond which they hang. Layers are drawn a little apart, as if each were one thickness
of cloth, and standing cloth a little longer than it is, up to the tool frame that holds it.
"""

from dataclasses import dataclass, field

import numpy as np

from planner.cloth.layer import Layer
from planner.folds.fold_path import REST_HEIGHT_M, FoldPath
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.table_top import TableTop
from planner.plan.frame import ClothSurface
from planner.primitives.phase import ClothMotion
from planner.primitives.work import Work

LAYER_GAP_M = 0.0015
"""How far apart neighbouring layers are drawn (m)."""


@dataclass(slots=True)
class _Mesh:
    """Triangles gathered so far."""

    corners: list[FloatArray] = field(default_factory=list)
    layers: list[int] = field(default_factory=list)

    def add(self, triangles: FloatArray, layer: int, *, is_back: bool) -> None:
        """Add triangles, shape (n, 3, 3); those of a layer that shows its back are turned over."""
        self.corners.append(triangles[:, ::-1] if is_back else triangles)
        self.layers.extend([layer] * len(triangles))

    def surface(self) -> ClothSurface:
        vertices = np.concatenate(self.corners).reshape(-1, 3)
        triangles = np.arange(len(vertices), dtype=np.int64).reshape(-1, 3)
        return ClothSurface(vertices, triangles, np.array(self.layers, dtype=np.int64))


@dataclass(frozen=True, slots=True)
class _Laying:
    """Puts flat regions of the article frame onto the table and over its edges."""

    mesh: _Mesh
    placement: Pose2
    top: TableTop
    droop: float

    def lay(self, region: Region, number: int, *, is_back: bool) -> None:
        """Add a flat region as layer `number`."""
        for piece in self._cut_at_edges(region):
            flat = self.placement.to_outer(piece.triangles)
            unrolled = np.concatenate([flat, np.zeros((*flat.shape[:2], 1))], axis=2)
            self.mesh.add(self.top.over_edge(unrolled, _gap(number), self.droop), number, is_back=is_back)

    def _cut_at_edges(self, region: Region) -> tuple[Region, ...]:
        if not np.any(self.top.beyond(self.placement.to_outer(region.coordinates)) > 0.0):
            return (region,)
        pieces: tuple[Region, ...] = (region,)
        for edge in self.top.edges:
            ends = self.placement.to_inner(np.array([edge.start, edge.end]))
            here = _segment(ends)
            pieces = tuple(part for p in pieces for s in (here, here.reversed) for part in p.left_of(s).pieces)
        return pieces


class ClothSurfaces:
    """The cloth of one planning problem, at any moment of any phase."""

    def __init__(self, work: Work) -> None:
        self._work = work

    def at(self, motion: ClothMotion, fraction: float, droop: float = 1.0) -> ClothSurface:
        """The cloth a fraction of the way through a phase's motion; `droop` as in `TableTop.over_edge`."""
        laying = _Laying(_Mesh(), motion.start.between(motion.end, fraction), motion.top, droop)
        first, last = motion.sweep
        sweep = first + fraction * (last - first)
        if motion.fold is None or sweep <= 0.0:
            for number, layer in enumerate(self._work.sequence.cloth(motion.done).layers):
                laying.lay(layer.region, number, is_back=layer.face == "back")
        else:
            self._fold(laying, motion.done, motion.fold, sweep)
        return laying.mesh.surface()

    def _fold(self, laying: _Laying, done: int, fold: int, sweep: float) -> None:
        folded = self._work.sequence.folded(done, fold)
        line = self._work.sequence.folds[fold].line
        staying = len(folded.cloth.layers) - folded.cloth.moved
        for number, layer in enumerate(folded.cloth.layers[:staying]):
            laying.lay(layer.region, number, is_back=layer.face == "back")
        depth = float(line.left_distances(folded.moving.coordinates).max())
        path = FoldPath(_placed(line, laying.placement), depth, laying.top, laying.top)
        for number, layer in enumerate(folded.layers):
            above = number if sweep <= 1.0 else len(folded.layers) - 1 - number
            _bend(laying, layer, staying + above, line, path, sweep)


def _bend(laying: _Laying, layer: Layer, number: int, line: Segment, path: FoldPath, sweep: float) -> None:
    """Add a layer of the moving part: flat up to the baseline or laid down already, standing beyond it."""
    offset = path.depth_m * abs(1.0 - sweep)
    baseline = Segment(_shifted(line, line.start, offset), _shifted(line, line.end, offset))
    is_back = layer.face == "back"
    for part in layer.region.left_of(baseline.reversed).pieces:
        if sweep <= 1.0:
            laying.lay(part, number, is_back=is_back)
        else:
            laying.lay(part.moved(Isometry.reflection(line)), number, is_back=not is_back)
    lean = np.array([*path.line.left, 0.0]) * _gap(number)
    for part in layer.region.left_of(baseline).pieces:
        flat = laying.placement.to_outer(part.triangles).reshape(-1, 2)
        swept = path.swept(flat, sweep)
        swept[:, 2] += np.minimum(swept[:, 2], REST_HEIGHT_M)
        standing = laying.top.over_edge(swept) - lean
        laying.mesh.add(standing.reshape(-1, 3, 3), number, is_back=is_back)


def _gap(number: int) -> float:
    return (number + 1) * LAYER_GAP_M


def _segment(ends: FloatArray) -> Segment:
    return Segment((float(ends[0][0]), float(ends[0][1])), (float(ends[1][0]), float(ends[1][1])))


def _placed(line: Segment, placement: Pose2) -> Segment:
    return _segment(placement.to_outer(np.array([line.start, line.end])))


def _shifted(line: Segment, point: tuple[float, float], distance: float) -> tuple[float, float]:
    nx, ny = line.left
    return (point[0] + distance * nx, point[1] + distance * ny)
