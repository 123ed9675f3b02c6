import httpx
import pytest

from app.store.schema import GarmentRow
from app.workspace import Workspace
from tests.app.samples import towel

pytestmark = pytest.mark.anyio

SHIPPED = {"t-shirt", "jeans", "shirt", "tie", "scarf", "vest", "skirt", "big-towel", "hand-towel"}


async def test_health_names_the_version(client: httpx.AsyncClient) -> None:
    answer = await client.get("/api/health")
    assert answer.status_code == 200
    assert answer.json()["status"] == "ok"
    assert isinstance(answer.json()["version"], str)


async def test_the_shipped_garments_are_listed(client: httpx.AsyncClient) -> None:
    entries = (await client.get("/api/garments")).json()
    assert {entry["name"] for entry in entries} >= SHIPPED
    assert all(entry["shipped"] is True and entry["title"] for entry in entries)


async def test_a_garment_comes_with_every_field(client: httpx.AsyncClient) -> None:
    garment = (await client.get("/api/garments/t-shirt")).json()
    fields = {"name", "title", "outline", "areal_density_kg_m2", "thickness_m", "folds", "grip_radius_m", "placement"}
    assert set(garment) == fields
    assert all("grip_radius_m" in fold for fold in garment["folds"])


async def test_a_saved_garment_can_be_read_replaced_and_removed(client: httpx.AsyncClient) -> None:
    path = "/api/garments/my-towel"
    assert (await client.put(path, json=towel())).status_code == 201
    assert (await client.put(path, json=towel(title="Blue"))).status_code == 200
    assert (await client.get(path)).json()["title"] == "Blue"
    entries = (await client.get("/api/garments")).json()
    assert {"name": "my-towel", "title": "Blue", "shipped": False} in entries
    assert (await client.delete(path)).status_code == 204
    assert (await client.get(path)).status_code == 404
    assert "my-towel" not in (await client.get("/api/garments")).text


async def test_shipped_garments_are_read_only(client: httpx.AsyncClient) -> None:
    for answer in (
        await client.put("/api/garments/t-shirt", json=towel("t-shirt")),
        await client.delete("/api/garments/t-shirt"),
    ):
        assert answer.status_code == 409
        assert answer.headers["content-type"] == "application/problem+json"


async def test_a_body_with_another_name_is_refused(client: httpx.AsyncClient) -> None:
    answer = await client.put("/api/garments/other", json=towel())
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["field"] == "name"


@pytest.mark.parametrize(
    ("content", "said"), [(b'{"pattern": {"panels": {}}}', "a pattern of GarmentCode"), (b"<svg/>", "an SVG drawing")]
)
async def test_a_body_of_another_kind_is_named_with_where_it_can_be_opened(
    client: httpx.AsyncClient, content: bytes, said: str
) -> None:
    answer = await client.put("/api/garments/other", content=content, headers={"content-type": "application/json"})
    assert answer.status_code == 422
    assert said in answer.json()["detail"]
    assert "POST /api/imports" in answer.json()["detail"]


@pytest.mark.parametrize("name", ["nothing", "UPPER", "..%2fsettings", "%00", "a" * 70, ".hidden"])
async def test_a_name_that_is_not_there_is_not_found(client: httpx.AsyncClient, name: str) -> None:
    for answer in (await client.get(f"/api/garments/{name}"), await client.delete(f"/api/garments/{name}")):
        assert answer.status_code == 404
        assert answer.headers["content-type"] == "application/problem+json"


async def test_a_spoilt_garment_does_not_spoil_the_list(client: httpx.AsyncClient) -> None:
    workspace: Workspace = client._transport.app.state.workspace  # type: ignore[attr-defined]
    with workspace.database.writing("try") as session:
        session.add(GarmentRow(name="spoilt", content="{"))
    assert (await client.get("/api/garments")).status_code == 200
    assert (await client.get("/api/garments/spoilt")).status_code == 422


async def test_the_default_scene_has_five_stations(client: httpx.AsyncClient) -> None:
    scene = (await client.get("/api/scene")).json()
    assert set(scene["stations"]) == {"front", "front_left", "left", "front_right", "right"}
    assert scene["table"] == {"depth_m": 1.6, "width_m": 0.98, "height_m": 0.79}


async def test_the_description_and_its_page_load_nothing_from_elsewhere(client: httpx.AsyncClient) -> None:
    page = await client.get("/docs")
    assert page.status_code == 200
    assert "http://" not in page.text
    assert "https://" not in page.text
    description = (await client.get("/openapi.json")).json()
    assert {"/api/plans", "/api/dag", "/api/garments/{name}", "/api/plans/{plan_id}/timeline"} <= set(
        description["paths"]
    )
    assert "comfort_radius_m" in str(description["paths"]["/api/plans"]["post"]["requestBody"])
