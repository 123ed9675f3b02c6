"""Robots with changes of their cards, by name."""

import pytest

from planner import load_garment, make_plan
from planner.errors import RequestError
from planner.planning.robot_task import default_placement, default_scene, task_for
from planner.robots.known_robots import require_name
from planner.robots.load_robot import load_robot, robot_card_file
from planner.robots.varied_card import CHANGES_MAX, changed, split_changes


def test_a_changed_card_differs_in_the_fields_named_alone() -> None:
    name = changed("so101-pair", {"mounts.0.y_m": 0.2, "scene.table.height_m": 0.7})
    assert name == "so101-pair@mounts.0.y_m=0.2:scene.table.height_m=0.7"
    usual, other = robot_card_file("so101-pair").to_dict(), robot_card_file(name).to_dict()
    assert other["mounts"][0]["y_m"] == 0.2 and other["scene"]["table"]["height_m"] == 0.7
    other["mounts"][0]["y_m"] = usual["mounts"][0]["y_m"]
    other["scene"]["table"]["height_m"] = usual["scene"]["table"]["height_m"]
    assert other == usual
    assert default_scene(name).table.height_m == 0.7
    assert load_robot(name) is load_robot(name)
    roots = [arm.shoulder(0.0)[1] for arm in load_robot(name).prepare()]  # type: ignore[union-attr]
    assert roots[0] - load_robot("so101-pair").prepare()[0].shoulder(0.0)[1] == pytest.approx(0.05)  # type: ignore[union-attr]


def test_changes_add_up() -> None:
    name = changed(changed("pr2", {"scene.torso_m": 0.1}), {"scene.table.height_m": 0.7})
    assert split_changes(name) == ("pr2", (("scene.torso_m", "0.1"), ("scene.table.height_m", "0.7")))
    assert changed("pr2", {}) == "pr2"


def test_the_closed_form_stays_where_only_the_scene_changes() -> None:
    lower = changed("pr2", {"scene.table.height_m": 0.74})
    assert load_robot(lower) is load_robot("pr2")
    towel = load_garment("hand-towel")
    assert default_placement(towel, lower) == towel.placement
    plan = make_plan(task_for(towel, robot=lower))
    assert plan.scene.table.height_m == 0.74 and plan.is_solved
    assert plan.to_dict()["task"]["robot"] == lower


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("pr2@scene.table.height=0.7", "no field 'scene.table.height'"),
        ("pr2@mounts.7.y_m=0.7", "no field 'mounts.7.y_m'"),
        ("pr2@title.x=1", "no field 'title.x'"),
        ("pr2@scene.table.height_m", "no list of changes"),
        ("pr2@", "no list of changes"),
        ("pr2@scene.table.height_m=high", "is no JSON value"),
        ("pr2@scene.table.height_m=NaN", "scene.table.height_m"),
        ('pr2@scene.table.height_m="high"', "scene.table.height_m"),
        ('pr2@name="other"', "name is read-only"),
        ("r2d2@scene.torso_m=0.1", "there is no robot 'r2d2'"),
        ("pr2@" + ":".join(["scene.torso_m=0.1"] * (CHANGES_MAX + 1)), "changes 33 fields, 32 at most"),
    ],
)
def test_a_change_that_cannot_be_made_is_told_of(name: str, told: str) -> None:
    for read in (require_name, load_robot, robot_card_file):
        with pytest.raises(RequestError) as error:
            read(name)
        assert error.value.field == "robot"
        assert told in error.value.message
