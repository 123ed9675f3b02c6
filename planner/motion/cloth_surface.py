"""The cloth in space at one moment: every layer cut where it bends, and each flat piece triangulated.

Cloth bends near the baseline of a fold in progress and along the table's edges. So each layer is cut where it leaves
the table: cloth not lifted yet or already laid down lies flat, the rest stands (`LiftedCloth`). Flat parts are cut by
the table's edges, beyond which they hang. Layers are drawn as high above each other as they lie in a stack
(`Garment.layer_m`). Standing cloth keeps its lengths, so it ends between the fingertips, below the tool frame.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.cloth.garment import Garment
from planner.cloth.layer import Layer, nearest_layers
from planner.cloth.must_hold import must_hold
from planner.folds.fold_path import FoldPath
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.drape import bends, draped
from planner.geometry.isometry import Isometry
from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.geometry.segment import Segment
from planner.geometry.table import Table, TableTop
from planner.geometry.triangles import creased, parted
from planner.motion.lifted_cloth import LiftedCloth
from planner.task.trajectory import ClothMotion


@dataclass(frozen=True, slots=True, eq=False)
class ClothSurface:
    """The cloth as a triangle mesh in the table frame.

    Attributes:
        vertices: shape (n, 3), m; the layers of a stack lie a little apart.
        triangles: shape (m, 3), indices into `vertices`; seen from the front face of the cloth they run
            counter-clockwise.
        layers: shape (m,), each triangle's layer, 0 at the bottom.
        unrolled: for cloth on the table or hanging over its edges, each vertex's position in the unrolled plane and its
            layer's height above it, shape (n, 3), m; nan for all other cloth.
        pattern: each vertex's position in the pattern, shape (n, 2), m: the same on both sides of a crease.
    """

    vertices: FloatArray
    triangles: NDArray[np.int64]
    layers: NDArray[np.int64]
    unrolled: FloatArray
    pattern: FloatArray


class ClothMoment(NamedTuple):
    """What the shape of the cloth depends on at one time.

    Attributes:
        done: the folds done, as a bit mask.
        fold: the fold in progress; None if no cloth is lifted.
        sweep: its sweep, from 0 to 2 (`FoldPath.swept`).
        placement: the garment frame in the table frame.
        top: the table top over which cloth does not hang.
        droop: how far cloth beyond its edges has turned down: 0 level, 1 hanging.
    """

    done: int
    fold: int | None
    sweep: float
    placement: Pose2
    top: TableTop
    droop: float

    @staticmethod
    def of(motion: ClothMotion, fraction: float, droop: float) -> "ClothMoment":
        """Return the moment a fraction of the way through a phase's motion."""
        first, last = motion.sweep
        sweep = 0.0 if motion.fold is None else max(first + fraction * (last - first), 0.0)
        fold = motion.fold if sweep > 0.0 else None
        return ClothMoment(motion.done, fold, sweep, motion.start.between(motion.end, fraction), motion.top, droop)


@dataclass(frozen=True, slots=True)
class _Pieces:
    """Flat cloth.

    Attributes:
        triangles: garment frame, counter-clockwise, shape (n, 3, 2), m.
        numbers: the layer of each, shape (n,).
        is_back: whether it shows its back, shape (n,).
        to_pattern: the map of each to the pattern, shape (n, 2, 3): a matrix and what is added (m).
    """

    triangles: FloatArray
    numbers: NDArray[np.int64]
    is_back: BoolArray
    to_pattern: FloatArray

    @staticmethod
    def of(layers: Sequence[Layer], numbers: Sequence[int]) -> "_Pieces":
        """Return the triangles of layers with given numbers."""
        meshes = [layer.region.triangles for layer in layers]
        counts = [len(mesh) for mesh in meshes]
        is_back = np.repeat(np.array([layer.face == "back" for layer in layers], dtype=np.bool_), counts)
        triangles = np.concatenate([np.empty((0, 3, 2)), *meshes])
        maps = np.array([layer.isometry.inverse.matrix for layer in layers]).reshape(-1, 2, 3)
        numbered = np.repeat(np.array(numbers, dtype=np.int64), counts)
        return _Pieces(triangles, numbered, is_back, np.repeat(maps, counts, axis=0))

    def parts(self, triangles: FloatArray, sources: NDArray[np.int64]) -> "_Pieces":
        """Return triangles cut from these; `sources` are the indices of the originals."""
        return _Pieces(triangles, self.numbers[sources], self.is_back[sources], self.to_pattern[sources])

    def parted(self, line: Segment) -> tuple["_Pieces", "_Pieces"]:
        """Return the parts to the left and to the right of the infinite line through a segment."""
        left, right = parted(self.triangles, line)
        return self.parts(*left), self.parts(*right)

    def turned(self, line: Segment) -> "_Pieces":
        """Return the pieces turned over a line; each keeps its number."""
        over = Isometry.reflection(line)
        to_pattern = self.to_pattern[..., :2] @ over.matrix
        to_pattern[..., 2] += self.to_pattern[..., 2]
        return _Pieces(over.apply(self.triangles)[:, ::-1], self.numbers, ~self.is_back, to_pattern)

    @property
    def pattern(self) -> FloatArray:
        """The corners in the pattern, shape (n, 3, 2), m."""
        turned = self.triangles @ self.to_pattern[..., :2].transpose(0, 2, 1)
        return np.asarray(turned + self.to_pattern[:, None, :, 2])


@dataclass(slots=True)
class _Mesh:
    """A growing mesh of cloth at one placement: flat on the table, over its edges, or standing.

    Attributes:
        placement: the garment frame in the table frame.
        top: the table top over which cloth does not hang.
        droop: how far cloth beyond its edges has turned down.
        layer_m: the height of a layer (m).
    """

    placement: Pose2
    top: TableTop
    droop: float
    layer_m: float
    corners: list[FloatArray] = field(default_factory=list)
    unrolled: list[FloatArray] = field(default_factory=list)
    pattern: list[FloatArray] = field(default_factory=list)
    layers: list[NDArray[np.int64]] = field(default_factory=list)

    def lay(self, pieces: _Pieces) -> None:
        """Add cloth that lies on the table or hangs over its edges."""
        flat, gaps = self.placement.to_outer(pieces.triangles), self._gaps(pieces)
        if not self.top.covers(flat):
            flat, sources = creased(flat, bends(self.top, flat, float(gaps.max(initial=0.0))))
            pieces, gaps = pieces.parts(flat, sources), gaps[sources]
        unrolled = np.concatenate([flat, np.zeros((*flat.shape[:2], 1))], axis=2)
        rolled = np.concatenate([flat, np.broadcast_to(gaps[..., None], (*flat.shape[:2], 1))], axis=2)
        if self.droop < 1.0:
            rolled[self.top.beyond(flat) > 0.0] = np.nan
        self._add(pieces, draped(self.top, unrolled, gaps, self.droop), rolled)

    def erect(self, pieces: _Pieces, path: FoldPath, sweep: float, shape: LiftedCloth) -> None:
        """Add cloth that a fold has lifted."""
        points = self.placement.to_outer(pieces.triangles).reshape(-1, 2)
        places, distances = path.line.positions(points), path.line.left_distances(points)
        moved = shape.offsets(places, distances, np.repeat(self._gaps(pieces), 3))
        standing = draped(self.top, path.swept(points, sweep))
        standing[:, :2] += moved[:, :1] * np.array(path.line.left)
        standing[:, 2] += moved[:, 1]
        self._add(pieces, standing.reshape(-1, 3, 3), np.full((len(pieces.triangles), 3, 3), np.nan))

    def _gaps(self, pieces: _Pieces) -> FloatArray:
        """Return the height above the table at which each piece is drawn (m), shape (n, 1)."""
        return np.asarray((pieces.numbers[:, None] + 1) * self.layer_m)

    def _add(self, pieces: _Pieces, corners: FloatArray, unrolled: FloatArray) -> None:
        """Add triangles, shape (n, 3, 3), and their unrolled positions; turn over those that show their backs."""
        for kept, points in ((self.corners, corners), (self.unrolled, unrolled), (self.pattern, pieces.pattern)):
            kept.append(np.where(pieces.is_back[:, None, None], points[:, ::-1], points))
        self.layers.append(pieces.numbers)

    def surface(self) -> ClothSurface:
        vertices = np.concatenate(self.corners).reshape(-1, 3)
        triangles = np.arange(len(vertices), dtype=np.int64).reshape(-1, 3)
        unrolled, pattern = np.concatenate(self.unrolled).reshape(-1, 3), np.concatenate(self.pattern).reshape(-1, 2)
        return ClothSurface(vertices, triangles, np.concatenate(self.layers), unrolled, pattern)


class ClothSurfaces:
    """The cloth of one task, at any moment of any phase."""

    def __init__(self, sequence: FoldSequence) -> None:
        self._sequence = sequence
        self._last: tuple[ClothMoment, ClothSurface] | None = None
        self._holds: dict[int, FloatArray] = {}

    def at(self, moment: ClothMoment) -> ClothSurface:
        """Return the cloth at a moment; while no part of it moves, the result is the same object."""
        known = self._last
        if known is None or known[0] != moment:
            self._last = known = (moment, self._surface(moment))
        return known[1]

    def _surface(self, moment: ClothMoment) -> ClothSurface:
        done, fold = moment.done, moment.fold
        mesh = _Mesh(moment.placement, moment.top, moment.droop, self._sequence.garment.layer_m)
        if fold is None:
            layers = self._sequence.cloth(done).layers
            mesh.lay(_Pieces.of(layers, range(len(layers))))
        else:
            self._fold(mesh, done, fold, moment.sweep)
        return mesh.surface()

    def _fold(self, mesh: _Mesh, done: int, fold: int, sweep: float) -> None:
        folded = self._sequence.folded(done, fold)
        line = self._sequence.folds[fold].line
        staying = len(folded.cloth.layers) - folded.cloth.moved
        numbers = range(staying, len(folded.cloth.layers))
        is_falling = sweep > 1.0
        moving = _Pieces.of(folded.layers, numbers[::-1] if is_falling else numbers)
        depth = float(line.left_distances(folded.moving.coordinates).max())
        path = FoldPath(placed(line, mesh.placement), depth, mesh.top, mesh.top)
        held = self._held(fold)
        stands = path.swept(mesh.placement.to_outer(folded.moving.coordinates), sweep)
        room_m = mesh.top.room_m(stands[stands[:, 2] > 0.0])
        lifted = LiftedCloth.of(line, depth, sweep, held, room_m)
        standing, lying = moving.parted(line.beside(lifted.leaves_at_m))
        mesh.lay(_Pieces.of(folded.cloth.layers[:staying], range(staying)))
        mesh.lay(lying.turned(line) if is_falling else lying)
        standing = standing.parts(*lifted.cut(standing.triangles, line))
        mesh.erect(standing, path, sweep, lifted)

    def _held(self, fold: int) -> FloatArray:
        """Return the points that are held during a fold, shape (n, 2), garment frame (m)."""
        if fold not in self._holds:
            line = self._sequence.folds[fold].line
            self._holds[fold] = must_hold(self._sequence.moving(fold), line.left, (line,), 0.0)
        return self._holds[fold]


def placed(line: Segment, placement: Pose2) -> Segment:
    """Return a segment of the garment frame in the table frame."""
    start, end = placement.to_outer(np.array([line.start, line.end])).tolist()
    return Segment(tuple(start), tuple(end))


class ClothPoints:
    """Points of a garment's pattern, at any moment of a plan."""

    def __init__(self, sequence: FoldSequence, pattern: FloatArray) -> None:
        """Take points of the pattern, shape (n, 2), m."""
        self._sequence, self._pattern = sequence, pattern
        self._numbers: dict[tuple[int, int | None], NDArray[np.int64]] = {}

    def at(self, moment: ClothMoment) -> FloatArray:
        """Return where the points are, table frame, shape (n, 3), m; they lie in their layers as the surface does."""
        done, fold, sweep, placement, top, droop = moment
        layers: Sequence[Layer] = self._sequence.cloth(done).layers
        staying = len(layers)
        if fold is not None:
            folded = self._sequence.folded(done, fold)
            staying = len(folded.cloth.layers) - folded.cloth.moved
            layers = [*folded.cloth.layers[:staying], *folded.layers]
        if (numbers := self._numbers.get((done, fold))) is None:
            numbers = self._numbers[done, fold] = nearest_layers(layers, self._pattern)
        lying = np.empty_like(self._pattern)
        for number, layer in enumerate(layers):
            lying[numbers == number] = layer.isometry.apply(self._pattern[numbers == number])
        unrolled = np.column_stack([placement.to_outer(lying), np.zeros(len(lying))])
        heights = np.arange(len(layers))
        if fold is not None:
            line, moves = self._sequence.folds[fold].line, numbers >= staying
            path = FoldPath(
                placed(line, placement), float(line.left_distances(folded.moving.coordinates).max()), top, top
            )
            unrolled[moves] = path.swept(unrolled[moves, :2], sweep)
            heights[staying:] = heights[staying:][:: -1 if sweep > 1.0 else 1]
        return draped(
            top, unrolled, np.asarray((heights[numbers] + 1) * self._sequence.garment.layer_m, dtype=np.float64), droop
        )


@dataclass(frozen=True, slots=True)
class ClothAlone:
    """A garment that is folded where it lies, each fold in the same time.

    Attributes:
        sequence: the garment and its folds.
        table: the table over whose edges it hangs.
    """

    sequence: FoldSequence
    table: Table
    _surfaces: ClothSurfaces

    @staticmethod
    def of(sequence: FoldSequence, table: Table) -> "ClothAlone":
        """Return a garment at its placement on a table."""
        return ClothAlone(sequence, table, ClothSurfaces(sequence))

    def at(self, share: float) -> tuple[ClothSurface, frozenset[int]]:
        """Return the cloth after a share of all folds, 0 to 1, and the folds that are done by then."""
        count = len(self.sequence.folds)
        done = min(int(share * count), count)
        placement = self.sequence.garment.placement
        fold = done if done < count else None
        motion = ClothMotion((1 << done) - 1, placement, placement, TableTop.of(self.table), fold, (0.0, 2.0))
        moment = ClothMoment.of(motion, share * count - done, 1.0)
        return self._surfaces.at(moment), frozenset(range(done))


def spread_cloth(garment: Garment, table: Table) -> ClothSurface:
    """Return a garment at its placement before any fold, hanging where it extends beyond the table."""
    return ClothAlone.of(FoldSequence.of(replace(garment, folds=())), table).at(0.0)[0]
