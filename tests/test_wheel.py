"""The wheel, installed into a fresh environment outside of the checkout: it plans and serves with what it carries."""

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import expect, sync_playwright

from app.distribution import NAME, installing
from tests.browser.conftest import FLAT, NO_VIEW, PATIENCE_MS
from tests.patience import PATIENCE_S
from tests.test_deploy import ROOT
from tests.test_deploy_tried import started

VERSION = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]

COMPILES_WITHIN_MS = 900_000


@pytest.fixture(scope="module")
def pleat(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the program of the wheel; its libraries are this environment's, of which Pleat itself is no part."""
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "--no-index", "--quiet"]
    subprocess.run([*build, "--wheel-dir", str(folder), str(ROOT)], check=True)
    (wheel,) = folder.glob("*.whl")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(folder / "venv")], check=True)
    python = folder / "venv" / "bin" / "python"
    here = [str(python), "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]
    there = Path(subprocess.run(here, check=True, capture_output=True, text=True).stdout.strip())
    libraries = (entry for entry in sys.path if entry and not ROOT.is_relative_to(entry) and Path(entry).is_dir())
    (there / "libraries.pth").write_text("\n".join(libraries))
    install = [sys.executable, "-m", "pip", "--python", str(python), "install", "--no-deps", "--no-index", "--quiet"]
    subprocess.run([*install, str(wheel)], check=True)
    return folder / "venv" / "bin" / "pleat"


@pytest.mark.long
def test_the_wheel_runs_outside_of_the_checkout(pleat: Path) -> None:
    code = f"import app; from importlib.metadata import version; print(app.__file__, version({NAME!r}))"
    python = [str(pleat.parent / "python"), "-c", code]
    where, version = subprocess.run(python, check=True, capture_output=True, text=True, cwd="/").stdout.split()
    assert Path(where).is_relative_to(pleat.parents[1]) and version == VERSION


@pytest.mark.long
def test_the_wheel_serves_its_page_and_its_garments(pleat: Path, tmp_path: Path) -> None:
    options = ["serve", "--data", str(tmp_path / "data"), "--log-json"]
    with (
        started(options, tmp_path, {}, [str(pleat)]) as (port, _),
        httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=PATIENCE_S, follow_redirects=True) as client,
    ):
        assert client.get("/api/health").json()["version"] == VERSION
        assert "<html" in client.get("/").text
        assert client.get("/api/garments/vest").json()["folds"]


@pytest.mark.long
@pytest.mark.browser
def test_the_wheels_page_shows_a_garment_and_its_plan(pleat: Path, tmp_path: Path, chromium_path: str | None) -> None:
    options = ["serve", "--data", str(tmp_path / "data"), "--log-json"]
    with (
        started(options, tmp_path, {"NUMBA_DISABLE_JIT": "0"}, [str(pleat)]) as (port, _),
        sync_playwright() as playwright,
    ):
        page = playwright.chromium.launch(executable_path=chromium_path, args=FLAT).new_page()
        page.add_init_script(NO_VIEW)
        page.goto(f"http://127.0.0.1:{port}")
        expect(page.locator("#drafting-board .corner").first).to_be_visible(timeout=PATIENCE_MS)
        expect(page.get_by_role("status")).to_contain_text("Planned: ", timeout=COMPILES_WITHIN_MS)


@pytest.mark.long
def test_the_wheel_plans(pleat: Path) -> None:
    command = [str(pleat), "plan", "scarf", "--json", "-"]
    answer = subprocess.run(command, check=True, capture_output=True, text=True, cwd=pleat.parent).stdout
    assert json.loads(answer)["status"] == "solved"


def test_an_extra_is_installed_from_where_pleat_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.prefix", str(ROOT / ".venv"))
    assert installing("physics") == ".venv/bin/pip install -e '.[physics]'"
    monkeypatch.setattr("sys.prefix", str(tmp_path))
    assert installing("physics") == "pip install -e '.[physics]'"
    monkeypatch.setattr("app.distribution._PROJECT", tmp_path / "pyproject.toml")
    assert installing("physics") == f"pip install '{NAME}[physics]'"
