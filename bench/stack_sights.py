"""The error of landmarks of folded stacks in rendered pictures, as a robot looks at them between two steps.

Shipped and random garments, folded as planned but for a last crease beside its line, lie near to where
they ought to be; light, noise and wrinkles are by chance, tables and cloths too if wanted. Landmarks are the points of
the stack that the next folds would have to hold, or the corners of its hull where it has no more folds.
"""

import math
from dataclasses import dataclass, replace
from time import process_time

import numpy as np

from app.rehearsal.camera.camera import Camera
from app.rehearsal.camera.look import PLAIN, Look, random_look
from app.rehearsal.camera.mounted import hung, overhead
from app.rehearsal.camera.picture import ClothSeen, picture
from app.rehearsal.camera.robot_shape import hidden
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.vision.look_at_stack import Looker
from app.templates.catalogue import TEMPLATES
from planner import Scene, load_garment
from planner.cloth.garment import Garment
from planner.cloth.must_hold import must_hold
from planner.errors import FieldError
from planner.folds.fold_sequence import FoldSequence, replayed
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.geometry.woven_mesh import woven_mesh

NEAR_M = 0.01
MEASURES = (0.8, 1.2)
"""Random measures, as shares of the templates' own."""

SHIFT_M, TURN_RAD, CREASE_M = 0.02, 0.06, 0.006
"""Standard deviations of where a stack lies and of its last crease beside its line."""

GARMENTS = ("t-shirt", "jeans", "shirt", "tie", "scarf", "vest", "skirt", "hand-towel", "letter-towel")
MESH_M = 0.02
_TRIES = 50
_SUPPORT_RAD = Scene().support_angle_rad


@dataclass(frozen=True, slots=True)
class Sighted:
    """The result of a look at a rendered stack, beside the truth.

    Attributes:
        garment: its name.
        done: the folds done, as a bit mask.
        doubt: why it is not known where the stack lies; None where it is.
        off_m: how far each landmark is off (m); empty where nothing was found.
        told_m: how far off each may be as it was told (m).
        drawn_s: CPU time of the picture (s).
        looked_s: CPU time of the look (s).
    """

    garment: str
    done: int
    doubt: str | None
    off_m: tuple[float, ...]
    told_m: tuple[float, ...]
    drawn_s: float
    looked_s: float


@dataclass(frozen=True, slots=True, eq=False)
class Bench:
    """A robot's table and its camera."""

    table: Table
    camera: Camera

    def sight(self, number: int, *, is_plain: bool, has_arm: bool) -> Sighted:
        """Return what is seen of the stack of a number."""
        rng = np.random.default_rng([number, is_plain, has_arm])
        sequence, near = _laid_garment(rng, self.table)
        done = (1 << int(rng.integers(0, len(sequence.folds) + 1))) - 1
        dx, dy = rng.normal(0.0, SHIFT_M, 2).tolist()
        lies = Pose2(near.x_m + dx, near.y_m + dy, near.yaw_rad + rng.normal(0.0, TURN_RAD))
        pattern, triangles = woven_mesh(sequence.garment.pattern, MESH_M, number)
        really = _creased(sequence, done, float(rng.normal(0.0, CREASE_M)))
        positions = planned_positions(really, pattern, done, lies, self.table, 0.002)
        positions[:, :2] += _wrinkled(pattern, rng)
        robot = self._arm(lies.to_outer(sequence.cloth(done).silhouette.hull), rng) if has_arm else []
        look = replace(PLAIN, noise=4.0) if is_plain else _clear(rng)
        began = process_time()
        image = picture(self.camera, self.table, ClothSeen(pattern, positions, triangles), robot, look, number)
        drawn = process_time()
        folds = tuple(fold for fold in range(len(sequence.folds)) if done >> fold & 1)
        seen = Looker(self.camera, self.table, hidden(robot, self.camera)).look(image, sequence, folds, near)
        looked_s, drawn_s = process_time() - drawn, drawn - began
        doubt = None if seen.unknown is None else seen.unknown.text
        if seen.stack is None:
            return Sighted(sequence.garment.name, done, doubt, (), (), drawn_s, looked_s)
        marks = landmarks(sequence, done)
        there = planned_positions(really, on_pattern(sequence, done, marks), done, lies, self.table, 0.0)
        off = np.hypot(*(seen.stack.places(marks) - there[:, :2]).T)
        told = seen.stack.errors(marks)
        return Sighted(sequence.garment.name, done, doubt, tuple(off.tolist()), tuple(told.tolist()), drawn_s, looked_s)

    def _arm(self, hull: FloatArray, rng: np.random.Generator) -> list[FloatArray]:
        """Return the points of an arm, 8 cm thick, whose hand is over a corner of the stack."""
        tip = np.array([*hull[int(rng.integers(len(hull)))], 0.12])
        away = rng.uniform(-math.pi, math.pi)
        root = tip + np.array([math.cos(away), math.sin(away), 0.5]) * 0.8
        side = 0.04 * np.array([-math.sin(away), math.cos(away), 0.0])
        return [np.array([tip + side, tip - side, root + side, root - side])]


def overhead_bench() -> Bench:
    """Return the default table under the camera of a robot whose card names none."""
    table = Table()
    return Bench(table, hung(overhead(table)))


def landmarks(sequence: FoldSequence, done: int) -> FloatArray:
    """Return the points that the next folds would have to hold, or the corners of the stack's hull; shape (n, 2), m."""
    folds = [sequence.folds[index] for index in sequence.dag.available(done)]
    held = [must_hold(sequence.moving(fold.index), fold.line.left, (fold.line,), _SUPPORT_RAD) for fold in folds]
    points = [one for one in held if len(one)]
    return np.vstack(points) if points else sequence.cloth(done).silhouette.hull


def on_pattern(sequence: FoldSequence, done: int, points: FloatArray) -> FloatArray:
    """Return the points of the pattern that lie at points of the stack, of its uppermost layer there; shape (n, 2)."""
    layers = sequence.cloth(done).layers
    found = np.empty_like(points)
    for number, point in enumerate(points):
        gaps = [layer.region.distances_to(point[None])[0] for layer in layers]
        top = max(k for k, gap in enumerate(gaps) if gap <= min(gaps) + 1e-6)
        found[number] = layers[top].isometry.inverse.apply(point)
    return found


def _laid_garment(rng: np.random.Generator, table: Table) -> tuple[FoldSequence, Pose2]:
    """Return a shipped garment, or one of random measures, and where it ought to lie: on the table, anyhow turned."""
    for _ in range(_TRIES):
        try:
            sequence = replayed(_any_garment(rng))
        except FieldError:
            continue
        outline = np.array(sequence.garment.outline)
        turned = Pose2(0.0, 0.0, float(rng.uniform(-math.pi, math.pi)))
        ring = turned.to_outer(outline)
        room = (np.array([table.depth_m, table.width_m]) - np.ptp(ring, axis=0)) / 2.0 - 0.08
        if (room > 0.0).all():
            x, y = rng.uniform(-room, room) - (ring.min(axis=0) + ring.max(axis=0)) / 2.0
            return sequence, Pose2(float(x), float(y), turned.yaw_rad)
    raise LookupError("no garment has room on the table")


def _any_garment(rng: np.random.Generator) -> Garment:
    if rng.random() < 0.5:
        return load_garment(str(rng.choice(GARMENTS)))
    template = TEMPLATES[int(rng.integers(len(TEMPLATES)))]
    whole = float(rng.uniform(*MEASURES))
    given = {one.name: one.default_m * whole * float(rng.uniform(0.9, 1.1)) for one in template.measures}
    return template.garment(given)


def _creased(sequence: FoldSequence, done: int, off_m: float) -> FoldSequence:
    """Return the folds with the line of the last one done beside its place; as they are where that is not legal."""
    if not done:
        return sequence
    garment, last = sequence.garment, done.bit_length() - 1
    fold, line = garment.folds[last], sequence.folds[last].line
    x, y = off_m * np.array(line.left)
    ends = [(float(px + x), float(py + y)) for px, py in (line.start, line.end)]
    try:
        folds = (*garment.folds[:last], replace(fold, start=ends[0], end=ends[1]))
        return FoldSequence.of(replace(garment, folds=folds))
    except FieldError:
        return sequence


def _wrinkled(pattern: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Return how far points of cloth are aside, a millimetre or two, neighbours alike; shape (n, 2), m."""
    waves = rng.normal(0.0, 1.0, (4, 2)) * 12.0
    phases, sizes = rng.uniform(0.0, math.tau, 4), rng.normal(0.0, 0.0007, (4, 2))
    return np.asarray(np.sin(pattern @ waves.T + phases) @ sizes)


def _clear(rng: np.random.Generator) -> Look:
    """Return a look by chance."""
    return replace(random_look(rng), quality=90)
