"""A server that really listens: its websockets, its guard, and its shutdown."""

import asyncio
import json
import signal
import socket
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.sync.connection import Connection
from websockets.typing import Origin, Subprotocol

from app.server.serve import _listening
from tests.app.conftest import REST, Served
from tests.app.samples import towel
from tests.patience import PATIENCE_S

SUBPROTOCOL = Subprotocol("viser-v1.1.1")


def test_answers_are_sent_at_once_and_not_held_back_for_an_acknowledgement() -> None:
    async def accepted() -> bool:
        is_at_once: asyncio.Future[bool] = asyncio.get_running_loop().create_future()

        def accept(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            wire = writer.get_extra_info("socket")
            is_at_once.set_result(wire.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY) != 0)
            writer.close()

        listener = _listening((socket.AF_INET, ("127.0.0.1", 0)))
        async with await asyncio.start_server(accept, sock=listener):
            _, writer = await asyncio.open_connection(*listener.getsockname())
            writer.close()
            return await is_at_once

    assert asyncio.run(accepted())


def live_path(served: Served) -> str:
    return f"/api/documents/{served.document}/live"


def view_path(served: Served) -> str:
    return f"/viser/{served.document}"


def live(served: Served, **options: Any) -> ClientConnection:
    return connect(f"ws://{served.authority}{live_path(served)}", proxy=None, **options)


def until(page: Connection, kind: str, **wanted: object) -> dict[str, Any]:
    """Return the first message of a kind that has these fields."""
    deadline = time.monotonic() + PATIENCE_S
    while True:
        message: dict[str, Any] = json.loads(page.recv(timeout=deadline - time.monotonic()))
        if message["kind"] == kind and wanted.items() <= message.items():
            return message


def until_planned(page: Connection) -> dict[str, Any]:
    """Return the first message of a final plan: a slow machine shows other plans before it."""
    while not (message := until(page, "plan", status="solved"))["plan"]["is_final"]:
        pass
    return message


def test_the_first_document_is_the_t_shirt_planned(served: Served) -> None:
    with live(served) as page:
        assert until(page, "document")["garment"]["name"] == "t-shirt"
        message = until_planned(page)
    assert message["text"].startswith("Planned: ")
    shown = message["plan"]
    assert shown.pop("version") == message["version"]
    assert shown.pop("is_stale") is False
    assert shown.pop("is_final") is True
    assert shown.pop("at_least_s") is None, "it is known to be the quickest"
    assert REST.get(f"{served.url}/api/plans/{shown['id']}").json() == shown


def test_play_seek_speed_and_pause_are_obeyed(served: Served) -> None:
    with live(served) as page:
        duration_s = until_planned(page)["plan"]["cost_s"]
        until(page, "playback", duration_s=duration_s)
        page.send(json.dumps({"do": "seek", "t_s": 5.0}))
        until(page, "playback", t_s=5.0, playing=False)
        page.send(json.dumps({"do": "speed", "speed": 20.0}))
        page.send(json.dumps({"do": "play"}))
        until(page, "playback", playing=True, speed=20.0)
        until(page, "playback", playing=False, t_s=duration_s)
        page.send(json.dumps({"do": "speed", "speed": 1.0}))
        until(page, "playback", speed=1.0)


@pytest.mark.parametrize(
    "garbage",
    [
        "",
        "{",
        "[]",
        '{"do": "dance"}',
        '{"do": "seek", "t_s": "1"}',
        '{"do": "seek", "t_s": 1e400}',
        '{"do": "theme", "dark": 1}',
        "9" * 5000,
    ],
)
def test_a_command_that_makes_no_sense_is_told_so(served: Served, garbage: str) -> None:
    with live(served) as page:
        page.send(garbage)
        assert until(page, "problem")["detail"]
        page.send(json.dumps({"do": "pause"}))
        until(page, "playback", playing=False)


def test_another_garment_can_be_chosen_and_an_unknown_one_cannot(served: Served) -> None:
    with live(served) as page:
        page.send(json.dumps({"do": "choose", "garment": "nothing"}))
        assert "nothing" in until(page, "problem")["detail"]
        page.send(json.dumps({"do": "choose", "garment": "hand-towel"}))
        chosen = until(page, "document")
        while chosen["garment"]["name"] != "hand-towel":
            chosen = until(page, "document")
        assert chosen["history"]["can_undo"] == "Open Hand towel"
        until(page, "plan", status="solved", version=chosen["version"])
        page.send(json.dumps({"do": "choose", "garment": "t-shirt"}))


@pytest.mark.parametrize("pace", ["", "/by-software"])
def test_the_3d_views_page_and_websocket_come_through_the_one_port(served: Served, pace: str) -> None:
    answer = REST.get(f"{served.url}{view_path(served)}{pace}", follow_redirects=True)
    assert answer.status_code == 200
    assert str(answer.url) == f"{served.url}{view_path(served)}{pace}/"
    assert "text/html" in answer.headers["content-type"]
    address = f"ws://{served.authority}{view_path(served)}{pace}"
    with connect(address, subprotocols=[SUBPROTOCOL], proxy=None, max_size=None) as page:
        assert page.subprotocol == SUBPROTOCOL
        assert isinstance(page.recv(timeout=PATIENCE_S), bytes)


@pytest.mark.parametrize("path", [live_path, view_path])
@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1"])
def test_a_websocket_from_a_foreign_page_never_opens(
    served: Served, path: Callable[[Served], str], origin: str
) -> None:
    with pytest.raises(InvalidStatus) as refused:
        connect(f"ws://{served.authority}{path(served)}", origin=Origin(origin), subprotocols=[SUBPROTOCOL], proxy=None)
    assert refused.value.response.status_code == 403


def test_a_websocket_under_a_foreign_name_never_opens(served: Served) -> None:
    host, _, port = served.authority.partition(":")
    path = live_path(served)
    with (
        socket.create_connection((host, int(port))) as wire,
        pytest.raises(InvalidStatus) as refused,
    ):
        connect(f"ws://evil.example:{port}{path}", sock=wire, proxy=None)
    assert refused.value.response.status_code == 403


def test_a_websocket_of_our_own_page_opens(served: Served) -> None:
    with live(served, origin=served.url) as page:
        until(page, "document")


def test_a_client_that_goes_away_stops_its_search(served: Served) -> None:
    """Twice as many endless searches as the machine has cores, all abandoned: the next is answered at once."""
    many = [{"name": "", "kind": "blue", "start": [0.4, 0.15], "end": [0.0, 0.15]}]
    slow = {"garment": "shirt", "time_limit_s": 60, "comfort_radius_m": 0.06, "heuristic": "zero"}
    for _ in range(8):
        with pytest.raises(httpx.ReadTimeout):
            REST.post(f"{served.url}/api/plans", json=slow, timeout=0.05)
    start = time.monotonic()
    answer = REST.post(f"{served.url}/api/plans", json={"garment": towel(folds=many)}, timeout=PATIENCE_S)
    assert answer.status_code == 200
    assert time.monotonic() - start < 30.0


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_and_kill_end_it_cleanly_whatever_is_open(tmp_path: Path, end: signal.Signals) -> None:
    server = Served(tmp_path)
    try:
        address = f"ws://{server.authority}{view_path(server)}"
        with (
            live(server) as page,
            connect(address, subprotocols=[SUBPROTOCOL], proxy=None, max_size=None) as view,
        ):
            until(page, "document")
            view.recv(timeout=PATIENCE_S)
            with pytest.raises(httpx.ReadTimeout):
                REST.post(f"{server.url}/api/plans", json={"garment": "shirt"}, timeout=0.05)
            assert (tmp_path / "server.json").exists()
            server.process.send_signal(end)
            output, _ = server.process.communicate(timeout=PATIENCE_S)
        assert server.process.returncode == 0
        assert "Traceback" not in output
        assert not (tmp_path / "server.json").exists()
    finally:
        server.stop()
