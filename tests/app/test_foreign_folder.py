"""Pleat started in a folder with modules of the names of its own and of its libraries: none of them is ever run."""

import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from tests.app.processes import descendants
from tests.app.samples import towel
from tests.patience import PATIENCE_S, wait_until

PLEAT = Path(sys.executable).with_name("pleat")

HOSTILE = ("app", "planner", "bench", "numpy", "json", "multiprocessing", "mujoco", "distributed", "signal", "trimesh")

STUDY = """
[[garments]]
template = "towel"
measures = {width_m = 0.3, length_m = [0.2, 0.25]}
[limits]
work_limit_s = 1
"""


@pytest.fixture
def hostile(tmp_path: Path) -> Path:
    """Return a folder with modules that leave a mark when they are imported."""
    folder = tmp_path / "hostile"
    for name in HOSTILE:
        (folder / name).mkdir(parents=True)
        text = f"open({str(folder)!r} + '/ran', 'a').write(__name__)\nraise SystemExit(__name__)\n"
        (folder / name / "__init__.py").write_text(text)
    return folder


def assert_not_run(folder: Path) -> None:
    ran = folder / "ran"
    assert not ran.exists(), ran.read_text()


def pleat(folder: Path, *arguments: object) -> None:
    command = [str(argument) for argument in (PLEAT, *arguments)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=PATIENCE_S)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("is_rehearsed", [False, pytest.param(True, marks=pytest.mark.long)])
def test_a_server_and_the_processes_of_its_work(hostile: Path, tmp_path: Path, is_rehearsed: bool) -> None:
    command: list[str | Path] = [PLEAT, "serve", "--port", "0", "--data", tmp_path / "data"]
    process = subprocess.Popen(command, cwd=hostile, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        assert process.stdout is not None
        url = next(word for word in process.stdout.readline().split() if word.startswith("http://"))
        with httpx.Client(base_url=url, timeout=PATIENCE_S) as client:
            plan = client.post("/api/plans", json={"garment": towel()})
            assert plan.status_code == 200, plan.text
            assert len(descendants(process.pid)) >= 2  # the template and the tracker of resources
            if not is_rehearsed:
                return
            job = client.post("/api/rehearsals", json={"plan": plan.json()["id"], "runs": 2})
            assert job.status_code == 202, job.text
            where = job.headers["location"]
            wait_until(lambda: client.get(where).json()["status"] not in ("queued", "running"))
            assert client.get(where).json()["status"] == "done", client.get(where).text
    finally:
        process.terminate()
        process.communicate(timeout=PATIENCE_S)
        assert_not_run(hostile)


def test_the_processes_of_a_study(hostile: Path) -> None:
    (hostile / "study.toml").write_text(STUDY)
    pleat(hostile, "study", "study.toml", "--out", "out", "--workers", 1)
    assert_not_run(hostile)
