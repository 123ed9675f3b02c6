"""Behind nginx, as docs/operating.md has it: page, REST, both websockets, events, and the client's address."""

import json
import os
import re
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urljoin

import httpx
import pytest
import viser
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from tests.app.conftest import Served
from tests.app.samples import towel
from tests.patience import PATIENCE_S, wait_until

PROGRAM = next(filter(Path.exists, (Path("/usr/sbin/nginx"), Path(sys.prefix, "nginx/usr/sbin/nginx"))), None)
PREFIX = "/pleat"

_OPERATING = Path(__file__).parents[2] / "docs" / "operating.md"
_DOCUMENTED_PORT = "127.0.0.1:8000"
_CONFIG = """{user}
pid {folder}/nginx.pid;
error_log {folder}/error.log;
daemon off;
events {{}}
http {{
    access_log off;
    client_body_temp_path {folder}/body;
    proxy_temp_path {folder}/proxy;
    fastcgi_temp_path {folder}/fastcgi;
    uwsgi_temp_path {folder}/uwsgi;
    scgi_temp_path {folder}/scgi;
    server {{
        listen 127.0.0.1:{port};
        {location}
    }}
}}
"""


def documented_location() -> str:
    """Return the location block of docs/operating.md."""
    found = re.search(r"^    location .*?^    }$", _OPERATING.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert found is not None
    return found.group()


@contextmanager
def nginx_before(server_port: int, folder: Path) -> Iterator[str]:
    """Return the address of the server below the prefix; skip where there is no nginx."""
    if PROGRAM is None:
        pytest.skip("there is no nginx")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    location = documented_location()
    assert _DOCUMENTED_PORT in location
    config = _CONFIG.format(
        user="user root;" if os.geteuid() == 0 else "",
        folder=folder,
        port=port,
        location=location.replace(_DOCUMENTED_PORT, f"127.0.0.1:{server_port}"),
    )
    (folder / "nginx.conf").write_text(config, encoding="utf-8")
    with subprocess.Popen([PROGRAM, "-p", folder, "-c", folder / "nginx.conf", "-e", folder / "error.log"]) as nginx:
        try:
            _wait_for(port, nginx, folder)
            yield f"http://127.0.0.1:{port}{PREFIX}"
        finally:
            nginx.terminate()


def _wait_for(port: int, nginx: "subprocess.Popen[bytes]", folder: Path) -> None:
    def listens() -> bool:
        assert nginx.poll() is None, (folder / "error.log").read_text(encoding="utf-8")
        with socket.socket() as wire:
            return wire.connect_ex(("127.0.0.1", port)) == 0

    wait_until(listens)


@pytest.fixture(scope="module")
def proxied(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """Return a client of a server behind nginx, as a page there asks."""
    server = Served(tmp_path_factory.mktemp("data"), 0, "--root-path", PREFIX)
    try:
        with nginx_before(server.port, tmp_path_factory.mktemp("nginx")) as url:
            origin = url.removesuffix(PREFIX)
            with httpx.Client(base_url=url, headers={"origin": origin}, timeout=PATIENCE_S, trust_env=False) as client:
                yield client
    finally:
        server.stop()


def websocket_url(proxied: httpx.Client, path: str) -> str:
    return f"ws://{proxied.base_url.netloc.decode()}{PREFIX}{path}"


def created(proxied: httpx.Client) -> str:
    made = proxied.post("/api/documents", json={"garment": towel()})
    assert made.status_code == 201, made.text
    document_id: str = made.json()["id"]
    assert made.headers["location"] == f"{PREFIX}/d/{document_id}"
    return document_id


def test_the_page_and_all_that_it_names_are_below_the_prefix(proxied: httpx.Client) -> None:
    first = proxied.get("/")
    assert first.headers["location"].startswith(f"{PREFIX}/d/")
    page = proxied.get(first.headers["location"].removeprefix(PREFIX))
    assert page.status_code == 200 and 'src="../static/page.js"' in page.text
    script = proxied.get(urljoin(first.headers["location"], "../static/page.js").removeprefix(PREFIX))
    assert script.status_code == 200 and "javascript" in script.headers["content-type"]
    assert f"{PREFIX}/openapi.json" in proxied.get("/docs").text
    assert httpx.get(str(proxied.base_url).removesuffix(f"{PREFIX}/") + "/api/health").status_code == 404


def test_a_page_of_another_server_is_refused_behind_the_proxy_too(proxied: httpx.Client) -> None:
    answer = proxied.post("/api/dag", json={"garment": "tie"}, headers={"origin": "https://evil.example"})
    assert answer.status_code == 403


def test_edits_reach_the_websocket_of_a_page(proxied: httpx.Client) -> None:
    document_id = created(proxied)
    with connect(websocket_url(proxied, f"/api/documents/{document_id}/live"), proxy=None, max_size=None) as page:
        told = json.loads(page.recv(timeout=PATIENCE_S))
        assert (told["kind"], told["version"]) == ("document", 1)
        edit = {"base_version": 1, "label": "Same", "drawing": {**told["drawing"], "title": "Other"}}
        assert proxied.put(f"/api/documents/{document_id}/drawing", json=edit).status_code == 200
        while told.get("kind") != "document" or told["version"] == 1:
            told = json.loads(page.recv(timeout=PATIENCE_S))
        assert (told["version"], told["drawing"]["title"]) == (2, "Other")
        page.send(json.dumps({"do": "nothing that there is"}))
        while told["kind"] != "problem":
            told = json.loads(page.recv(timeout=PATIENCE_S))


def test_the_3d_view_and_its_websocket_are_below_the_prefix(proxied: httpx.Client) -> None:
    document_id = created(proxied)
    view = proxied.get(f"/viser/{document_id}")
    assert view.headers["location"].endswith(f"{PREFIX}/viser/{document_id}/")
    assert proxied.get(f"/viser/{document_id}/").status_code == 200
    protocol = Subprotocol(f"viser-v{viser.__version__}")
    address = websocket_url(proxied, f"/viser/{document_id}")
    with connect(address, subprotocols=[protocol], proxy=None, max_size=None) as scene:
        assert scene.subprotocol == protocol
        size = 0
        while size < 10_000:  # the scene: more than a greeting
            size += len(scene.recv(timeout=PATIENCE_S))


def test_events_of_a_job_come_as_they_happen(proxied: httpx.Client) -> None:
    job = proxied.post("/api/jobs/suggestions", json={"garment": towel(), "time_limit_s": 1.0})
    assert job.status_code == 202, job.text
    assert job.headers["location"].startswith(f"{PREFIX}/api/jobs/")
    path = job.headers["location"].removeprefix(PREFIX)
    with proxied.stream("GET", f"{path}/events") as events:
        assert events.headers["content-type"].startswith("text/event-stream")
        assert next(events.iter_lines())
    proxied.post(f"{path}/cancel")


def test_a_body_that_is_too_large_is_told_by_the_proxy_or_the_server(proxied: httpx.Client) -> None:
    assert proxied.post("/api/dag", content=b"x" * (3 << 20)).status_code == 413
