"""The robot of a document: chosen as one step, with the scene, start and placement that suit it."""

import httpx
import numpy as np
import pytest

from app.api.commands import put_garment, put_robot
from app.document import Document
from app.drawing.draft import draft_of
from app.drawing.drawing_json import drawing_from_dict, drawing_to_dict
from app.drawing.garment_drawing import drawing_of, with_robot
from app.drawing.solve import solve
from planner import Scene, load_garment
from planner.errors import RequestError
from planner.geometry.pose import Pose2
from planner.planning.robot_task import INSIDE_M, task_for
from tests.app.document_requests import created, put
from tests.app.drawing.drawings import outlined, towel_drawing
from tests.app.test_garbage import assert_problem


@pytest.mark.anyio
async def test_another_robot_can_be_asked_for(client: httpx.AsyncClient) -> None:
    state = (await client.post("/api/documents", json={})).json()
    changed = (await client.put(f"/api/documents/{state['id']}/robot", json={"robot": "so101-pair"})).json()
    arms, mounts = ["left", "right"], [[0.0, 0.15], [0.0, -0.15]]
    robot = {"name": "so101-pair", "title": "Two SO-101", "arms": arms, "base": "fixed", "mounts": mounts}
    assert changed["robot"] == robot
    assert changed["drawing"]["robot"] == "so101-pair"
    assert changed["history"]["can_undo"] == "Fold with Two SO-101"


def test_another_robot_is_one_step_that_one_undo_takes_back() -> None:
    document = Document(draft_of(drawing_of(load_garment("hand-towel"))))
    before = document.state.drawing
    after = put_robot(document, "so101-pair").drawing
    assert after.robot == "so101-pair"
    assert after.scene != before.scene
    assert after.start_station != before.start_station
    assert after.placement != before.placement
    assert document.undo().drawing == before


def test_a_robot_that_folded_the_same_outline_before_finds_all_as_it_was() -> None:
    document = Document(draft_of(drawing_of(load_garment("t-shirt"))))
    before = document.state.drawing
    put_robot(document, "ur5e-pair")
    put_robot(document, "so101-pair")
    assert put_robot(document, "pr2").drawing == before
    put_robot(document, "ur5e-pair")
    put_garment(document, load_garment("tie"))
    assert put_robot(document, "pr2").drawing.placement != before.placement


@pytest.mark.anyio
async def test_the_robot_that_folds_already_is_no_step(client: httpx.AsyncClient) -> None:
    state = await created(client)
    same = (await client.put(f"/api/documents/{state['id']}/robot", json={"robot": "pr2"})).json()
    assert same == state


@pytest.mark.anyio
@pytest.mark.parametrize("name", ["robo-9000", "planner/robots/cards/pr2.json", ""])
async def test_a_robot_that_is_not_known_by_name_is_refused(client: httpx.AsyncClient, name: str) -> None:
    state = await created(client)
    refused = await client.put(f"/api/documents/{state['id']}/robot", json={"robot": name})
    assert assert_problem(refused, 422)["errors"][0]["field"] == "robot"
    drawn = await put(client, state, {**state["drawing"], "robot": name})
    assert assert_problem(drawn, 422)["errors"][0]["field"] == "drawing.robot"


@pytest.mark.anyio
async def test_a_robot_chosen_for_an_old_version_is_a_conflict(client: httpx.AsyncClient) -> None:
    state = await created(client)
    wanted = {"robot": "so101-pair", "base_version": state["version"] + 1}
    assert_problem(await client.put(f"/api/documents/{state['id']}/robot", json=wanted), 409)


def test_another_garment_lies_on_the_table_of_the_robot_that_folds() -> None:
    document = Document(draft_of(drawing_of(load_garment("hand-towel"))))
    put_robot(document, "ur5e-pair")
    opened = put_garment(document, load_garment("tie")).drawing
    assert opened.robot == "ur5e-pair"
    assert opened.placement == task_for(load_garment("tie"), robot="ur5e-pair").start.placement


def test_a_document_asks_what_the_planner_asks_for_the_robot() -> None:
    towel = load_garment("hand-towel")
    drawing = with_robot(solve(drawing_of(towel)), "so101-pair")
    task = Document(draft_of(drawing)).state.task
    assert task is not None
    asked = task_for(towel, robot="so101-pair", comfort_radius_m=drawing.comfort_radius_m)
    assert (task.robot, task.scene, task.start) == (asked.robot, asked.scene, asked.start)


def test_back_at_the_default_robot_the_cloth_lies_at_its_near_edge() -> None:
    there = with_robot(solve(drawing_of(load_garment("hand-towel"))), "so101-pair")
    back = with_robot(solve(there), "pr2")
    corners = back.placement.to_outer(np.array(back.points)).tolist()
    assert back.scene == Scene()
    assert min(x for x, _ in corners) == pytest.approx(-Scene().table.depth_m / 2 + INSIDE_M)
    assert min(y for _, y in corners) == pytest.approx(-max(y for _, y in corners))


def test_an_unfinished_outline_goes_to_where_the_card_has_garments_lie() -> None:
    drawing = outlined(towel_drawing())
    assert with_robot(solve(drawing), "so101-pair").placement == Pose2(-0.04, 0.0, 0.0)


def test_a_drawing_keeps_its_robot_and_one_without_is_of_the_pr2() -> None:
    drawing = with_robot(solve(towel_drawing()), "ur5e-single")
    data = drawing_to_dict(drawing)
    assert drawing_from_dict(data) == drawing
    del data["robot"]
    assert drawing_from_dict(data).robot == "pr2"
    with pytest.raises(RequestError):
        drawing_from_dict({**data, "robot": 7})
