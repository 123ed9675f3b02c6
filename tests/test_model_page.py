"""The numbers in docs/model.md's table and text are those of the program."""

import importlib
import math
import re
from pathlib import Path
from typing import Any

import pytest

from planner import Limits
from planner.folds.fold_sequence import FoldSequence
from planner.robots.load_robot import load_robot
from planner.task.scene import Scene
from tests.builders import fold, garment, rectangle_points

PAGE = (Path(__file__).parent.parent / "docs" / "model.md").read_text(encoding="utf-8")
TEXT = " ".join(PAGE.split())
NUMBERS = re.findall(r"^\| [^|]+ \| ([\d.e-]+) \| `(planner[^`]+)` \|$", PAGE, re.MULTILINE)


def named(path: str) -> float:
    """Return a number of the program by its dotted name; of a class the default of a field."""
    parts = path.split(".")
    for cut in range(len(parts) - 1, 0, -1):
        try:
            found: Any = importlib.import_module(".".join(parts[:cut]))
        except ModuleNotFoundError:
            continue
        for name in parts[cut:]:
            found = getattr(found() if isinstance(found, type) else found, name)
        return float(found)
    raise LookupError(path)


def test_the_table_of_numbers_is_found() -> None:
    assert len(NUMBERS) >= 20


@pytest.mark.parametrize(("value", "path"), NUMBERS)
def test_a_number_on_the_page_is_that_of_the_program(value: str, path: str) -> None:
    assert named(path) == pytest.approx(float(value), rel=1e-3)


def test_the_approaches_are_those_named() -> None:
    # 15, 30, 45 and 60 degrees below the horizontal in 15 headings, and straight down.
    assert "15, 30, 45 or 60 degrees" in TEXT and "15 headings, 15 degrees apart within 90 degrees" in TEXT
    scene = Scene()
    approaches = load_robot("pr2").reach(scene.torso_m, 0.0).approaches
    assert len(approaches) == 4 * 15 + 1
    assert {round(a.pitch_rad, 3) for a in approaches} == {0.262, 0.524, 0.785, 1.047, 1.571}
    assert max(abs(a.heading_rad) for a in approaches) == pytest.approx(math.radians(120))


def test_the_strip_on_the_page_has_folds_that_depend_without_overlapping() -> None:
    # (0, 0.39) to (0.4, 0.4) leaves a wedge on top, (0.39, 0.4) to (0.6, 0.3) the corner to the right of it.
    assert "folded along (0, 0.39) to (0.4, 0.4) and along (0.39, 0.4) to (0.6, 0.3)" in TEXT
    first, second = fold((0.0, 0.39), (0.4, 0.4)), fold((0.39, 0.4), (0.6, 0.3))
    assert FoldSequence.of(garment(rectangle_points(0.6, 0.4), first, second)).dag.edges == ((0, 1),)


def test_comfort_is_three_centimetres_unless_asked_otherwise() -> None:
    assert Limits().comfort_radius_m == 0.03


def test_the_page_links_to_files_that_are_there() -> None:
    folder = Path(__file__).parent.parent / "docs"
    links = re.findall(r"\]\(([^)#:]+)\)", PAGE)
    assert links and all((folder / link).exists() for link in links)
