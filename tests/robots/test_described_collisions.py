"""Collisions of described robots: against hulls that pinocchio reads and poses, by geometry, and how parts are made."""

import json
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from planner.errors import RobotError
from planner.geometry.pose import FloatArray, Pose2
from planner.robots.collision import part_source
from planner.robots.collision.collisions import Collisions
from planner.robots.collision.described_parts import described_parts
from planner.robots.collision.link_shapes import link_shapes, require_shown
from planner.robots.described_robot import DescribedRobot, read_robot
from planner.robots.known_robots import shipped_robots
from tests.replay.described_hulls import Hulls
from tests.required import required
from tests.sweep import sweep

OPENING_M = 0.04


def station(robot: DescribedRobot) -> Pose2:
    return robot.card.scene.stations[0][1]


def collisions(robot: DescribedRobot, **options: float) -> Collisions:
    scene = robot.card.scene
    return Collisions(described_parts(robot), scene.table, scene.torso_m, **options)


def home(robot: DescribedRobot) -> FloatArray:
    return np.array([q for arm in robot.arms for q in arm.card.home])


def anywhere(robot: DescribedRobot, count: int, seed: int) -> FloatArray:
    """Return postures of all arms anywhere within their limits, shape (count, joints)."""
    chains = [arm.chain for arm in robot.arms]
    low = np.concatenate([np.where(chain.turns, -np.pi, chain.low) for chain in chains])
    high = np.concatenate([np.where(chain.turns, np.pi, chain.high) for chain in chains])
    return np.random.default_rng(seed).uniform(low, high, (count, len(low)))


def columns(robot: DescribedRobot, arm: int) -> slice:
    first = sum(len(one.card.joints) for one in robot.arms[:arm])
    return slice(first, first + len(robot.arms[arm].card.joints))


@sweep("name", shipped_robots(), quick=["pr2", "panda-pair", "so101-pair"])
def test_every_robot_is_free_at_home_at_its_stations(name: str) -> None:
    robot = read_robot(name)
    asked = collisions(robot)
    for _, pose in robot.card.scene.stations:
        assert asked.deepest_contact(pose, home(robot)) is None
        assert asked.is_path_free(pose, home(robot)[None])
        assert asked.body_free(pose)


@sweep("name", ["ur5e-pair", "panda-pair", "so101-pair", "baxter", "tiago-pro"], ("panda-pair",))
def test_what_is_free_is_free_for_the_hulls_of_pinocchio(name: str) -> None:
    robot, count = read_robot(name), 60
    truth, asked, base = Hulls(robot), collisions(robot, opening_m=OPENING_M), station(robot)
    postures, rng = anywhere(robot, count, 3), np.random.default_rng(4)
    widest_m = [min(OPENING_M, arm.card.gripper.opening_max_m) for arm in robot.arms]
    touching = np.array(
        [
            truth.touching(truth.values(joints, rng.uniform(0.0, widest_m), robot.card.scene.torso_m), base)
            for joints in postures
        ]
    )
    is_free = asked.free(base, postures)
    wrong = np.argwhere(touching & truth.is_must & is_free[:, None])
    assert not len(wrong), f"free, but {truth.names(wrong[0, 1])}"
    assert 0 < is_free.sum() < count
    # Links near each other whose crude shapes overlap in most postures (Baxter's cylinders) say nothing about one.
    is_telling = truth.is_must | (touching.mean(axis=0) < 0.5)
    is_clear = ~touching[:, is_telling].any(axis=1)
    assert is_clear.any(), "no posture is free by the truth: it cannot show a false alarm"
    assert (is_clear & ~is_free).sum() <= 0.07 * count
    is_apart = asked.arms_apart((0, 1), postures)
    assert not np.any(is_apart[:, None] & touching & truth.is_must & truth.is_between_arms)
    alone = [asked.arm_free(arm, base, np.ascontiguousarray(postures[:, columns(robot, arm)])) for arm in (0, 1)]
    np.testing.assert_array_equal(is_free, is_apart & alone[0] & alone[1])


BENCH = """<robot name="slides">
  <link name="rail"><collision><geometry><box size="0.1 0.05 0.05"/></geometry></collision></link>
  <link name="slider"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="rod"><collision><origin xyz="0.225 0 0"/>
    <geometry>{rod}</geometry></collision></link>
  <link name="finger"><visual><origin xyz="0.025 0.01 0"/>
    <geometry><box size="0.05 0.01 0.06"/></geometry></visual></link>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="slider"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.6" velocity="1" effort="1"/></joint>
  <joint name="bend" type="revolute"><parent link="slider"/><child link="rod"/><axis xyz="0 1 0"/>
    <limit lower="-1.5" upper="1.5" velocity="1" effort="1"/></joint>
  <joint name="grip" type="prismatic"><origin xyz="0.4 0 0"/><parent link="rod"/><child link="finger"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.04" velocity="1" effort="1"/></joint>
</robot>"""
"""A rail on which a slider goes to the right; on it a rod of .4 m that bends down, and a finger of .05 m at its end."""

ROD = '<box size="0.35 0.06 0.06"/>'


def bench(folder: Path, rod: str = ROD, bend: str = "bend") -> DescribedRobot:
    """Return three of these arms, .6 m apart, 1 m high and .6 m before the table's middle; the last only bends."""
    text = BENCH.format(rod=rod).replace('joint name="bend"', f'joint name="{bend}"')
    (folder / "slides.urdf").write_text(text)
    arms = [
        {
            "name": name,
            "joints": [f"{name}_{joint}" for joint in joints],
            "tool": {"link": f"{name}_rod", "approach": [1, 0, 0], "closing": [0, 1, 0], "offset_m": [0.45, 0, 0]},
            "home": [0.0] * len(joints),
            "gripper": {
                "drive": {"kind": "linear", "joint": f"{name}_grip", "closed": 0.0, "opened": 0.04},
                **{"opening_max_m": 0.08, "finger_length_m": 0.05, "finger_width_m": 0.06, "finger_thickness_m": 0.01},
            },
        }
        for name, joints in (("port", ("slide", bend)), ("middle", ("slide", bend)), ("lee", (bend,)))
    ]
    card = {
        "pleat_robot": 1,
        "name": "three",
        "title": "Three slides",
        "urdf": {"path": "slides.urdf"},
        "mounts": [{"name": name, "y_m": y, "z_m": 1.0} for name, y in (("port", 0.6), ("middle", 0.0), ("lee", -0.6))],
        "arms": arms,
        "base": {"kind": "fixed", "radius_m": 0.8, "size_m": [0.2, 1.4]},
        "scene": {
            "table": {"depth_m": 0.8, "width_m": 1.6, "height_m": 0.75},
            "stations": {"edge": {"x_m": -0.6, "y_m": 0.0, "yaw_rad": 0.0}},
            "placement": {"x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0},
        },
    }
    (folder / "three.json").write_text(json.dumps(card))
    return read_robot(str(folder / "three.json"))


def three(folder: Path, rod: str = ROD, **options: float) -> tuple[Collisions, Pose2]:
    robot = bench(folder, rod)
    scene = robot.card.scene
    return Collisions(described_parts(robot, folder), scene.table, 0.0, **options), station(robot)


def test_arms_of_different_joints_meet_where_their_sliders_do(tmp_path: Path) -> None:
    # Sliders are .1 m wide and their rails .6 m apart; the last arm stays where it is.
    asked, base = three(tmp_path)
    nearly, met = np.array([0.48, 0.0, 0.0, 0.0, 0.0]), np.array([0.52, 0.0, 0.0, 0.0, 0.0])
    assert asked.free(base, np.array([nearly, met])).tolist() == [True, False]
    contact = asked.deepest_contact(base, met)
    assert contact is not None
    assert (contact.first, contact.second) == ("port slider", "middle slider")
    assert contact.depth_m == pytest.approx(0.02, abs=2e-4)
    assert asked.arms_apart((0, 2), met[None, [0, 1, 4]]).tolist() == [True]
    assert asked.arms_apart((0, 1, 2), np.array([nearly, met])).tolist() == [True, False]
    last = np.array([[0.0, 0.0, 0.52, 0.0, 0.0]])
    assert asked.arms_apart((0, 1), last[:, :4]).tolist() == [True]
    assert asked.arms_apart((1, 2), last[:, 2:]).tolist() == [False]


def test_a_joint_may_be_called_as_its_link_is(tmp_path: Path) -> None:
    robot = bench(tmp_path, bend="rod")
    assert described_parts(robot, tmp_path).names[:3] == ("port slider", "port rod", "port fingers")


def test_postures_of_two_arms_are_apart_as_they_are_pair_by_pair(tmp_path: Path) -> None:
    asked, _ = three(tmp_path)
    first, second = np.array([[s, 0.0] for s in (0.0, 0.3, 0.48, 0.56)]), np.array([[s, 0.0] for s in (0.1, 0.0)])
    for slides in first:  # one posture each, as its tool is in the same pose in all that are asked at once
        pair = np.hstack([np.tile(slides, (2, 1)), second])
        found = [asked.postures_apart((0, 1), slides[None], one[None])[0, 0] for one in second]
        assert found == asked.arms_apart((0, 1), pair).tolist()
        assert asked.are_some_apart((0, 1), slides[None], second[1:]) == found[1]


def test_fingers_may_come_close_to_the_table_and_a_rod_only_to_the_margin(tmp_path: Path) -> None:
    # Bent by .5 the rod's end, .4 m out and .03 m thick, is at 1 - .4 sin .5 - .03 cos .5 = .782 m, the finger's at
    # 1 - .45 sin .5 - .03 cos .5 = .758 m; the table is .75 m high. Bent by .6 the finger is .035 m in it.
    bent = np.array([[0.5], [0.6]])
    for margin_m, is_free in ((0.0, [True, False]), (0.02, [True, False]), (0.04, [False, False])):
        asked, base = three(tmp_path, margin_m=margin_m)
        assert asked.arm_free(2, base, bent).tolist() == is_free
        assert asked.arm_free(2, base, bent).tolist() == is_free
    contact = three(tmp_path)[0].deepest_contact(base, np.array([0.0, 0.0, 0.0, 0.0, 0.6]))
    assert contact is not None
    assert (contact.first, contact.second) == ("lee fingers", "table top")


def test_arms_keep_a_height_over_cloth(tmp_path: Path) -> None:
    asked, base = three(tmp_path)
    cloth = np.array([[-0.3, 0.5], [-0.3, 0.7], [0.0, 0.7], [0.0, 0.5]])[::-1]
    low, high = np.array([[0.0, 0.45]]), np.array([[0.0, 0.2]])
    over = asked.over_cloth([cloth], 0.1)
    assert over.arm_clear(0, base, np.vstack([low, high])).tolist() == [False, True]
    assert over.arm_clear(1, base, np.vstack([low, high])).tolist() == [True, True]


def test_parts_are_the_same_when_they_are_read_again_and_when_the_cache_is_spoilt(tmp_path: Path) -> None:
    robot = bench(tmp_path)
    made = described_parts(robot, tmp_path)
    (path,) = (tmp_path / "shapes").glob("*.npz")
    for content in (path.read_bytes(), b"not shapes at all"):
        path.write_bytes(content)
        described_parts.cache_clear()
        read = described_parts(robot, tmp_path)
        assert (read.names, read.skipped) == (made.names, made.skipped)
        for one, other in zip(read.hulls[-1], made.hulls[-1], strict=True):
            np.testing.assert_array_equal(one.corners, other.corners)
        for pairs, same in zip(read.own_pairs, made.own_pairs, strict=True):
            np.testing.assert_array_equal(pairs, same)


def test_parts_are_made_once_for_copies_under_other_names_in_other_folders_but_not_for_other_meshes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[str] = []
    make = part_source.make_parts

    def counted(robot: DescribedRobot) -> list[part_source.Part]:
        made.append(robot.card.name)
        return make(robot)

    monkeypatch.setattr("planner.robots.collision.described_parts.make_parts", counted)
    for name, side_m, times in (("first", 1, 1), ("second", 1, 1), ("third", 2, 2)):
        folder = tmp_path / name
        folder.mkdir()
        corners = (f"v 0 0 0\nv {side_m} 0 0\nv 0 1 0\nv 0 0 1", "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4")
        (folder / "rod.obj").write_text("\n".join(corners))
        bench(folder, '<mesh filename="rod.obj" scale="0.1 0.1 0.1"/>')
        card = json.loads((folder / "three.json").read_text())
        (folder / "three.json").write_text(json.dumps(card | {"name": name, "title": name.title()}))
        described_parts(read_robot(str(folder / "three.json")), tmp_path)
        assert len(made) == times


def test_a_mesh_counts_once_for_all_its_links_and_with_the_meshes_before_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("planner.robots.collision.link_shapes.TRIANGLES_MAX", 6)
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "rod.obj").write_text(corners + "f 1 1 2\nf 3 3 3\n")  # the last two have no area
    (tmp_path / "other.obj").write_text(corners)
    link = '<link name="{}"><visual><geometry><mesh filename="{}"/></geometry></visual></link>'
    rod, other = tmp_path / "rod.obj", tmp_path / "other.obj"
    require_shown(f"<robot name='r'>{link.format('a', rod)}{link.format('b', rod)}</robot>")
    with pytest.raises(RobotError, match=r"link 'b': the mesh 'other.obj' has 4 triangles, 8 with the meshes before"):
        require_shown(f"<robot name='r'>{link.format('a', rod)}{link.format('b', other)}</robot>")


def test_a_mesh_of_more_triangles_than_may_be_is_refused_by_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("planner.robots.collision.link_shapes.TRIANGLES_MAX", 4)
    corners, faces = ("v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1"), ["f 1 3 2", "f 1 2 4", "f 1 4 3", "f 2 3 4"]
    for number, more in enumerate(([], ["f 2 4 3"])):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "rod.obj").write_text("\n".join([*corners, *faces, *more]))
        robot = bench(folder, '<mesh filename="rod.obj" scale="0.1 0.1 0.1"/>')
        if not more:
            assert "port rod" in described_parts(robot, folder).names
            continue
        with pytest.raises(RobotError, match=r"link 'port_rod': the mesh 'rod.obj' has 5 triangles"):
            described_parts(robot, folder)


def test_a_triangle_that_a_mesh_repeats_is_one_of_its_shape(tmp_path: Path) -> None:
    faces = ["f 1 3 2", "f 1 2 4", "f 1 4 3", "f 2 3 4", "f 4 2 3", "f 6 5 7"]
    corners = ["v 0 0 0", "v .1 0 0", "v 0 .1 0", "v 0 0 .1", "v 0 0 0", "v .1 0 0", "v 0 .1 0"]
    (tmp_path / "rod.obj").write_text("\n".join([*corners, *faces]))
    link = f'<link name="rod"><visual><geometry><mesh filename="{tmp_path}/rod.obj"/></geometry></visual></link>'
    urdf = f'<robot name="r">{link}</robot>'
    [shape] = link_shapes(pin.buildModelFromXML(urdf), urdf)
    assert required(shape.triangles).tolist() == [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    assert shape.geometry.num_vertices == len(shape.corners) == 4


@pytest.mark.parametrize(
    ("rod", "said"),
    [
        ('<mesh filename="rod.obj"/>', "the mesh 'rod.obj' cannot be read"),
        ('<box size="0.1 nan 0.1"/>', "box whose numbers make no shape"),
        ('<box size="0.1 0.1"/>', "box whose numbers make no shape"),
        ('<sphere radius="inf"/>', "sphere whose numbers make no shape"),
        ('<cylinder radius="0.1"/>', "cylinder whose numbers make no shape"),
        ("<torus/>", "unsupported shape 'torus'"),
    ],
)
def test_a_shape_that_is_none_is_told_with_its_link(tmp_path: Path, rod: str, said: str) -> None:
    (tmp_path / "rod.obj").write_text("nothing")
    with pytest.raises(RobotError, match=r"link '(port_)?rod'") as caught:
        described_parts(bench(tmp_path, rod), tmp_path)
    assert said in caught.value.message
