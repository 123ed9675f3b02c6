"""An installation without extras plans and serves, and what needs an extra says how to install it."""

import subprocess
import sys
import tomllib
from collections.abc import Callable
from typing import Any

import pytest

from app.cli import main
from app.distribution import _LIBRARIES, installing, require
from app.files.export import UnavailableFileError
from app.files.exports import EXPORTS
from app.files.import_errors import ImportedFileError
from app.files.import_file import import_file
from app.files.state_of_plan import state_of_garment
from app.studies.table import CSV, TIMING, written_files
from planner import load_garment
from planner.errors import RequestError
from tests.test_deploy import ROOT

PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]

BASE = """
import sys
from importlib import import_module

class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in sys.argv[1].split(","):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Blocked())
for name in ("server.serve", "searches", "cli.plan", "cli.compare", "cli.export", "cli.run", "cli.study"):
    import_module(f"app.{name}")
"""


@pytest.fixture
def bare(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no extra be installed."""
    monkeypatch.setattr("app.distribution.is_installed", lambda _: False)
    monkeypatch.setattr("app.studies.table.is_installed", lambda _: False)


def test_planning_and_serving_import_no_extra() -> None:
    subprocess.run([sys.executable, "-c", BASE, ",".join(_LIBRARIES)], check=True, cwd=ROOT)


def test_each_library_is_in_the_extra_that_is_said() -> None:
    extras = PROJECT["optional-dependencies"]
    assert {extra for _, extra in _LIBRARIES.values()} <= extras.keys()
    assert len(PROJECT["dependencies"]) <= 24


@pytest.mark.usefixtures("bare")
@pytest.mark.parametrize("export", [export for export in EXPORTS if export.needs], ids=lambda export: export.what)
def test_an_export_says_which_extra_makes_it(export: Any) -> None:
    state = state_of_garment(load_garment("scarf"))
    with pytest.raises(UnavailableFileError) as raised:
        export.file(state, 1.0, lambda: False)
    assert str(raised.value).endswith(installing(_LIBRARIES[export.needs[0]][1]))
    assert export.to_dict(state)["says"]["code"] == "library_missing"


@pytest.mark.usefixtures("bare")
@pytest.mark.parametrize(("name", "extra"), [("a.dxf", "imports"), ("a.png", "vision"), ("a.jpg", "vision")])
def test_an_import_says_which_extra_reads_the_file(name: str, extra: Any) -> None:
    with pytest.raises(ImportedFileError) as raised:
        import_file(name, b"")
    assert raised.value.message.endswith(installing(extra))


@pytest.mark.usefixtures("bare")
def test_a_study_is_written_without_parquet() -> None:
    assert written_files() == (CSV, TIMING)


@pytest.mark.parametrize(("module", "extra"), [(module, extra) for module, (_, extra) in _LIBRARIES.items()])
def test_a_missing_library_is_named_with_its_extra(
    module: str, extra: Any, bare: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(RequestError) as raised:
        require(module, field="file")
    assert raised.value.message.endswith(installing(extra)) and raised.value.field == "file"
    monkeypatch.setattr("app.cli.cli", raising(ModuleNotFoundError("", name=f"{module}.part")))
    with pytest.raises(SystemExit, match=raised.value.message.partition(":")[0]):
        main()


def raising(error: Exception) -> Callable[[], None]:
    def raise_it() -> None:
        raise error

    return raise_it
