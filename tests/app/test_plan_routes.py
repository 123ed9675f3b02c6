import asyncio

import httpx
import pytest

from tests.app.samples import towel
from tests.patience import wait_until

pytestmark = pytest.mark.anyio


async def test_a_plan_has_every_field_and_can_be_read_again(client: httpx.AsyncClient) -> None:
    answer = await client.post("/api/plans", json={"garment": towel()})
    assert answer.status_code == 200
    plan = answer.json()
    assert plan["status"] == "solved"
    assert set(plan) == {
        "id",
        "status",
        "cost_s",
        "primitives",
        "dag",
        "final_layers",
        "final_placement",
        "reasons",
        "statistics",
    }
    assert (await client.get(f"/api/plans/{plan['id']}")).json() == plan


async def test_what_was_asked_before_is_not_searched_again_unless_less_time_is_given(client: httpx.AsyncClient) -> None:
    first, again, in_less = [
        (await client.post("/api/plans", json={"garment": towel(), "time_limit_s": limit_s})).json()
        for limit_s in (20.0, 30.0, 0.01)
    ]
    assert again["id"] != first["id"]
    assert again["statistics"]["search_time_s"] == first["statistics"]["search_time_s"]
    assert again == first | {"id": again["id"]}
    assert in_less["statistics"]["search_time_s"] != first["statistics"]["search_time_s"]


async def test_the_timeline_ends_exactly_at_the_cost(client: httpx.AsyncClient) -> None:
    plan = (await client.post("/api/plans", json={"garment": towel()})).json()
    timeline = (await client.get(f"/api/plans/{plan['id']}/timeline", params={"rate_hz": 7})).json()
    assert timeline["rate_hz"] == 7
    times = [sample["t_s"] for sample in timeline["samples"]]
    assert times[0] == 0.0
    assert times[-1] == plan["cost_s"]
    assert times == sorted(set(times))
    assert {"base", "torso_m", "joints", "grippers_m", "primitive"} <= set(timeline["samples"][0])
    assert len(timeline["samples"][0]["joints"]) == 20


async def test_pictures_show_cloth_and_base_before_each_step_and_at_the_end(client: httpx.AsyncClient) -> None:
    plan = (await client.post("/api/plans", json={"garment": towel()})).json()
    pictures = (await client.get(f"/api/plans/{plan['id']}/pictures")).json()
    assert len(pictures) == len(plan["primitives"]) + 1
    assert [len(picture["layers"]) for picture in (pictures[0], pictures[-1])] == [1, 2]
    assert pictures[-1]["layers"] == plan["final_layers"]
    assert pictures[-1]["placement"] == plan["final_placement"]
    assert pictures[-1]["base"] == plan["primitives"][-1]["base"]
    assert (await client.get("/api/plans/unknown/pictures")).status_code == 404


@pytest.mark.parametrize("rate", ["0", "0.5", "201", "nan", "inf", "many", "", "-1"])
async def test_a_rate_out_of_range_names_the_parameter(client: httpx.AsyncClient, rate: str) -> None:
    plan = (await client.post("/api/plans", json={"garment": towel()})).json()
    answer = await client.get(f"/api/plans/{plan['id']}/timeline", params={"rate_hz": rate})
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["field"] == "rate_hz"


async def test_a_garment_far_off_has_no_plan_and_no_timeline(client: httpx.AsyncClient) -> None:
    far = {"x_m": 0.4, "y_m": 0.2, "yaw_rad": -1.5707963267948966}
    scene = {"stations": {"front": {"x_m": -0.95, "y_m": 0.0, "yaw_rad": 0.0}}, "back_off_max_m": 0.0}
    answer = await client.post("/api/plans", json={"garment": towel(), "placement": far, "scene": scene})
    plan = answer.json()
    assert answer.status_code == 200
    assert plan["status"] == "infeasible"
    assert plan["primitives"] == []
    assert plan["cost_s"] is plan["final_placement"] is plan["statistics"]["bound_s"] is None
    assert plan["reasons"]
    assert plan["final_layers"]
    assert (await client.get(f"/api/plans/{plan['id']}/timeline")).status_code == 409


async def test_without_folds_there_is_nothing_to_do_and_one_moment_of_it(client: httpx.AsyncClient) -> None:
    plan = (await client.post("/api/plans", json={"garment": towel(folds=[])})).json()
    assert plan["status"] == "solved"
    assert plan["cost_s"] == 0.0
    timeline = (await client.get(f"/api/plans/{plan['id']}/timeline")).json()
    assert [sample["t_s"] for sample in timeline["samples"]] == [0.0]


@pytest.mark.parametrize("budget", [{"max_expanded": 1}, {"time_limit_s": 0.01}])
async def test_an_exhausted_budget_is_an_answer(client: httpx.AsyncClient, budget: dict[str, float]) -> None:
    answer = await client.post("/api/plans", json={"garment": "shirt", **budget})
    assert answer.status_code == 200
    assert answer.json()["status"] == "budget_exceeded"
    assert answer.json()["cost_s"] is None
    assert answer.json()["final_layers"]


async def test_unknown_plans_are_not_found(client: httpx.AsyncClient) -> None:
    assert (await client.get("/api/plans/nothing")).status_code == 404
    assert (await client.get("/api/plans/nothing/timeline")).status_code == 404


async def test_the_fold_dag_of_the_t_shirt_is_the_papers(client: httpx.AsyncClient) -> None:
    answer = (await client.post("/api/dag", json={"garment": "t-shirt"})).json()
    assert answer["folds"] == 5
    assert sorted(map(tuple, answer["edges"])) == [(0, 2), (1, 3), (2, 4), (3, 4)]
    assert set(answer["layers"][0]) == {"polygon", "face"}


async def test_requests_are_answered_while_a_search_runs(client: httpx.AsyncClient) -> None:
    search = asyncio.create_task(client.post("/api/plans", json={"garment": "shirt"}))
    lanes = client._transport.app.state.workspace.lanes  # type: ignore[attr-defined]
    await asyncio.to_thread(wait_until, lambda: lanes.load()["searches"][1] > 0)
    assert (await client.get("/api/health")).status_code == 200
    assert (await search).status_code == 200
