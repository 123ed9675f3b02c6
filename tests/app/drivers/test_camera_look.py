"""The step that a run goes on with, as a camera over the table shows it."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from app.cli import cli
from app.drivers.camera_look import step_seen
from app.drivers.driver import LostError
from app.rehearsal.camera.calibration import Calibration
from app.rehearsal.camera.camera import Camera
from app.rehearsal.camera.look import PLAIN
from app.rehearsal.camera.mounted import hung, overhead
from app.rehearsal.camera.picture import ClothSeen, picture
from app.rehearsal.camera.posture import Posture
from app.rehearsal.camera.robot_shape import robot_shape
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.vision.seen_state import see_state
from planner import Plan
from planner.geometry.woven_mesh import woven_mesh
from planner.robots.card import RobotCard
from planner.task.plan_files import write_plan
from planner.task.world_state import WorldState
from tests.required import required

LAYER_M = 0.002


def calibration(camera: Camera) -> Calibration:
    width, height = camera.size_px
    middle = ((width - 1) / 2.0, (height - 1) / 2.0)
    focal = (camera.focal_px, camera.focal_px)
    return Calibration((width, height), focal, middle, (0.0,) * 5, camera.position, camera.rotation, 0.1)


def seen(plan: Plan, card: RobotCard, world: WorldState) -> np.ndarray:
    """Return what the camera sees of the cloth, the arms at home."""
    table = plan.scene.table
    pattern, triangles = woven_mesh(plan.garment.pattern, 0.01)
    lies = planned_positions(plan.sequence, pattern, world.done, world.placement, table, LAYER_M)
    base = required(plan.trajectory).segment_at(0.0).base_at(0.0)
    parts = robot_shape(card, -table.height_m).parts(Posture(base, card.home_values(0.0)))
    cloth = ClothSeen(pattern, lies, triangles.astype(np.int64))
    return picture(hung(overhead(table)), table, cloth, parts, PLAIN, 0)


@pytest.mark.parametrize("step", [pytest.param(0, marks=pytest.mark.long), 1, pytest.param(2, marks=pytest.mark.long)])
def test_of_each_state_of_the_plan_the_camera_tells_the_step_that_is_next(
    plan: Plan, card: RobotCard, step: int
) -> None:
    assert len(plan.steps) == 2
    world = plan.state_after(step - 1)
    camera = calibration(hung(overhead(plan.scene.table)))
    found = step_seen(plan, seen(plan, card, world), camera, card.home_values(0.0))
    assert not world.held and found.step == step
    assert found.off_m < 0.006 and abs(found.turned_rad) < 0.03


def test_cloth_that_lies_elsewhere_ends_the_run(plan: Plan, card: RobotCard) -> None:
    start, joints = plan.task.start, card.home_values(0.0)
    moved = replace(start, placement=start.placement.moved(0.05, 0.0))
    with pytest.raises(LostError, match=r"the cloth lies \d\.\d cm beside and .* before step 0: move it, or plan anew"):
        step_seen(plan, seen(plan, card, moved), calibration(hung(overhead(plan.scene.table))), joints)


@pytest.mark.long
def test_cloth_that_is_none_of_the_states_ends_the_run(plan: Plan, card: RobotCard) -> None:
    start, joints = plan.task.start, card.home_values(0.0)
    crumpled = seen(plan, card, start)
    middle = hung(overhead(plan.scene.table)).pixels(
        np.array([[*start.placement.to_outer(np.array([0.1, 0.08])), 0.0]])
    )
    cv2.circle(crumpled, tuple(np.round(middle[0]).astype(int).tolist()), 90, (90, 90, 90), -1)
    with pytest.raises(LostError, match="the camera shows none of the plan's states"):
        step_seen(plan, crumpled, calibration(hung(overhead(plan.scene.table))), joints)


def test_a_run_whose_cloth_is_folded_already_is_done_without_a_motion(
    plan: Plan, card: RobotCard, tmp_path: Path
) -> None:
    files = {name: tmp_path / name for name in ("towel.plan.json", "now.png", "camera.json")}
    write_plan(plan, files["towel.plan.json"])
    cv2.imwrite(str(files["now.png"]), seen(plan, card, plan.end))
    files["camera.json"].write_text(calibration(hung(overhead(plan.scene.table))).file())
    told = ["run", str(files["towel.plan.json"]), "--auto", "--camera", str(files["now.png"])]
    result = CliRunner().invoke(cli, told)
    assert result.exit_code == 2 and "--camera and --calibration need each other" in result.stderr
    known = ["--calibration", str(files["camera.json"])]
    for source, why in (("63", "--camera: 63: the camera gives no picture"), ("missing.png", "No such file")):
        result = CliRunner().invoke(cli, [*told[:-1], source, *known])
        assert result.exit_code == 2 and why in result.stderr
    result = CliRunner().invoke(cli, [*told, *known])
    count = len(plan.steps)
    assert result.exit_code == 0, result.output
    assert f"Seen: step {count} of {count} is next" in result.stderr and f"Done: {count} of {count}" in result.stdout


@pytest.mark.long
def test_a_stack_on_the_table_is_compared_with_where_the_plan_has_it(plan: Plan) -> None:
    end, table = plan.end, plan.scene.table
    pattern, triangles = woven_mesh(plan.garment.pattern, 0.01)
    lies = end.placement.moved(0.006, 0.0)
    positions = planned_positions(plan.sequence, pattern, end.done, lies, table, LAYER_M)
    x_m, y_m, _ = positions.mean(axis=0).tolist()
    camera = hung(replace(overhead(table), x_m=x_m, y_m=y_m, z_m=0.35))
    image = picture(camera, table, ClothSeen(pattern, positions, triangles.astype(np.int64)), [], PLAIN, 0)
    _, png = cv2.imencode(".png", image)
    found = see_state(bytes(png), calibration(camera), plan.garment, plan)
    assert found.folds == (0, 1) and (found.frame, found.scale_from) == ("table", "camera")
    assert found.neatness.iou > 0.9
    assert required(found.neatness.off_m) == pytest.approx(0.006, abs=0.004)
