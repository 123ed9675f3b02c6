import json
from typing import Any

import httpx
import pytest

from app.distribution import Extra, installing, is_installed
from planner import Plan, load_garment
from tests.app.document_requests import planned
from tests.app.samples import towel
from tests.app.test_garbage import BODIES, assert_problem

pytestmark = pytest.mark.anyio

FILES = [
    "garment.json",
    "garment.svg",
    "garment.fold",
    "plan.json",
    "plan.csv",
    "sheet.pdf",
    "sheet.svg",
    "recording.html",
    "mp4",
    "gif",
    "picture.png",
    "mcap",
    "rosbag2",
    "poses.json",
    "poses.yaml",
    "glb",
    "mjcf",
    "usd",
    "lerobot",
]
OPTIONAL: dict[str, tuple[str, str, Extra]] = {"mp4": ("av", "PyAV", "video"), "usd": ("pxr", "usd-core", "usd")}
"""The module, library and extra of the files that few installations make."""

SVG = (
    b'<svg xmlns="http://www.w3.org/2000/svg" width="40cm" height="30cm" viewBox="0 0 40 30">'
    b'<rect width="40" height="30"/><line x1="40" y1="15" x2="0" y2="15" stroke="blue"/></svg>'
)
PX = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 30"><rect width="40" height="30"/></svg>'


async def imported(client: httpx.AsyncClient, data: bytes, **query: str | float) -> httpx.Response:
    return await client.post("/api/imports", params=query, content=data)


async def created(client: httpx.AsyncClient, **changes: Any) -> str:
    document_id: str = (await client.post("/api/documents", json={"garment": towel(**changes)})).json()["id"]
    return document_id


async def fetched(client: httpx.AsyncClient, document_id: str, what: str, query: str = "") -> httpx.Response:
    return await client.get(f"/api/documents/{document_id}/files/{what}{query}")


async def test_a_drawing_becomes_a_garment_that_can_be_opened(client: httpx.AsyncClient) -> None:
    answer = (await imported(client, SVG, filename="towel.svg")).json()
    assert answer["format"] == "svg"
    assert answer["garment"]["folds"][0]["name"] == "fold 1"
    assert all(note.endswith(".") for note in answer["notes"])
    (taken,) = (says for says in answer["says"] if says and says["code"] == "unit_taken")
    assert (taken["unit_m"], taken["is_said"]) == (pytest.approx(0.01), False)
    assert len(answer["says"]) == len(answer["notes"])
    state = await client.post("/api/documents", json={"garment": answer["garment"]})
    assert state.status_code == 201
    assert state.json()["problems"] == []


async def test_a_garment_file_comes_back_with_every_field(client: httpx.AsyncClient) -> None:
    data = json.dumps(towel()).encode()
    answer = (await imported(client, data, filename="C:\\mine\\towel.JSON")).json()
    assert answer["garment"]["grip_radius_m"] == 0.127
    assert answer["notes"] == []


async def test_without_units_the_problem_says_how_large_it_would_be(client: httpx.AsyncClient) -> None:
    problem = assert_problem(await imported(client, PX, filename="towel.svg"), 422)
    assert problem["errors"][0]["field"] == "units"
    assert problem["sizes"]["cm"] == pytest.approx([0.4, 0.3])
    again = await imported(client, PX, filename="towel.svg", units="cm", scale=2.0)
    assert again.json()["garment"]["outline"][2] == pytest.approx([0.8, 0.0])


@pytest.mark.parametrize(
    ("query", "field"),
    [
        ({}, "filename"),
        ({"filename": "towel.gif"}, "filename"),
        ({"filename": "towel.png"}, "file"),
        ({"filename": "towel.png", "like": "a-tent"}, "like"),
        ({"filename": "towel.jpg", "measured": "wide"}, "measured"),
        ({"filename": "towel"}, "filename"),
        ({"filename": ""}, "filename"),
        ({"filename": "x" * 301}, "filename"),
        ({"filename": "towel.svg", "units": "ell"}, "units"),
        ({"filename": "towel.svg", "scale": 0}, "scale"),
        ({"filename": "towel.svg", "scale": "nan"}, "scale"),
        ({"filename": "towel.svg", "scale": 1000}, "scale"),
        ({"filename": "towel.json"}, "file"),
        ({"filename": "towel.dxf"}, "file"),
    ],
)
async def test_what_cannot_be_imported_is_named(client: httpx.AsyncClient, query: dict[str, Any], field: str) -> None:
    problem = assert_problem(await imported(client, SVG, **query), 422)
    assert problem["errors"][0]["field"] == field


@pytest.mark.parametrize("filename", ["a.json", "a.svg", "a.dxf"])
@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES.keys())
async def test_rubbish_is_a_problem_whatever_it_is_called(
    client: httpx.AsyncClient, filename: str, body: bytes
) -> None:
    assert assert_problem(await imported(client, body, filename=filename), 422)["errors"]


async def test_a_wrong_garment_file_names_the_garments_field(client: httpx.AsyncClient) -> None:
    data = json.dumps(towel(outline=[[0, 0], [0.3, 0], [0, 0.3], [0.3, 0.3]])).encode()
    problem = assert_problem(await imported(client, data, filename="towel.json"), 422)
    assert problem["errors"][0]["field"] == "outline[3]"


async def test_an_outline_that_crosses_itself_is_said_to_with_the_place(client: httpx.AsyncClient) -> None:
    data = SVG.replace(b'<rect width="40" height="30"/>', b'<polygon points="0 0 30 0 0 30 30 30 30 20"/>')
    problem = assert_problem(await imported(client, data, filename="towel.svg"), 422)
    assert "cross at" in problem["detail"]


async def test_more_than_two_mebibytes_are_too_large(client: httpx.AsyncClient) -> None:
    problem = assert_problem(await imported(client, b"x" * ((2 << 20) + 1), filename="a.svg"), 413)
    assert "2 MiB" in problem["detail"]


async def test_all_files_of_a_planned_document_can_be_saved(client: httpx.AsyncClient) -> None:
    document_id = await planned(client)
    entries = (await client.get(f"/api/documents/{document_id}/files")).json()
    assert [entry["what"] for entry in entries] == FILES
    for entry in entries:
        optional = OPTIONAL.get(entry["what"])
        if optional and not is_installed(optional[0]):
            _, library, extra = optional
            says = {"code": "library_missing", "library": library, "install": installing(extra)}
            assert (entry["available"], entry["says"]) == (False, says)
            continue
        assert (entry["available"], entry["reason"]) == (True, None)
        query = "?rate_hz=1" if entry["what"] in ("recording.html", "mp4", "gif") else ""
        answer = await fetched(client, document_id, entry["what"], query)
        assert answer.status_code == 200
        assert answer.headers["content-type"] == entry["media_type"]
        assert answer.headers["content-disposition"] == f'attachment; filename="{entry["filename"]}"'
        assert answer.content
    names = [entry["filename"] for entry in entries]
    assert names[:2] == ["my-towel.json", "my-towel.svg"]
    assert len(set(names)) == len(names)


async def test_what_is_saved_is_what_the_document_has(client: httpx.AsyncClient) -> None:
    document_id = await planned(client)
    state = (await client.get(f"/api/documents/{document_id}")).json()
    assert (await fetched(client, document_id, "garment.json")).json() == state["garment"]
    drawing = (await fetched(client, document_id, "garment.svg")).content
    again = (await imported(client, drawing, filename="towel.svg")).json()["garment"]
    assert again["folds"] == state["garment"]["folds"]
    saved = (await fetched(client, document_id, "plan.json")).json()
    plan = Plan.from_dict(saved)
    assert (plan.to_dict(), plan.garment.to_dict()) == (saved, state["garment"])


async def test_an_unfinished_drawing_has_no_files_and_says_why(client: httpx.AsyncClient) -> None:
    document_id = (await client.post("/api/documents", json={})).json()["id"]
    for entry in (await client.get(f"/api/documents/{document_id}/files")).json():
        assert not entry["available"]
        problem = assert_problem(await fetched(client, document_id, entry["what"]), 409)
        assert problem["detail"] == entry["reason"]
        assert "not finished" in problem["detail"]


async def test_while_a_fold_is_wrong_the_garment_can_be_saved_with_it(client: httpx.AsyncClient) -> None:
    fold = {"name": "short", "kind": "blue", "start": [0.1, 0.0], "end": [0.1, 0.1], "grip_radius_m": 0.127}
    garment = towel(folds=[fold])
    document_id = (await client.post("/api/documents", json={"garment": garment})).json()["id"]
    entries = (await client.get(f"/api/documents/{document_id}/files")).json()
    assert [entry["what"] for entry in entries if entry["available"]] == ["garment.json", "garment.svg"]
    saved = await fetched(client, document_id, "garment.json")
    assert saved.json()["folds"] == [fold]
    again = await imported(client, saved.content, filename="a.json")
    assert again.json()["garment"] == saved.json()
    assert_problem(await fetched(client, document_id, "garment.fold"), 409)
    drawing = await fetched(client, document_id, "garment.svg")
    assert (await imported(client, drawing.content, filename="a.svg")).json()["garment"]["folds"] == [fold]


async def test_an_outline_that_crosses_itself_can_not_be_saved(client: httpx.AsyncClient) -> None:
    document_id = await created(client)
    state = (await client.get(f"/api/documents/{document_id}")).json()
    outline = state["drawing"]["outline"]
    outline[0]["point"], outline[1]["point"] = outline[1]["point"], outline[0]["point"]
    body = {"base_version": state["version"], "label": "Cross", "drawing": state["drawing"]}
    await client.put(f"/api/documents/{document_id}/drawing", json=body)
    problem = assert_problem(await fetched(client, document_id, "garment.json"), 409)
    assert "cross" in problem["detail"]


async def test_the_cloth_that_fold_lines_are_read_on_can_be_chosen(client: httpx.AsyncClient) -> None:
    flat = SVG.replace(b"</svg>", b'<line x1="30" y1="0" x2="30" y2="30" stroke="blue"/></svg>')
    answer = (await imported(client, flat, filename="towel.svg")).json()
    assert (answer["creases"], answer["sizes"]["cm"]) == ("flat", pytest.approx([0.4, 0.3]))
    chosen = (await imported(client, flat, filename="towel.svg", creases="folded")).json()
    assert chosen["creases"] == "folded"
    assert chosen["garment"]["folds"] != answer["garment"]["folds"]
    assert_problem(await imported(client, flat, filename="towel.svg", creases="damp"), 422)


async def test_the_size_of_a_graded_pattern_can_be_chosen(client: httpx.AsyncClient) -> None:
    rects = "".join(
        f'<g id="{size}"><rect x="{-by}" y="{-by}" width="{40 + 2 * by}" height="{30 + 2 * by}" stroke="black"/></g>'
        for by, size in enumerate(("S", "M", "L"))
    )
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="50cm" height="40cm" viewBox="-5 -5 50 40">'
    data = f"{head}{rects}</svg>".encode()
    answer = (await imported(client, data, filename="back.svg")).json()
    assert answer["graded"] == {"size": "M", "sizes": ["S", "M", "L"]}
    assert {"code": "graded_sizes", "size": "M", "sizes": ["S", "M", "L"]} in answer["says"]
    small = (await imported(client, data, filename="back.svg", size="S")).json()
    assert small["sizes"]["cm"] == pytest.approx([0.4, 0.3])
    problem = assert_problem(await imported(client, data, filename="back.svg", size="XXL"), 422)
    assert problem["errors"][0]["field"] == "size"
    assert "S, M, L" in problem["errors"][0]["message"]
    assert problem["errors"][0]["says"]["sizes"] == ["S", "M", "L"]


async def test_a_piece_of_a_pattern_can_be_chosen(client: httpx.AsyncClient) -> None:
    rects = '<rect id="back" width="40" height="30"/><rect id="pocket" x="45" width="12" height="10"/>'
    data = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="60cm" height="40cm" viewBox="0 0 60 40">{rects}</svg>'.encode()
    )
    answer = (await imported(client, data, filename="back.svg")).json()
    assert answer["pieces"] == {"piece": "back", "pieces": ["back", "pocket"]}
    assert {"code": "pieces", "piece": "back", "pieces": ["back", "pocket"]} in answer["says"]
    pocket = (await imported(client, data, filename="back.svg", piece="pocket")).json()
    assert pocket["sizes"]["cm"] == pytest.approx([0.12, 0.1])
    problem = assert_problem(await imported(client, data, filename="back.svg", piece="front"), 422)
    assert problem["errors"][0]["field"] == "piece" and "back, pocket" in problem["errors"][0]["message"]


async def test_the_card_of_a_robot_is_said_to_be_that(client: httpx.AsyncClient) -> None:
    content = json.dumps({"pleat_robot": 1, "name": "bench"}).encode()
    problem = assert_problem(await imported(client, content, filename="a.json"), 422)
    (error,) = problem["errors"]
    assert error["field"] == "file" and "robot" in error["message"] and error["says"]["code"] == "robot_card_file"


async def test_without_a_plan_there_is_its_reason_but_no_table_and_no_recording(client: httpx.AsyncClient) -> None:
    # Far beside the table.
    document_id = await planned(client, placement={"x_m": 5.0, "y_m": 0.0, "yaw_rad": 0.0})
    assert (await fetched(client, document_id, "garment.svg")).status_code == 200
    assert (await fetched(client, document_id, "plan.json")).json()["status"] == "infeasible"
    for what in ("plan.csv", "recording.html"):
        problem = assert_problem(await fetched(client, document_id, what), 409)
        assert "nothing of the cloth lies on the table" in problem["detail"]


async def test_unknown_documents_and_files_are_not_found(client: httpx.AsyncClient) -> None:
    document_id = await created(client)
    for path in (f"{document_id}/files/garment.pdf", "nothere/files", "nothere/files/garment.svg"):
        assert_problem(await client.get(f"/api/documents/{path}"), 404)


@pytest.mark.parametrize("rate_hz", ["0", "31", "nan", "quick"])
async def test_a_recording_has_1_to_30_frames_a_second(client: httpx.AsyncClient, rate_hz: str) -> None:
    document_id = await created(client)
    problem = assert_problem(await fetched(client, document_id, "recording.html", f"?rate_hz={rate_hz}"), 422)
    assert problem["errors"][0]["field"] == "rate_hz"


async def test_every_shipped_garment_comes_back_from_its_own_file(client: httpx.AsyncClient) -> None:
    for name in ("t-shirt", "letter-towel"):
        document_id = (await client.post("/api/documents", json={"garment": name})).json()["id"]
        data = (await fetched(client, document_id, "garment.json")).content
        answer = (await imported(client, data, filename="a.json")).json()
        assert answer["garment"]["outline"] == [list(point) for point in load_garment(name).outline]
