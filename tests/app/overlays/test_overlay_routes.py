import math
from typing import Any

import httpx
import numpy as np
import pytest
import shapely

from tests.app.document_requests import planned
from tests.app.samples import towel
from tests.app.test_garbage import assert_problem

pytestmark = pytest.mark.anyio

PARTS = ["reach", "slip", "base", "paths"]


async def created(client: httpx.AsyncClient, **changes: Any) -> str:
    document_id: str = (await client.post("/api/documents", json={"garment": towel(**changes)})).json()["id"]
    return document_id


async def overlays(client: httpx.AsyncClient, document_id: str, query: str = "") -> dict[str, Any]:
    answer = await client.get(f"/api/documents/{document_id}/overlays{query}")
    assert answer.status_code == 200, answer.text
    told: dict[str, Any] = answer.json()
    return told


def area(region: dict[str, Any]) -> float:
    def within(ring: list[list[float]]) -> float:
        return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(ring, [*ring[1:], ring[0]], strict=True)) / 2

    return within(region["outer"]) - sum(abs(within(hole)) for hole in region["holes"])


async def test_a_moment_of_the_plan_has_all_overlays(client: httpx.AsyncClient) -> None:
    document_id = await planned(client)
    told = await overlays(client, document_id, "?t_s=0")
    assert (told["t_s"], told["primitive"], told["done"], told["fold_step"]) == (0.0, 0, [], 0)
    assert all(told[part] is not None for part in PARTS)
    assert [arm["arm"] for arm in told["reach"]] == ["left", "right"]
    later = await overlays(client, document_id, "?t_s=1e6")
    assert (later["done"], later["fold_step"]) == ([0], 1)


async def test_reach_is_on_the_table_counter_clockwise_and_larger_without_comfort(client: httpx.AsyncClient) -> None:
    told = await overlays(client, await created(client), "?station=front")
    table = np.array(told["table"])
    assert area({"outer": table.tolist(), "holes": []}) == pytest.approx(1.6 * 0.98)
    low, high = table.min(axis=0) - 1e-6, table.max(axis=0) + 1e-6
    for arm in told["reach"]:
        with_comfort, bare = (sum(area(region) for region in arm[name]) for name in ("regions", "bare"))
        assert 0.2 < with_comfort < bare
        for region in arm["regions"] + arm["bare"]:
            assert area(region) > 0.0
            assert np.all((np.array(region["outer"]) >= low) & (np.array(region["outer"]) <= high))


async def test_the_left_arm_reaches_more_on_the_left_as_the_robot_sees_it(client: httpx.AsyncClient) -> None:
    told = await overlays(client, await created(client), "?station=front&show=reach")
    pose = told["robot"]["pose"]
    left = (-math.sin(pose["yaw_rad"]), math.cos(pose["yaw_rad"]))
    sideways = {}
    for arm in told["reach"]:
        regions = [shapely.Polygon(region["outer"], region["holes"]) for region in arm["regions"]]
        middle = shapely.union_all(regions).centroid
        sideways[arm["arm"]] = left[0] * (middle.x - pose["x_m"]) + left[1] * (middle.y - pose["y_m"])
    assert sideways["left"] > 0.01
    assert sideways["right"] < -0.01


async def test_a_station_can_be_asked_for_without_a_plan(client: httpx.AsyncClient) -> None:
    document_id = await created(client)
    told = await overlays(client, document_id, "?station=left&back_off_m=0.2&show=reach,slip")
    assert (told["robot"]["station"], told["robot"]["back_off_m"]) == ("left", 0.2)
    assert told["plan_version"] is told["t_s"] is told["base"] is told["paths"] is None
    # The garment's x is the table's -y, its y the table's x - 0.7 ... so `left`, at (0.45, 0.64 + 0.2), is seen at:
    assert [told["robot"]["pose"][name] for name in ("x_m", "y_m")] == pytest.approx([0.2 - 0.84, 0.45 + 0.7])


async def test_parts_not_asked_for_are_null(client: httpx.AsyncClient) -> None:
    told = await overlays(client, await created(client), "?station=front&show=slip")
    assert [told[part] is None for part in PARTS] == [True, False, True, True]


async def test_without_an_outline_there_is_nothing_to_lay_over(client: httpx.AsyncClient) -> None:
    document_id = (await client.post("/api/documents", json={})).json()["id"]
    for method, path in (("GET", "overlays"), ("GET", "overlays?station=left"), ("POST", "overlays/places")):
        assert_problem(await client.request(method, f"/api/documents/{document_id}/{path}"), 409)


@pytest.mark.parametrize(
    ("query", "field"),
    [
        ("t_s=-1", "t_s"),
        ("t_s=nan", "t_s"),
        ("t_s=soon", "t_s"),
        ("station=attic", "station"),
        ("station=left&back_off_m=2", "back_off_m"),
        ("station=left&back_off_m=nan", "back_off_m"),
        ("station=left&t_s=1", "station"),
        ("show=reach,roof", "show"),
    ],
)
async def test_what_is_asked_wrongly_is_named(client: httpx.AsyncClient, query: str, field: str) -> None:
    document_id = await created(client)
    problem = assert_problem(await client.get(f"/api/documents/{document_id}/overlays?{query}"), 422)
    assert problem["errors"][0]["field"] == field


async def test_a_lift_that_goes_nowhere_is_a_problem_of_the_scene(client: httpx.AsyncClient) -> None:
    document_id = await created(client)
    state = (await client.get(f"/api/documents/{document_id}")).json()
    drawing = {**state["drawing"], "scene": {"torso_m": 0.9}}
    body = {"base_version": state["version"], "label": "Lift", "drawing": drawing}
    await client.put(f"/api/documents/{document_id}/drawing", json=body)
    problem = assert_problem(await client.get(f"/api/documents/{document_id}/overlays?station=front"), 422)
    assert problem["errors"][0]["field"] == "scene.torso_m"


async def test_the_map_of_places_says_where_the_garment_would_come(client: httpx.AsyncClient) -> None:
    document_id = await created(client)
    wanted = {"step_m": 0.4, "time_limit_s": 20}
    found = (await client.post(f"/api/documents/{document_id}/overlays/places", json=wanted)).json()
    here = next(cell for cell in found["cells"] if cell["move"] == pytest.approx([0.0, 0.0]))
    assert here["placement"] == pytest.approx(towel()["placement"])
    assert here["cost_s"] == pytest.approx(9.0)  # a fold, and no driving
    assert found["best"]["cost_s"] == min(cell["cost_s"] for cell in found["cells"] if cell["cost_s"] is not None)
    # Turned by -90 degrees, the garment's y is the table's x: 0.4 m away along the table is (0, 0.4) on the garment.
    moves = {tuple(np.round(cell["move"], 6) + 0.0): cell["placement"] for cell in found["cells"]}
    assert moves[(0.0, 0.4)]["x_m"] == pytest.approx(towel()["placement"]["x_m"] + 0.4)


async def test_unknown_documents_are_not_found(client: httpx.AsyncClient) -> None:
    for method, path in (("GET", "overlays"), ("POST", "overlays/places")):
        assert_problem(await client.request(method, f"/api/documents/nothere/{path}"), 404)
