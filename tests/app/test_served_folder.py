"""Two servers, each in a process of its own, on one data folder."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.app.conftest import REST, Served
from tests.patience import PATIENCE_S


def serve(data: Path) -> subprocess.CompletedProcess[str]:
    """Start a server that should fail to start."""
    command = [sys.executable, "-c", "from app.cli import main; main()", "serve", "--port", "0", "--data", str(data)]
    return subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S)


@pytest.mark.long
def test_a_second_server_on_a_folder_says_who_has_it_and_ends_until_the_first_is_killed(tmp_path: Path) -> None:
    first = Served(tmp_path)
    try:
        second = serve(tmp_path)
        assert second.returncode == 2
        assert second.stdout == ""
        assert "Traceback" not in second.stderr
        for word in (first.url, str(first.process.pid), str(tmp_path)):
            assert word in second.stderr.replace("\n", "")
        assert REST.get(f"{first.url}/api/health").json()["status"] == "ok"
    finally:
        first.stop()
    third = Served(tmp_path)
    assert json.loads((tmp_path / "server.json").read_text())["url"] == third.url
    third.stop()
