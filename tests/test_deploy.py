"""The files for operators: the unit is read by systemd's own checker, the container file by its grammar."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from app.settings import Settings

ROOT = Path(__file__).parent.parent
UNIT = (ROOT / "docs" / "deploy" / "pleat.service").read_text(encoding="utf-8")
CONTAINER = (ROOT / "docs" / "deploy" / "Containerfile").read_text(encoding="utf-8")
INSTRUCTIONS = {
    "FROM", "RUN", "WORKDIR", "COPY", "USER", "ENV", "VOLUME", "EXPOSE", "STOPSIGNAL", "ENTRYPOINT", "CMD",
}  # fmt: skip


def instructions() -> list[tuple[str, str]]:
    lines = [line for line in CONTAINER.splitlines() if line.strip() and not line.startswith("#")]
    joined = re.sub(r"\\\n\s*", "", "\n".join(lines))
    return [(name, rest) for name, _, rest in (line.partition(" ") for line in joined.splitlines())]


@pytest.mark.skipif(not shutil.which("systemd-analyze"), reason="there is no systemd-analyze here")
def test_systemd_finds_nothing_wrong_with_the_unit(tmp_path: Path) -> None:
    here = UNIT.replace("/opt/pleat/.venv/bin/pleat", sys.executable)
    (tmp_path / "pleat.service").write_text(here)
    found = subprocess.run(
        ["systemd-analyze", "verify", "--man=no", str(tmp_path / "pleat.service")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert "pleat.service" not in found.stderr and found.returncode == 0, found.stderr


def test_the_unit_s_options_are_those_of_serve() -> None:
    options = re.findall(r"--([a-z-]+)", next(line for line in UNIT.splitlines() if line.startswith("ExecStart=")))
    assert options and {option.replace("-", "_") for option in options} <= set(Settings.model_fields)


def test_the_container_copies_what_there_is_and_all_that_a_wheel_has() -> None:
    assert {name for name, _ in instructions()} <= INSTRUCTIONS
    assert instructions()[0][0] == "FROM"
    sources = [source for name, rest in instructions() if name == "COPY" for source in rest.split()[:-1]]
    assert all((ROOT / source).exists() for source in sources)
    assert {"planner", "app", "static", "garments"} <= set(sources)


def test_variables_of_the_container_and_of_the_page_for_operators_are_settings() -> None:
    named = re.findall(r"PLEAT_[A-Z_]+", CONTAINER + (ROOT / "docs" / "operating.md").read_text(encoding="utf-8"))
    assert named and {name.removeprefix("PLEAT_").lower() for name in named} <= set(Settings.model_fields)


def test_the_container_is_not_run_by_root_and_serves_beyond_loopback() -> None:
    users = [rest for name, rest in instructions() if name == "USER"]
    assert users and users[-1] != "root"
    assert any("PLEAT_HOST=0.0.0.0" in rest for name, rest in instructions() if name == "ENV")
