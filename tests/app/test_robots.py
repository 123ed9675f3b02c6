"""Robots over REST and on the command line: which there are, one's card, and the check of a card."""

import json
from pathlib import Path
from typing import Any

import httpx
import pytest

from planner.robots.known_robots import shipped_card, shipped_robots
from planner.robots.table_reach import TableReach
from tests.app.test_cli import pleat

SHIPPED = {"pr2", "ur5e-pair", "panda-pair", "tiago-pro", "baxter", "so101-pair", "ur5e-single"}


@pytest.fixture
def reach_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Spare the reach maps: that they are right is shown elsewhere."""
    known = TableReach({"left": 0.75, "right": 0.5}, 1.0, 0.25)
    monkeypatch.setattr("planner.robots.table_reach.table_reach", lambda robot, progress: known)


@pytest.mark.anyio
async def test_the_list_has_every_shipped_robot(client: httpx.AsyncClient) -> None:
    found = {entry["name"]: entry for entry in (await client.get("/api/robots")).json()}
    assert set(found) >= SHIPPED
    pr2 = {"name": "pr2", "title": "PR2", "arms": ["left", "right"], "base": "omni", "shipped": True}
    assert found["pr2"] == pr2
    assert len(found["ur5e-single"]["arms"]) == 1 and found["ur5e-pair"]["base"] == "fixed"


@pytest.mark.anyio
@pytest.mark.parametrize("name", sorted(SHIPPED))
async def test_a_robot_is_its_whole_card(client: httpx.AsyncClient, name: str) -> None:
    assert (await client.get(f"/api/robots/{name}")).json() == shipped_card(name).to_dict()


@pytest.mark.anyio
@pytest.mark.parametrize("name", ["nobody", "..", "%2e%2e%2fpr2", "PR2"])
async def test_an_unknown_robot_is_a_404(client: httpx.AsyncClient, name: str) -> None:
    answer = await client.get(f"/api/robots/{name}")
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"


def test_the_command_line_lists_what_rest_lists() -> None:
    listed = json.loads(pleat("robots", "--json", "-").stdout)
    assert [entry["name"] for entry in listed] == list(shipped_robots())
    table = pleat("robots").stdout
    assert "Baxter" in table and "omni" in table
    assert pleat("robot", "list").stdout == table


@pytest.mark.usefixtures("reach_known")
def test_a_good_card_is_told_with_what_it_reaches() -> None:
    result = pleat("robot", "check", "ur5e-pair")
    assert result.exit_code == 0
    assert "a good card" in result.stdout and "75%" in result.stdout
    reached = json.loads(pleat("robot", "check", "ur5e-pair", "--json", "-").stdout)["table_reached"]
    assert reached == {"arms": {"left": 0.75, "right": 0.5}, "any_arm": 1.0, "two_arms": 0.25}


@pytest.mark.usefixtures("reach_known")
@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        (("arms", 0, "joints", 4), "left_hand", "arms[0].joints[4]: the URDF has no moving joint 'left_hand'"),
        (("arms", 1, "tool", "link"), "nowhere", "arms[1].tool.link: the URDF has no link or frame 'nowhere'"),
        (("base", "kind"), "legs", "base.kind"),
        (("wheels",), 3, "wheels"),
        (("urdf", "path"), "nowhere.urdf", "urdf"),
    ],
)
def test_a_bad_card_is_refused_by_its_field(
    tmp_path: Path, path: tuple[str | int, ...], value: object, told: str
) -> None:
    card = shipped_card("so101-pair").to_dict()
    part: Any = card
    for key in path[:-1]:
        part = part[key]
    part[path[-1]] = value
    file = tmp_path / "mine.json"
    file.write_text(json.dumps(card))
    result = pleat("robot", "check", str(file))
    assert result.exit_code == 2
    assert told in result.stderr and result.stdout == ""


def test_a_robot_that_is_not_there_is_told_with_those_that_are() -> None:
    result = pleat("robot", "check", "nobody")
    assert result.exit_code == 2
    assert "nobody" in result.stderr and "so101-pair" in result.stderr


@pytest.mark.anyio
@pytest.mark.parametrize("name", ["nobody", "cards/mine.json", "../pr2"])
async def test_a_robot_that_nobody_described_is_refused_by_name(client: httpx.AsyncClient, name: str) -> None:
    answer = await client.post("/api/plans", json={"garment": "hand-towel", "robot": name})
    assert answer.status_code == 422
    [error] = answer.json()["errors"]
    assert error["field"] == "robot" and "there is no robot" in error["message"] and "pr2" in error["message"]


NAPKIN = {
    "name": "napkin",
    "outline": [[0.0, 0.0], [0.2, 0.0], [0.2, 0.16], [0.0, 0.16]],
    "folds": [{"name": "half", "kind": "blue", "start": [0.1, 0.16], "end": [0.1, 0.0]}],
}


@pytest.mark.anyio
async def test_a_request_names_the_robot_and_its_scene_fills_up_what_is_given(client: httpx.AsyncClient) -> None:
    answer = await client.post(
        "/api/plans", json={"garment": NAPKIN, "robot": "so101-pair", "scene": {"friction": 0.9}, "time_limit_s": 60}
    )
    plan = answer.json()
    assert answer.status_code == 200 and plan["status"] == "solved"
    assert plan["primitives"][0]["base"]["station"] is None
    played = (await client.get(f"/api/plans/{plan['id']}/timeline?rate_hz=2")).json()
    assert "left_shoulder_pan" in played["samples"][0]["joints"]


def test_a_card_of_ones_own_is_planned_for_by_its_path(tmp_path: Path) -> None:
    card = shipped_card("so101-pair").to_dict() | {"name": "bench", "title": "My bench"}
    (tmp_path / "bench.json").write_text(json.dumps(card))
    (tmp_path / "napkin.json").write_text(json.dumps(NAPKIN))
    result = pleat("plan", str(tmp_path / "napkin.json"), "--robot", str(tmp_path / "bench.json"), "--json", "-")
    assert result.exit_code == 0, result.stderr
    assert json.loads(result.stdout)["status"] == "solved"


def test_a_robot_that_the_command_line_does_not_know_is_told_by_its_option() -> None:
    result = pleat("plan", "tie", "--robot", "nobody")
    assert result.exit_code == 2
    assert "--robot" in result.stderr and "so101-pair" in result.stderr


@pytest.mark.usefixtures("reach_known")
def test_a_tool_point_off_the_fingertips_is_warned_of_with_its_numbers(tmp_path: Path) -> None:
    card = shipped_card("panda-pair").to_dict()
    card["arms"] = json.loads(json.dumps(card["arms"]))
    card["arms"][1]["tool"]["offset_m"] = [0.0, 0.009, -0.019]
    (tmp_path / "mine.json").write_text(json.dumps(card))
    answer = json.loads(pleat("robot", "check", str(tmp_path / "mine.json"), "--json", "-").stdout)
    good, short = answer["tool_points"]
    assert (good["arm"], short["arm"]) == ("left", "right")
    assert short["beyond_m"] == pytest.approx(good["beyond_m"] + 0.019)
    assert short["beside_m"] == pytest.approx(good["beside_m"] - 0.009)
    [warning] = answer["warnings"]
    assert {key: warning[key] for key in ("code", "arm", "beyond_m", "beside_m")} == {"code": "tool_off_tips", **short}
    told = " ".join(pleat("robot", "check", str(tmp_path / "mine.json")).stdout.split())
    assert "Warning: right: the fingertips reach 0.028 m beyond the tool point" in told
    assert "the fingers meet 0.009 m beside the tool point" in told


@pytest.mark.usefixtures("reach_known")
def test_a_station_in_the_table_is_warned_of_with_how_far_back_it_is_free(tmp_path: Path) -> None:
    card = json.loads(json.dumps(shipped_card("tiago-pro").to_dict()))
    card["scene"]["stations"]["front"]["x_m"] += 0.3
    (tmp_path / "mine.json").write_text(json.dumps(card))
    answer = json.loads(pleat("robot", "check", str(tmp_path / "mine.json"), "--json", "-").stdout)
    [warning] = [one for one in answer["warnings"] if one["code"] == "station_in_table"]
    assert (warning["code"], warning["station"]) == ("station_in_table", "front")
    assert 0.0 < warning["back_m"] <= 0.3
    told = " ".join(pleat("robot", "check", str(tmp_path / "mine.json")).stdout.split())
    assert "scene.stations: at front the base would stand in the table or its legs" in told
