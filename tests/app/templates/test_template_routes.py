from typing import Any

import httpx
import pytest

from tests.app.test_garbage import BODIES, assert_problem

pytestmark = pytest.mark.anyio

NAMES = ["t-shirt", "vest", "shirt", "trousers", "skirt", "towel", "scarf", "tie", "round"]


async def test_the_templates_are_listed_with_their_measures_and_what_they_make(client: httpx.AsyncClient) -> None:
    templates = (await client.get("/api/templates")).json()
    assert [template["name"] for template in templates] == NAMES
    shirt = templates[0]
    assert shirt["measures"][0] == {
        "name": "width_m",
        "label": "Width",
        "text": "from armpit to armpit",
        "default_m": 0.457,
        "min_m": 0.001,
        "max_m": 10.0,
    }
    assert len(shirt["outline"]) == 10
    assert [fold["kind"] for fold in shirt["folds"]] == ["blue"] * 5


@pytest.mark.parametrize("name", NAMES)
async def test_what_a_template_makes_can_be_opened(client: httpx.AsyncClient, name: str) -> None:
    made = (await client.post(f"/api/templates/{name}", json={})).json()
    state = (await client.post("/api/documents", json={"garment": made["garment"]})).json()
    assert state["problems"] == []
    assert len(state["steps"]) == len(made["garment"]["folds"]) + 1


async def test_what_follows_a_measure_is_told_and_what_does_not_go_together_has_its_numbers(
    client: httpx.AsyncClient,
) -> None:
    made = (await client.post("/api/templates/towel", json={"measures": {"width_m": 1.372}})).json()
    assert made["measures"] == pytest.approx({"width_m": 1.372, "length_m": 0.419, "folded_width_m": 0.596})
    wanted = {"measures": {"width_m": 0.9, "folded_width_m": 0.25}}
    (error,) = assert_problem(await client.post("/api/templates/towel", json=wanted), 422)["errors"]
    assert error["says"] == {
        "code": "measure_too_small",
        "label": "folded width",
        "value_m": 0.25,
        "than_m": 0.9 / 3,
        "what": "a third of the width, or the sides would stick out",
        "by_m": 0.0,
    }


async def test_measures_and_a_title_are_taken(client: httpx.AsyncClient) -> None:
    wanted = {"measures": {"width_m": 0.3, "length_m": 1}, "title": "Mine"}
    garment = (await client.post("/api/templates/scarf", json=wanted)).json()["garment"]
    assert garment["title"] == "Mine"
    assert garment["outline"] == [[0.0, 0.0], [0.3, 0.0], [0.3, 1.0], [0.0, 1.0]]
    assert (await client.post("/api/templates/scarf")).status_code == 200


@pytest.mark.parametrize(
    ("body", "field"),
    [
        ({"measures": {"width_m": 12}}, "measures.width_m"),
        ({"measures": {"width_m": "0.3"}}, "measures.width_m"),
        ({"measures": {"width_m": None}}, "measures.width_m"),
        ({"measures": {"sleeve_m": 0.3}}, "measures.sleeve_m"),
        ({"measures": {"width_m": 0.0}}, "measures.width_m"),
        ({"measures": 3}, "measures"),
        ({"sizes": {}}, "sizes"),
        ({"title": "x" * 201}, "title"),
    ],
)
async def test_a_wrong_measure_is_named(client: httpx.AsyncClient, body: dict[str, Any], field: str) -> None:
    problem = assert_problem(await client.post("/api/templates/scarf", json=body), 422)
    assert problem["errors"][0]["field"] == field


@pytest.mark.parametrize("body", [body for body in BODIES.values() if body], ids=[n for n, b in BODIES.items() if b])
async def test_rubbish_is_a_problem(client: httpx.AsyncClient, body: bytes) -> None:
    headers = {"content-type": "application/json"}
    assert_problem(await client.post("/api/templates/scarf", content=body, headers=headers), 422)


async def test_an_unknown_template_is_not_found(client: httpx.AsyncClient) -> None:
    assert_problem(await client.post("/api/templates/cape", json={}), 404)
