"""Where edges lie that a camera sees at a slant: as far out as they are, however high they stand."""

import math

import numpy as np
import pytest

from app.rehearsal.camera.camera import Camera
from app.rehearsal.camera.look import PLAIN
from app.rehearsal.camera.mounted import hung, overhead
from app.rehearsal.camera.picture import ClothSeen, picture
from app.rehearsal.vision.edge_heights import LOOP_M, EdgeHeights
from app.rehearsal.vision.look_at_stack import Looker
from planner import load_garment
from planner.folds.fold_sequence import FoldSequence, replayed
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.geometry.woven_mesh import woven_mesh

TABLE = Table()
LIES = Pose2(-0.9095, 0.343, -math.pi / 2.0)
"""The towel's crease, y = .2095 m and .686 m long, lies along x = -.7 m, and its cloth at greater x."""

HALF_M = LOOP_M / 2.0


def towel() -> FoldSequence:
    return replayed(load_garment("hand-towel"))  # .686 x .419 m, its near half folded up at y = .2095 m


def heights() -> EdgeHeights:
    sequence = towel()
    return EdgeHeights.of(sequence.cloth(1), sequence.garment)


def beside_the_table() -> Camera:
    """A camera .8 m over the table, 1.5 m from the crease on the side to which that lies, that looks down."""
    down = math.radians(27.0)
    ahead = np.array([math.cos(down), 0.0, -math.sin(down)])
    right = np.array([0.0, -1.0, 0.0])
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([right, np.cross(ahead, right), ahead])
    pose[:3, 3] = (-2.2, 0.0, 0.8)
    return Camera.at(pose, (1600, 1200), 1.0)


def loop_seen(camera: Camera, y_m: float) -> FloatArray:
    """The pixel at which the outermost point of a loop at y, garment frame, is seen: the one furthest out."""
    turns = np.linspace(-math.pi / 2.0, math.pi / 2.0, 721)
    rounds = np.column_stack([np.cos(turns), 1.0 + np.sin(turns)]) * HALF_M
    placed = LIES.to_outer(np.column_stack([np.full(len(turns), 0.343), y_m + HALF_M - rounds[:, 0]]))
    pixels = camera.pixels(np.column_stack([placed, rounds[:, 1]]))
    return pixels[[int(camera.on_plane(pixels)[:, 0].argmin())]]


@pytest.mark.parametrize("camera", [hung(overhead(TABLE)), beside_the_table()])
def test_a_crease_lies_where_its_loop_ends_whichever_way_the_camera_leans(camera: Camera) -> None:
    seen = heights().seen_at(camera, loop_seen(camera, 0.2095), LIES)
    assert LIES.to_inner(seen)[0] == pytest.approx([0.343, 0.2095], abs=2e-4)
    flat = camera.on_plane(loop_seen(camera, 0.2095), 0.002)  # half of its two layers, as it was taken before
    assert abs(LIES.to_inner(flat)[0, 1] - 0.2095) > 1.5e-3


def test_an_edge_is_as_high_as_the_layers_that_end_there_and_a_crease_as_its_loop() -> None:
    points = np.array([(0.343, 0.419), (0.343, 0.2095)])
    found = heights().halves(points, np.array([(0.0, 1.0), (0.0, -1.0)]))
    assert found == pytest.approx([0.002, 0.008])  # two layers of 2 mm, and a loop of 16 mm


def test_the_crease_of_a_towel_in_a_picture_is_seen_where_its_loop_ends() -> None:
    sequence, camera = towel(), hung(overhead(TABLE))
    pattern, triangles = woven_mesh(sequence.garment.pattern, 0.006, 1)
    over_m = 0.2095 + math.pi / 2.0 * HALF_M - pattern[:, 1]  # along the cloth, from where its loop begins
    turned = np.clip(over_m / HALF_M, 0.0, math.pi)
    beyond_m = np.maximum(over_m - math.pi * HALF_M, 0.0)
    y_m = 0.2095 + HALF_M * (1.0 - np.sin(turned)) + np.maximum(-over_m, 0.0) + beyond_m
    lowered = np.exp(-beyond_m / 0.03)
    z_m = 0.002 + (LOOP_M - 0.002) * (1.0 - np.cos(turned)) / 2.0 * lowered
    placed = LIES.to_outer(np.column_stack([pattern[:, 0], y_m]))
    cloth = ClothSeen(pattern, np.column_stack([placed, z_m]), triangles)
    image = picture(camera, TABLE, cloth, [], PLAIN, 3)
    hidden = np.zeros(image.shape[:2], bool)
    stack = Looker(camera, TABLE, hidden).look(image, sequence, (0,), LIES).stack
    assert stack is not None
    seen = LIES.to_inner(stack.outline)
    at_crease = seen[(np.abs(seen[:, 0] - 0.343) < 0.3) & (seen[:, 1] < 0.25)]
    assert len(at_crease) > 50
    assert at_crease[:, 1].mean() == pytest.approx(0.2095, abs=1.2e-3)
