"""The examples run, and print what they say they do."""

import runpy
from pathlib import Path

import pytest

from tests.sweep import sweep

EXAMPLES = Path(__file__).parent.parent / "examples"
PRINTED = {
    "plan_a_garment": "solved: ",
    "draw_a_garment": "edges of the Fold-DAG: [[0, 1]]",
    "why_not": "suggestion: ",
    "fold_to_a_size": "solved",
    "place_on_the_table": "0.10 m nearer: ",
    "joints_over_time": "step 1",
}


def test_each_example_is_run() -> None:
    assert {path.stem for path in EXAMPLES.glob("*.py")} == PRINTED.keys()


@sweep("name", PRINTED, PRINTED.keys() - {"why_not"})
def test_the_example_prints_its_result(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(EXAMPLES / f"{name}.py"))
    assert PRINTED[name] in capsys.readouterr().out
