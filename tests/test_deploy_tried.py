"""The container file and the unit are tried out: what they copy, set and start is a server that answers and stops.

Neither a container engine nor systemd is asked: the files' own lines are carried out in folders of the test, with the
libraries of this environment.
"""

import json
import os
import re
import shlex
import shutil
import signal
import stat
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest

from tests.patience import PATIENCE_S
from tests.test_deploy import ROOT, UNIT, instructions

PLEAT = [sys.executable, "-c", "from app.cli import main; main()"]
STOPS_WITHIN_S = 60.0
"""Far more than the 10 s that the unit gives: the machine may be busy."""


@contextmanager
def started(
    options: Sequence[str], at: Path, environment: Mapping[str, str], program: Sequence[str] = PLEAT
) -> Iterator[tuple[int, str]]:
    """Start a server in a folder; yield its port and what it printed first; then stop it by SIGTERM.

    It is the program given, or the code in that folder.
    """
    # Kernels are compiled once for each folder of the code, for minutes; nothing here needs them compiled.
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("PLEAT_", "PYTHONPATH"))}
    given = {**kept, "NUMBA_DISABLE_JIT": "1", **environment, "PLEAT_PORT": "0"}
    log = at / "log"
    with log.open("w") as err:
        command = [*program, *options]
        process = subprocess.Popen(command, cwd=at, env=given, stdout=subprocess.PIPE, stderr=err, text=True)
    assert process.stdout is not None
    try:
        line = process.stdout.readline()
        found = re.search(r"http://[^\s/]+:(\d+)", line)
        assert found, line + log.read_text()
        yield int(found[1]), line
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=STOPS_WITHIN_S)
        assert process.returncode == 0, log.read_text()
    finally:
        process.kill()
        process.communicate()
    for line in log.read_text().splitlines():
        json.loads(line)  # both ask for a log in JSON


def asked(port: int, token: str) -> None:
    """Ask a server for its health, a page, and a garment with its folds, with the token and without."""
    with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=PATIENCE_S) as client:
        assert client.get("/api/health").status_code == 401
        client.headers["Authorization"] = f"Bearer {token}"
        checks = client.get("/api/health").json()["checks"]
        assert (checks["disk"], checks["database"]) == ("ok", "ok")
        page = client.get("/", follow_redirects=True)
        assert page.status_code == 200 and "<html" in page.text
        assert client.post("/api/dag", json={"garment": "t-shirt"}).status_code == 200


@pytest.mark.long
def test_what_the_container_copies_is_a_server_that_answers_and_stops(tmp_path: Path) -> None:
    image, variables = tmp_path / "image", dict[str, str]()
    image.mkdir()
    for name, rest in instructions():
        match name:
            case "COPY":
                *sources, target = rest.split()
                for source in sources:
                    copied(ROOT / source, image / target)
            case "ENV":
                variables |= dict(one.split("=", 1) for one in shlex.split(rest))
    command = {name: json.loads(rest) for name, rest in instructions() if name in ("ENTRYPOINT", "CMD")}
    assert command["ENTRYPOINT"] == ["pleat"]
    variables["PLEAT_DATA"] = str(tmp_path / variables["PLEAT_DATA"].lstrip("/"))
    with started(command["CMD"], image, variables) as (port, line):
        told = re.search(r"token=(\S+)", line)
        assert told, line
        asked(port, told[1])
    assert (tmp_path / "data" / "pleat.db").exists()


def copied(source: Path, target: Path) -> None:
    """Copy as a container file does: a folder as the target, a file into it."""
    if source.is_dir():
        shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
    else:
        shutil.copy(source, target)


@pytest.mark.long
def test_what_the_unit_starts_makes_its_token_in_its_state_directory_and_stops(tmp_path: Path) -> None:
    state, cache = tmp_path / "lib", tmp_path / "cache"
    mode = int(re.findall(r"^StateDirectoryMode=(\d+)", UNIT, re.MULTILINE)[0], 8)
    state.mkdir(mode=mode)
    cache.mkdir()

    def here(text: str) -> str:
        return text.replace("/var/lib/pleat", str(state)).replace("/var/cache/pleat", str(cache))

    program, *options = shlex.split(here(re.findall(r"^ExecStart=(.*)$", UNIT, re.MULTILINE)[0]))
    assert Path(program).name == "pleat"
    variables = dict(
        one.split("=", 1)
        for line in re.findall(r"^Environment=(.*)$", UNIT, re.MULTILINE)
        for one in shlex.split(here(line))
    )
    code = tmp_path / "code"
    code.mkdir()
    for name in ("planner", "app", "static", "garments"):
        (code / name).symlink_to(ROOT / name)
    with started(options, code, variables) as (port, line):
        assert "token=" not in line  # it is in the file, for whoever may read that
        token = state / "token"
        assert stat.S_IMODE(token.stat().st_mode) & 0o077 == 0
        asked(port, token.read_text().strip())
    assert (state / "data" / "pleat.db").exists()
