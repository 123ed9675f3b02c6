"""Shapes in a 3D view: colours under its light, cloth that lies or hangs, lines on it, rotations."""

import numpy as np
import pytest

from app.ui.colours import DARK, LIGHT, Palette
from app.ui.fold_view import Relief, dashed, solid, split_at
from app.ui.lighting import ink, paint, seen, seen_line
from app.ui.rotation import from_matrix, product, turn
from app.ui.thick_cloth import ThickCloth
from planner import Scene, load_garment
from planner.motion.cloth_surface import ClothSurface, spread_cloth
from tests.app.pose_matrix import matrix


@pytest.mark.parametrize("palette", [LIGHT, DARK])
def test_what_lies_level_looks_like_the_colour_asked_for(palette: Palette) -> None:
    for wanted in (palette.cloth_front, palette.cloth_back, palette.table, palette.robot_light, palette.robot_grey):
        assert np.abs(np.subtract(seen(paint(wanted)), wanted)).max() <= 2


@pytest.mark.parametrize("palette", [LIGHT, DARK])
def test_lines_keep_their_hue_where_the_film_does_not_show_all_of_their_light(palette: Palette) -> None:
    brightest = 226  # of white, after the film
    for wanted in (*palette.folds.values(), palette.cloth_edge, palette.route):
        red, green, blue = ink(wanted).tolist()
        assert np.abs(np.subtract(seen_line((red, green, blue)), np.minimum(wanted, brightest))).max() <= 14
    assert seen_line((255, 255, 255)) == (brightest, brightest, brightest)


def sheet(*layers: tuple[float, float, float]) -> ClothSurface:
    """Return squares of cloth on the table, each with its near and far x and its height, from y = 0 to y = 1."""
    corners = []
    for low, high, z in layers:
        a, b, c, d = (low, 0.0, z), (high, 0.0, z), (high, 1.0, z), (low, 1.0, z)
        corners.extend([a, b, c, a, c, d])
    triangles = np.arange(len(corners)).reshape(-1, 3)
    vertices = np.array(corners)
    return ClothSurface(vertices, triangles, np.repeat(np.arange(len(layers)), 2), vertices, vertices[:, :2])


def test_cloth_is_as_high_as_its_topmost_layer_there() -> None:
    relief = Relief.of(sheet((0.0, 0.8, 0.0015), (0.5, 0.9, 0.003)))
    points = np.array([[0.2, 0.5], [0.6, 0.5], [0.85, 0.5], [0.95, 0.5]])
    np.testing.assert_array_equal(relief.heights_at(points), [0.0015, 0.003, 0.003, -np.inf])


def test_cloth_in_the_air_does_not_lie() -> None:
    standing = ClothSurface(
        np.array([[0.0, 0.0, 0.0015], [0.0, 1.0, 0.0015], [0.0, 0.0, 0.5]]),
        np.array([[0, 1, 2]]),
        np.zeros(1, dtype=np.int64),
        np.full((3, 3), np.nan),
        np.zeros((3, 2)),
    )
    assert Relief.of(standing).heights_at(np.array([[0.0, 0.5]]))[0] == -np.inf


def test_hanging_cloth_is_rolled_back_into_the_plane() -> None:
    garment = load_garment("big-towel")
    relief = Relief.of(spread_cloth(garment, Scene().table))
    a, b, c = (relief.triangles[:, i] for i in range(3))
    sides = b - a, c - a
    area = float((sides[0][:, 0] * sides[1][:, 1] - sides[0][:, 1] * sides[1][:, 0]).sum() / 2)
    assert area == pytest.approx(garment.pattern.area, rel=1e-3)


def test_a_line_is_cut_where_it_crosses_and_nowhere_else() -> None:
    segments = np.array([[[0.0, 0.0], [1.0, 1.0]], [[0.0, 0.0], [0.2, 0.0]]])
    cut = split_at(segments, 0, 0.5)
    assert len(cut) == 3
    lengths = np.linalg.norm(cut[:, 1] - cut[:, 0], axis=1)
    assert lengths.sum() == pytest.approx(np.sqrt(2.0) + 0.2)
    assert np.all((cut[..., 0].max(axis=1) <= 0.5) | (cut[..., 0].min(axis=1) >= 0.5))


def test_a_quaternion_from_a_matrix_is_the_same_rotation() -> None:
    random = np.random.default_rng(1)
    for _ in range(50):
        axes = [vector / np.linalg.norm(vector) for vector in random.normal(size=(2, 3))]
        angles = random.uniform(-3.0, 3.0, size=2)
        wxyz = product(turn(axes[0], angles[0]), turn(axes[1], angles[1]))
        whole = matrix((0, 0, 0), turn(axes[0], angles[0])) @ matrix((0, 0, 0), turn(axes[1], angles[1]))
        np.testing.assert_allclose(matrix((0, 0, 0), wxyz), whole, atol=1e-12)
        np.testing.assert_allclose(matrix((0, 0, 0), from_matrix(whole)), whole, atol=1e-12)


def test_a_square_of_cloth_is_as_thick_as_it_says_and_its_hem_bulges() -> None:
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    square = ClothSurface(corners, np.arange(6).reshape(-1, 3), np.zeros(2, dtype=np.int64), corners, corners[:, :2])
    thick = ThickCloth(square, 0.25)
    front, back = thick.faces
    assert len(front) == len(back) == len(thick.pattern) == 4
    np.testing.assert_allclose(front[thick.triangles.ravel()], corners + np.array([0.0, 0.0, 0.1]))
    np.testing.assert_allclose(back[thick.triangles.ravel()], corners - np.array([0.0, 0.0, 0.1]))
    np.testing.assert_allclose(thick.pattern[thick.triangles.ravel()], corners[:, :2])
    assert len(thick.edges) == 4  # none along the diagonal
    np.testing.assert_allclose(np.linalg.norm(thick.edges[:, 0] - thick.edges[:, 1], axis=1), 1.0)
    vertices, triangles = thick.hem
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    outwards = np.cross(b - a, c - a)
    assert np.all((outwards[:, :2] * ((a + b + c)[:, :2] / 3 - 0.5)).sum(axis=1) > 0.0)
    assert vertices[:, :2].min() == pytest.approx(-0.1) and vertices[:, :2].max() == pytest.approx(1.1)


def test_two_layers_folded_flat_are_joined_by_a_half_round_as_high_as_they_are_apart() -> None:
    lower = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    upper = lower[[0, 2, 1, 3, 5, 4]] + np.array([0.0, 0.0, 0.5])  # its back looks up
    pattern = np.concatenate([lower[:, :2], upper[:, :2] * np.array([-1.0, 1.0])])
    vertices = np.concatenate([lower, upper])
    folded = ClothSurface(vertices, np.arange(12).reshape(-1, 3), np.repeat([0, 1], 2), vertices, pattern)
    thick = ThickCloth(folded, 0.25)
    assert len(thick.edges) == 6  # the crease has none
    points, triangles = thick.hem
    bent = points[points[:, 0] < -0.001]
    np.testing.assert_allclose(np.hypot(bent[:, 0], bent[:, 2] - 0.25), 0.25 + 0.1)
    a, b, c = points[triangles].transpose(1, 0, 2)
    middles, outwards = (a + b + c) / 3, np.cross(b - a, c - a)
    is_round = middles[:, 0] < -0.01
    seen = outwards * (middles - np.array([0.0, 0.5, 0.25])) * np.array([1.0, 0.0, 1.0])
    assert is_round.any() and np.all(seen[is_round].sum(axis=1) > 0.0)


def test_a_garment_beyond_the_edge_hangs() -> None:
    garment = load_garment("big-towel")
    hanging = spread_cloth(garment, Scene().table)
    flat = garment.pattern.area
    a, b, c = (hanging.vertices[hanging.triangles[:, i]] for i in range(3))
    area = float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)
    assert area == pytest.approx(flat, rel=1e-3)
    assert np.abs(hanging.vertices[:, 0]).max() <= 0.8 + 0.01


def test_a_solid_line_has_no_gaps_and_a_dashed_one_has() -> None:
    start, end = np.array([0.0, 0.0]), np.array([0.3, 0.4])
    whole, parts = solid(start, end), dashed(start, end, (0.04, 0.01))
    length = np.linalg.norm(whole[:, 1] - whole[:, 0], axis=1).sum()
    assert length == pytest.approx(0.5)
    assert np.linalg.norm(parts[:, 1] - parts[:, 0], axis=1).sum() == pytest.approx(0.4)
    np.testing.assert_array_equal(dashed(start, end, ()), whole)
    np.testing.assert_allclose(whole[-1, 1], end)
