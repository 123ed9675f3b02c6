"""Robots of one's own over REST: imported, listed, planned for, replaced, removed, and refused."""

import json
import struct
import zipfile
from pathlib import Path

import httpx
import pytest

from app.files.robot_archive import DEPTH_MAX, FILES_MAX, UNPACKED_BYTES_MAX
from planner.robots.known_robots import shipped_card, shipped_robots
from planner.robots.load_robot import load_robot, prepare_robot, robot_card_file
from tests.app.robot_archives import BOX, archive, box_card, box_urdf
from tests.app.test_cli import pleat
from tests.app.test_job_routes import ended
from tests.app.test_robots import NAPKIN
from tests.robots.drafted import single_urdf

pytestmark = pytest.mark.anyio

IMPORTS = "/api/robots/imports"
STL = b"a mesh".ljust(80) + struct.pack("<I", 0)


def robot_files(**changes: object) -> dict[str | zipfile.ZipInfo, bytes | str]:
    return {"robot.json": json.dumps(box_card(**changes)), "urdf/box.urdf": box_urdf()}


async def refused(client: httpx.AsyncClient, body: bytes, data: Path) -> tuple[str, str]:
    """Return the field and the message for which an archive is refused; nothing of it is left on the disk."""
    answer = await client.post(IMPORTS, content=body)
    assert answer.status_code == 422, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    folder = data / "robots"
    assert not folder.exists() or list(folder.iterdir()) == []
    [error] = answer.json()["errors"]
    return error["field"], error["message"]


async def test_an_imported_robot_is_listed_read_replaced_and_removed(client: httpx.AsyncClient, tmp_path: Path) -> None:
    first = await client.post(IMPORTS, content=archive(robot_files()))
    entry = {"name": "bench", "title": "My bench", "arms": ["left", "right"], "base": "fixed", "shipped": False}
    assert (first.status_code, first.json()) == (201, entry)
    before = load_robot("bench")
    assert load_robot("bench") is before
    files = {f"mine/{name}": content for name, content in robot_files(title="Higher").items()}
    assert (await client.post(IMPORTS, content=archive(files))).status_code == 200
    assert (await client.get("/api/robots/bench")).json()["title"] == "Higher"
    assert [one["name"] for one in (await client.get("/api/robots")).json()] == [*shipped_robots(), "bench"]
    assert load_robot("bench").card.title == robot_card_file("bench").title == "Higher"
    assert sorted(path.name for path in (tmp_path / "robots").rglob("*")) == ["bench", "box.urdf", "robot.json", "urdf"]
    assert (await client.delete("/api/robots/bench")).status_code == 204
    assert (await client.get("/api/robots/bench")).status_code == 404
    assert (await client.delete("/api/robots/bench")).status_code == 404
    assert list((tmp_path / "robots").iterdir()) == []


async def test_a_robot_of_ones_own_is_planned_for_by_name_on_the_server_and_the_command_line(
    client: httpx.AsyncClient, tmp_path: Path
) -> None:
    card = shipped_card("so101-pair").to_dict() | {"name": "bench", "title": "My bench"}
    assert (await client.put("/api/robots/bench", json=card)).status_code == 201
    answer = await client.post("/api/plans", json={"garment": NAPKIN, "robot": "bench", "time_limit_s": 60})
    assert answer.json()["status"] == "solved" and answer.json()["primitives"][0]["base"]["station"] is None
    (tmp_path / "napkin.json").write_text(json.dumps(NAPKIN))
    result = pleat("plan", str(tmp_path / "napkin.json"), "--robot", "bench", "--data", str(tmp_path), "--json", "-")
    assert result.exit_code == 0, result.stderr
    assert json.loads(result.stdout)["cost_s"] == answer.json()["cost_s"]
    listed = json.loads(pleat("robots", "--data", str(tmp_path), "--json", "-").stdout)
    assert {entry["name"]: entry["shipped"] for entry in listed}["bench"] is False


async def test_a_document_outlives_the_robot_of_ones_own_that_folds_in_it(client: httpx.AsyncClient) -> None:
    card = shipped_card("ur5e-single").to_dict() | {"name": "bench", "title": "My bench"}
    await client.put("/api/robots/bench", json=card)
    path = f"/api/documents/{(await client.post('/api/documents', json={})).json()['id']}"
    chosen = (await client.put(f"{path}/robot", json={"robot": "bench"})).json()
    assert (chosen["robot"]["name"], chosen["robot"]["title"]) == ("bench", "My bench")
    assert (await client.delete("/api/robots/bench")).status_code == 204
    left = (await client.get(path)).json()
    assert left["drawing"]["robot"] == left["robot"]["name"] == "bench"
    drawing = left["drawing"] | {"comfort_radius_m": 0.02}
    edit = {"label": "Comfort", "base_version": left["version"], "drawing": drawing}
    changed = await client.put(f"{path}/drawing", json=edit)
    assert changed.status_code == 200, changed.text
    back = (await client.put(f"{path}/robot", json={"robot": "pr2"})).json()
    assert back["robot"]["title"] == "PR2"


async def test_a_card_that_is_saved_keeps_the_files_of_its_robot(client: httpx.AsyncClient) -> None:
    assert (await client.put("/api/robots/bench", json=box_card())).status_code == 422
    await client.post(IMPORTS, content=archive(robot_files()))
    assert load_robot("bench").card.title == "My bench"
    assert (await client.put("/api/robots/bench", json=box_card(title="Lower"))).status_code == 200
    assert load_robot("bench").card.title == "Lower"


async def test_a_card_of_another_name_or_of_a_shipped_robot_is_refused(client: httpx.AsyncClient) -> None:
    answer = await client.put("/api/robots/other", json=box_card())
    assert answer.status_code == 422 and answer.json()["errors"][0]["field"] == "name"
    card = shipped_card("so101-pair").to_dict()
    assert (await client.put("/api/robots/so101-pair", json=card)).status_code == 409
    assert (await client.delete("/api/robots/so101-pair")).status_code == 409
    taken = archive(robot_files(name="so101-pair"))
    assert (await client.post(IMPORTS, content=taken)).status_code == 409


@pytest.mark.parametrize(
    ("card", "urdf", "field", "told"),
    [
        ({}, box_urdf(f'<mesh filename="meshes/hand.stl"/>{""}'), "urdf", "there is no mesh 'meshes/hand.stl'"),
        ({}, box_urdf('<mesh filename="../../../secret.stl"/>'), "urdf", "leads out of the robot's folder"),
        ({}, box_urdf('<mesh filename="/etc/passwd"/>'), "urdf", "not given by a path within"),
        ({}, box_urdf(lower="nan"), "urdf", "limit has lower 'nan'"),
        ({}, box_urdf(before='<!DOCTYPE a [<!ENTITY b "c">]>'), "urdf", "entities"),
        ({}, box_urdf(last="hand"), "arms[0].joints[4]", "no moving joint 'left_wrist_roll'"),
        ({}, box_urdf().replace("gripper_frame_link", "tip_link"), "arms[0].tool.link", "'left_gripper_frame_link'"),
        ({"pleat_robot": 2}, box_urdf(), "pleat_robot", "is 2, this program reads 1"),
        ({"urdf": {"path": "arm.urdf"}}, box_urdf(), "urdf.path", "there is no file 'arm.urdf'"),
        ({"urdf": {"path": "../x.urdf"}}, box_urdf(), "urdf.path", "leads out"),
        ({"urdf": {"path": "/etc/passwd", "package": "numpy"}}, box_urdf(), "urdf.path", "leads out"),
        ({"urdf": {"path": "../numpy/x.urdf", "package": "numpy"}}, box_urdf(), "urdf.path", "leads out"),
        ({"name": ".new"}, box_urdf(), "name", ""),
    ],
)
async def test_a_robot_that_is_not_whole_is_refused_by_the_field(
    client: httpx.AsyncClient, tmp_path: Path, card: dict[str, object], urdf: str, field: str, told: str
) -> None:
    body = archive({"robot.json": json.dumps(box_card(**card)), "urdf/box.urdf": urdf})
    found, message = await refused(client, body, tmp_path)
    assert found == field and told in message


async def test_a_mesh_that_cannot_be_read_is_refused(client: httpx.AsyncClient, tmp_path: Path) -> None:
    urdf = box_urdf('<mesh filename="hand.stl"/>')
    files: dict[str, str | bytes] = {
        "robot.json": json.dumps(box_card()),
        "urdf/box.urdf": urdf,
        "urdf/hand.stl": STL,
    }
    assert (await refused(client, archive(files), tmp_path))[0] == "urdf"


def of_meshes(triangles: int, corners: bytes) -> bytes:
    """Return an archive of a robot of which three links have another mesh each, of so many equal triangles."""
    mesh = b"\0" * 80 + triangles.to_bytes(4, "little") + (corners.ljust(50, b"\0") * triangles)
    urdf = box_urdf()
    for number in range(3):
        urdf = urdf.replace(BOX, f'<mesh filename="{number}.stl"/>', 2)
    meshes = {f"urdf/{number}.stl": mesh for number in range(3)}
    return archive({"robot.json": json.dumps(box_card()), "urdf/box.urdf": urdf, **meshes})


@pytest.mark.parametrize(
    ("corners", "told"),
    [
        (b"", "has no triangles"),
        pytest.param(
            struct.pack("<11f", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1),
            "meshes before it; at most 1000000",
            marks=pytest.mark.long,
            id="too many",
        ),
    ],
)
async def test_meshes_of_too_many_triangles_together_or_of_no_size_are_refused(
    client: httpx.AsyncClient, tmp_path: Path, corners: bytes, told: str
) -> None:
    field, message = await refused(client, of_meshes(490_000, corners), tmp_path)
    assert field == "urdf" and told in message


def link_entry() -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo("urdf/link.urdf")
    entry.external_attr = 0o120777 << 16
    return entry


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ({"../escaped.txt": ""}, "leads out"),
        ({"/tmp/escaped.txt": ""}, "leads out"),
        ({"urdf\\..\\..\\escaped.txt": ""}, "leads out"),
        ({"c:escaped.txt": ""}, "leads out"),
        ({link_entry(): "/etc/passwd"}, "is a link"),
        ({"a/" * DEPTH_MAX + "x": ""}, "is no path that is taken"),
        ({"x" * 300: ""}, "is no path that is taken"),
        ({"URDF/box.urdf": ""}, "two files called"),
        ({"urdf/box.urdf/x": ""}, "below a file"),
    ],
)
async def test_an_archive_whose_paths_lead_elsewhere_is_refused(
    client: httpx.AsyncClient, tmp_path: Path, more: dict[str | zipfile.ZipInfo, str], told: str
) -> None:
    field, message = await refused(client, archive({**robot_files(), **more}), tmp_path)
    assert field == "file" and told in message


async def test_an_archive_that_gets_too_large_is_refused_before_it_is_unpacked(
    client: httpx.AsyncClient, tmp_path: Path
) -> None:
    part = b"\0" * (UNPACKED_BYTES_MAX // 4 + 1)
    bomb = archive({**robot_files(), **{f"{number}.bin": part for number in range(4)}})
    assert len(bomb) < 2_000_000
    assert "bytes unpacked" in (await refused(client, bomb, tmp_path))[1]
    many = archive({**robot_files(), **{f"{number}": b"" for number in range(FILES_MAX)}})
    assert "files" in (await refused(client, many, tmp_path))[1]


async def test_an_archive_that_lies_about_its_sizes_is_refused(client: httpx.AsyncClient, tmp_path: Path) -> None:
    whole = bytearray(archive({**robot_files(), "large.bin": b"\0" * 1_000_000}))
    at = whole.rindex(b"PK\x01\x02")
    struct.pack_into("<I", whole, at + 24, 10)
    assert (await refused(client, bytes(whole), tmp_path))[0] == "file"


@pytest.mark.parametrize("body", [b"", b"PK\x03\x04", b"PK\x05\x06" + b"\0" * 18, archive({"card.json": "{}"})])
async def test_what_is_no_archive_of_a_robot_is_refused(client: httpx.AsyncClient, tmp_path: Path, body: bytes) -> None:
    assert (await refused(client, body, tmp_path))[0] == "file"


async def test_a_robot_that_cannot_be_replaced_stays_as_it_was(client: httpx.AsyncClient) -> None:
    await client.post(IMPORTS, content=archive(robot_files()))
    bad = {"robot.json": json.dumps(box_card(title="Bad")), "urdf/box.urdf": box_urdf(BOX, lower="9")}
    assert (await client.post(IMPORTS, content=archive(bad))).status_code == 422
    assert (await client.get("/api/robots/bench")).json()["title"] == "My bench"


async def test_an_import_may_be_a_job_after_which_the_robot_is_there_and_mapped(
    client: httpx.AsyncClient, tmp_path: Path
) -> None:
    begun = await client.post(IMPORTS, content=archive(robot_files()), headers={"prefer": "respond-async"})
    assert (begun.status_code, begun.headers["preference-applied"]) == (202, "respond-async"), begun.text
    assert begun.json()["kind"] == "robots"
    assert (await client.get("/api/robots/bench")).status_code == 404, "it is not there before it is whole"
    job = await ended(client, begun.headers["location"])
    assert job["status"] == "done", job["message"]
    assert job["result"]["is_new"] is True and job["result"]["robot"]["name"] == "bench"
    assert sorted(path.name for path in (tmp_path / "robots").rglob("*")) == ["bench", "box.urdf", "robot.json", "urdf"]

    def mapped(_: float) -> None:
        raise AssertionError("its arms were to be mapped by the job")

    prepare_robot("bench", mapped)
    again = await client.post(IMPORTS, content=archive(robot_files()), headers={"prefer": "wait=5, respond-async"})
    assert (await ended(client, again.headers["location"]))["result"]["is_new"] is False


async def test_a_job_whose_archive_is_none_says_why_and_leaves_nothing(
    client: httpx.AsyncClient, tmp_path: Path
) -> None:
    bad = {"robot.json": json.dumps(box_card(title="Bad")), "urdf/box.urdf": box_urdf(BOX, lower="9")}
    for body, why in ((b"no archive", "archive"), (archive(bad), "shoulder")):
        begun = await client.post(IMPORTS, content=body, headers={"prefer": "respond-async"})
        job = await ended(client, begun.headers["location"])
        assert job["status"] == "failed" and why in job["message"], job
    begun = await client.post(IMPORTS, content=archive(robot_files()), headers={"prefer": "respond-async"})
    stopped = await client.post(f"{begun.headers['location']}/cancel")
    assert stopped.json()["status"] in ("cancelled", "running")
    assert (await ended(client, begun.headers["location"]))["status"] == "cancelled"
    assert list((tmp_path / "robots").iterdir()) == []


async def test_what_is_probably_not_meant_is_told_with_codes_before_any_map_is_built(
    client: httpx.AsyncClient,
) -> None:
    files = robot_files()
    card = json.loads(files["robot.json"])
    [(station, pose)] = card["scene"]["stations"].items()
    pose["yaw_rad"] = 3.0
    first, second = card["mounts"]
    card["mounts"][1] = first | {"name": second["name"]}
    assert (await client.post(IMPORTS, content=archive(files | {"robot.json": json.dumps(card)}))).status_code == 201
    answer = await client.get("/api/robots/bench/warnings")
    assert answer.status_code == 200
    told = {warning["code"]: warning for warning in answer.json()}
    assert {"arms_together", "station_faces_away"} <= told.keys()
    assert told["arms_together"]["arms"] == ["left", "right"] and told["arms_together"]["apart_m"] == 0.0
    assert told["station_faces_away"]["station"] == station
    assert (await client.get("/api/robots/nobody/warnings")).status_code == 404


async def test_a_robot_without_a_card_is_drafted_of_its_urdf_and_what_is_no_description_is_refused(
    client: httpx.AsyncClient, tmp_path: Path
) -> None:
    async def sent(name: str, body: bytes) -> httpx.Response:
        return await client.post(IMPORTS, params={"filename": name}, content=body)

    answer = await sent("My arm.urdf", single_urdf().encode())
    told = answer.json()
    assert (answer.status_code, told["name"], told["title"], told["arms"]) == (201, "my-arm", "My arm", ["arm"])
    assert any("stands on" in guess for guess in told["draft"]["guesses"]) and told["draft"]["unknown"]
    card = (await client.get("/api/robots/my-arm")).json()
    assert len(card["arms"][0]["joints"]) == 6
    assert (await client.get("/api/robots/my-arm/warnings")).status_code == 200
    assert "draft" not in (await sent("bench.zip", archive(robot_files()))).json()
    macros = single_urdf().replace("<link", '<xacro:include filename="/etc/hosts"/><link', 1).encode()
    for name, body, field, said in (
        ("arm.txt", b"", "filename", "expected one that ends in"),
        ("arm.urdf", macros, "file", "has to be expanded"),
        ("arm.urdf", b"<robot name='none'><link name='a'/></robot>", "urdf", "has no arm"),
    ):
        [error] = (await sent(name, body)).json()["errors"]
        assert (error["field"], said in error["message"]) == (field, True), error
    assert sorted(path.name for path in (tmp_path / "robots").iterdir()) == ["bench", "my-arm"]
