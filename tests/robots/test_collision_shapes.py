"""Collision shapes: they contain the meshes, fit tightly, and survive a broken cache."""

import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import coal
import numpy as np
import pytest
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import LENGTH_M
from planner.robots.collision.part_poses import PLACE
from planner.robots.collision.part_source import ROUNDING_MAX_M
from planner.robots.collision.robot_parts import RobotParts
from planner.robots.collision.rounded_hull import RoundedHull, rounded_hull
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.arm_poses import EACH, pose_arm
from planner.robots.pr2.part_shapes import OPENINGS_M, part_shapes, pr2_parts
from planner.robots.pr2.parts import ARM_PARTS, BODY_PARTS, FINGERS, FINGERTIPS, pairs_in_arm, pairs_with_body
from tests.replay import hulls
from tests.required import required
from tests.robots.collision_samples import CARD, random_postures
from tests.robots.model import MODEL

GRIPPER = CARD.arms[0].gripper
ASYMMETRY_M = 0.0055
"""How far the left arm's meshes protrude from the mirror images of the right one's, at most (m)."""


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("cache")


@pytest.fixture(scope="module")
def parts(cache: Path) -> RobotParts:
    return pr2_parts(MODEL, CARD, cache)


def part_of(link: str) -> int | None:
    """Return the index of the part to which a link belongs, seen from the joint that moves it."""
    joints = hulls.moving_joints(link)
    if not joints:
        return 2 * EACH
    moved_by = joints[-1].replace("gripper_r_finger", "gripper_l_finger")
    for number, part in enumerate(BODY_PARTS):
        if moved_by == part.joint:
            return 2 * EACH + number
    found = [number for number, part in enumerate(ARM_PARTS) if moved_by[2:] == part.joint]
    return None if not found else found[0] + EACH * (moved_by[0] == "r")


def part_poses(parts: RobotParts, torso_m: float, posture: FloatArray) -> FloatArray:
    assert isinstance(parts.kinematics, ArmShape)
    poses = np.zeros((2 * EACH + len(BODY_PARTS), 5, 3))
    for arm in (0, 1):
        pose_arm(parts.kinematics, torso_m, posture[arm], 1.0 - 2.0 * arm, poses[EACH * arm : EACH * (arm + 1)])
    poses[2 * EACH :, : PLACE + 1] = parts.body_poses
    poses[2 * EACH + 1 :, PLACE, 2] += torso_m
    return poses


def distances(points: np.ndarray, hull: RoundedHull) -> np.ndarray:
    """Return the distances of points outside a hull, without its rounding (m)."""
    convex, here, point = hull.convex(), coal.Transform3s.Identity(), coal.Sphere(0.0)
    request = coal.DistanceRequest()
    found = [
        coal.distance(convex, here, point, coal.Transform3s(np.eye(3), p), request, coal.DistanceResult())
        for p in points
    ]
    return np.maximum(found, 0.0)


def test_every_link_with_a_mesh_belongs_to_a_part() -> None:
    without = {link.name for link in hulls.bodies() if part_of(link.name) is None}
    assert not without


LEVELS = range(len(OPENINGS_M))


@pytest.mark.parametrize(
    "level", [0, *(pytest.param(level, marks=pytest.mark.long) for level in LEVELS[1:-1]), LEVELS[-1]]
)
def test_every_vertex_of_every_mesh_is_inside_its_parts_shape(parts: RobotParts, level: int) -> None:
    rng = np.random.default_rng(level)
    for posture in random_postures(2, level):
        torso_m, opening_m = rng.uniform(0.0, 0.31), rng.uniform(0.0, OPENINGS_M[level])
        hulls.robot().update_cfg(CARD.joint_values(torso_m, posture, [opening_m, OPENINGS_M[level]]))
        poses = part_poses(parts, torso_m, posture)
        for link in hulls.bodies():
            part = required(part_of(link.name))
            to_base = hulls.robot().get_transform(link.name)
            vertices = hulls.link_vertices(link.name) @ to_base[:3, :3].T + to_base[:3, 3]
            hull = parts.hulls[level][part]
            seen_from_part = (vertices - poses[part, PLACE]) @ poses[part, :PLACE]
            outside = distances(seen_from_part, hull).max() - hull.radius_m
            assert outside <= LENGTH_M, f"{link.name} stands {outside:.5f} m out of {parts.names[part]}"


def test_a_shape_stands_out_from_its_meshes_hull_by_little(parts: RobotParts) -> None:
    posture = random_postures(1, 5)[0]
    hulls.robot().update_cfg(CARD.joint_values(0.1, posture, [0.0, 0.0]))
    poses = part_poses(parts, 0.1, posture)
    for part, hull in enumerate(parts.hulls[0]):
        assert hull.radius_m <= ROUNDING_MAX_M + LENGTH_M
        if part < 2 * EACH and part % EACH in (FINGERS, FINGERTIPS):
            continue
        clouds = []
        for link in hulls.bodies():
            if part_of(link.name) == part:
                to_base = hulls.robot().get_transform(link.name)
                clouds.append(hulls.link_vertices(link.name) @ to_base[:3, :3].T + to_base[:3, 3])
        meshes = rounded_hull(np.vstack(clouds), LENGTH_M)
        corners = hull.corners @ poses[part, :PLACE].T + poses[part, PLACE]
        assert distances(corners, meshes).max() <= ASYMMETRY_M, parts.names[part]


def test_all_pairs_that_the_srdf_asks_for_are_compared() -> None:
    """The description's SRDF disables neighbours, and what never touches in its samples of the meshes."""
    srdf = ElementTree.parse(CARD.urdf_path.parent.parent / "srdf" / "pr2.srdf").getroot()
    disabled = {frozenset((one.get("link1"), one.get("link2"))) for one in srdf.iter("disable_collisions")}
    links = [link.name for link in hulls.bodies() if hulls.robot().link_map[link.name].collisions]
    enabled = [pair for pair in combinations(links, 2) if frozenset(pair) not in disabled]
    assert len(enabled) == 239
    in_arm, with_body = set(pairs_in_arm()), set(pairs_with_body())
    for pair in enabled:
        assert hulls.are_compared(*pair)
        inner, outer = sorted(required(part_of(link)) for link in pair)
        if outer >= 2 * EACH:
            assert (inner % EACH, outer - 2 * EACH) in with_body, pair
        elif inner // EACH == outer // EACH:
            assert (outer % EACH, inner % EACH) in in_arm, pair


def test_shapes_read_from_the_cache_are_those_made(cache: Path, parts: RobotParts) -> None:
    (path,) = cache.glob("shapes/*.npz")
    made, read = path.read_bytes(), part_shapes(MODEL, GRIPPER, cache)
    assert path.read_bytes() == made
    for number, part in enumerate(BODY_PARTS):
        np.testing.assert_array_equal(read[part.name].corners, parts.hulls[0][2 * EACH + number].corners)
        np.testing.assert_array_equal(read[part.name].faces, parts.hulls[0][2 * EACH + number].faces)
        assert read[part.name].radius_m == parts.hulls[0][2 * EACH + number].radius_m


def _cut_short(content: bytes) -> bytes:
    return content[: len(content) // 2]


def _flipped(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + bytes(byte ^ 255 for byte in content[middle : middle + 2000]) + content[middle + 2000 :]


@pytest.mark.parametrize(
    "spoil",
    [
        pytest.param(_cut_short, marks=pytest.mark.long),
        _flipped,
        pytest.param(lambda _: b"", marks=pytest.mark.long),
        pytest.param(lambda _: b"not shapes at all", marks=pytest.mark.long),
    ],
)
def test_a_spoilt_cache_is_made_anew(
    cache: Path, parts: RobotParts, tmp_path: Path, spoil: Callable[[bytes], bytes]
) -> None:
    (path,) = cache.glob("shapes/*.npz")
    spoilt = tmp_path / "shapes" / path.name
    spoilt.parent.mkdir()
    spoilt.write_bytes(spoil(path.read_bytes()))
    shapes = part_shapes(MODEL, GRIPPER, tmp_path)
    np.testing.assert_array_equal(shapes["torso"].corners, parts.hulls[0][2 * EACH + 1].corners)
    assert spoilt.stat().st_size == path.stat().st_size
    assert list(spoilt.parent.iterdir()) == [spoilt]


def test_shapes_are_made_even_where_no_cache_can_be(parts: RobotParts, tmp_path: Path) -> None:
    in_the_way = tmp_path / "file"
    in_the_way.write_text("no directory")
    shapes = part_shapes(MODEL, GRIPPER, in_the_way)
    np.testing.assert_array_equal(shapes["base"].corners, parts.hulls[0][2 * EACH].corners)


def test_a_rounded_hull_of_a_box_is_the_box() -> None:
    box = np.array([(x, y, z) for x in (0.0, 0.3) for y in (0.0, 0.2) for z in (0.0, 0.1)])
    rng = np.random.default_rng(1)
    hull = rounded_hull(np.vstack([box, rng.uniform((0, 0, 0), (0.3, 0.2, 0.1), (50, 3))]), 0.001)
    assert {tuple(corner) for corner in hull.corners.tolist()} == {tuple(corner) for corner in box.tolist()}
    assert len(hull.faces) == 12
    assert hull.radius_m <= LENGTH_M
    a, b, c = (hull.corners[hull.faces[:, k]] for k in range(3))
    outwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - box.mean(axis=0))
    assert np.all(outwards > 0.0)


@pytest.mark.parametrize(
    ("corners", "faces", "radius_m"),
    [
        (np.zeros((4, 2)), np.zeros((4, 3), np.int32), 0.0),
        (np.zeros((4, 3)), np.full((4, 3), 4, np.int32), 0.0),
        (np.zeros((4, 3)), np.zeros((3, 3), np.int32), 0.0),
        (np.zeros((4, 3)), np.zeros((4, 3), np.int32), -0.1),
    ],
)
def test_what_is_no_hull_is_refused(corners: FloatArray, faces: NDArray[np.int32], radius_m: float) -> None:
    with pytest.raises(ValueError, match=r"hull|faces|radius"):
        RoundedHull(corners, faces, radius_m)


def test_the_bodys_shapes_are_their_own_mirror_images(parts: RobotParts) -> None:
    for part, hull in enumerate(parts.hulls[0][2 * EACH :]):
        here = distances(hull.corners, hull.mirrored())
        assert here.max() <= LENGTH_M, parts.names[2 * EACH + part]
