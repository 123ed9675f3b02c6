"""The law that no module outside `planner/robots` names a robot, counts joints, or tells arms by their side.

The sources are scanned: literals, names and imports of Python (docstrings aside), and the page's JavaScript. What
looks like a robot and is none is listed with the reason.
"""

import ast
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from tests.test_imports import ROOT, all_imports, is_within

DOOR = (
    "planner.robots.arm_paths",
    "planner.robots.armed_robot",
    "planner.robots.card",
    "planner.robots.card_doubts",
    "planner.robots.card_file",
    "planner.robots.card_parts",
    "planner.robots.card_robot",
    "planner.robots.collision.collisions",
    "planner.robots.collision.described_parts",
    "planner.robots.collision.link_shapes",
    "planner.robots.collision.rounded_hull",
    "planner.robots.described_robot",
    "planner.robots.drafting.draft",
    "planner.robots.kept_arrays",
    "planner.robots.known_robots",
    "planner.robots.load_robot",
    "planner.robots.mesh_file",
    "planner.robots.own_robots",
    "planner.robots.reach_maps",
    "planner.robots.table_reach",
    "planner.robots.tool_path",
    "planner.robots.tool_point",
    "planner.robots.urdf_shapes",
    "planner.robots.varied_card",
)
"""What others may import of the robots: descriptions, the way to load one, types of questions and answers."""

ALLOWED: Mapping[str, tuple[str, str]] = {
    "planner/task/task.py": (r"pr2", "the robot of a task that names none, in one place"),
    "planner/task/scene.py": (r"left|right", "stations are named after the sides of the table"),
    "planner/cloth/g_state.py": (r"left|right", "edges of the table"),
    "planner/geometry/keyframes.py": (r"right", "a side of numpy's searchsorted"),
    "app/rehearsal/trace.py": (r"right", "a side of numpy's searchsorted"),
    "app/tables.py": (r"left|right", "columns of a table are aligned"),
    "app/cli/cache.py": (r"left|right", "columns of a table are aligned"),
    "app/cli/rehearse.py": (r"left|right", "columns of a table are aligned"),
    "app/files/sheet_pdf.py": (r"left", "where a line of text begins"),
    "app/cli/study.py": (r"left", "the time that is left"),
    "app/rehearsal/vision/outline_edges.py": (r"right", "a side of numpy's searchsorted"),
    "planner/proposals/moves.py": (r"left|right", "names of parts of a garment"),
    "app/drivers/ur_arms.py": (r"shoulder_pan_joint", "the first joint of the arms that the driver is for"),
    "app/files/pattern_panels.py": (r"left|right", "names of the halves of a pattern"),
    "app/templates/mirrored.py": (r"left|right", "names of folds on the halves of a garment"),
    "static/js/board/edits.js": (r"left|right", "names of folds on the halves of a garment"),
    "static/js/messages/changes.js": (r"left|right", "ways to turn the cloth"),
}
"""Words that mean something else: by file, a pattern and the reason."""

WORD = re.compile(
    r"pr2|left|right|[lr]_(shoulder|elbow|upper_arm|forearm|wrist|gripper)\w*|\w+_(joint|frame|footprint)",
    re.IGNORECASE,
)
"""Literals that are a robot, an arm, or a joint or frame of one."""

NAME = re.compile(r"(?i:pr2)|JOINTS|(left|right)_(arm|hand|gripper)s?|both_arms|BothArms")
"""Names of Python that count arms or joints, or say a robot."""

SHAPE = re.compile(r"shape \([^)]*\b[5-8]\)|\b(zeros|empty|ones|full|reshape|repeat|tile)\((.*[(, ])?[5-8]\)")
"""A dimension of an array, told or made, that is the number of joints of some arm."""

ROBOT_WORD = re.compile(r"\bPR2\b")

SOURCES = [
    *(path for path in (ROOT / "planner").rglob("*.py") if "robots" not in path.relative_to(ROOT).parts),
    *(ROOT / "app").rglob("*.py"),
    *(ROOT / "static" / "js").rglob("*.js"),
]

SIDES_OF_A_LINE = "planner/motion/cloth_surface.py"
"""Where left and right are the parts of the cloth beside a fold line."""

COUNTING = ("planner/motion", "planner/primitives", "planner/planning", "planner/explain", "planner/task")


def relative(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def is_allowed(path: Path, word: str) -> bool:
    pattern, _ = ALLOWED.get(relative(path), ("(?!)", ""))
    return re.fullmatch(pattern, word, re.IGNORECASE) is not None


def docstrings(tree: ast.AST) -> set[int]:
    """The string expressions that stand as statements: they explain and do nothing."""
    return {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}


def literals(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the string literals of a file with their lines."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".js":
        for number, line in enumerate(text.splitlines(), start=1):
            for found in re.finditer(r"""(["'`])([^"'`]*)\1""", line):
                yield number, found.group(2)
        return
    tree = ast.parse(text)
    told = docstrings(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in told:
            yield node.lineno, node.value


def names(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the names that a file of Python gives or uses, with their lines."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Name):
            yield node.lineno, node.id
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg
        elif isinstance(node, ast.Attribute):
            yield node.lineno, node.attr
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.lineno, node.name


@pytest.mark.parametrize("package", ["planner", "app", "static"])
def test_no_robot_arm_or_joint_is_named(package: str) -> None:
    wrong = [
        f"{relative(path)}:{line} says {word!r}"
        for path in SOURCES
        if relative(path).startswith(package)
        for line, word in literals(path)
        if (WORD.fullmatch(word) or ROBOT_WORD.search(word)) and not is_allowed(path, word)
    ]
    assert not wrong, "\n".join(wrong)


def test_no_name_counts_arms_or_joints() -> None:
    wrong = [
        f"{relative(path)}:{line} names {name}"
        for path in SOURCES
        if path.suffix == ".py"
        for line, name in names(path)
        if NAME.fullmatch(name)
    ]
    assert not wrong, "\n".join(wrong)


def test_no_array_has_the_joints_of_one_kind_of_arm() -> None:
    wrong = [
        f"{relative(path)}:{number} {line.strip()}"
        for path in SOURCES
        if relative(path).startswith(COUNTING)
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
        if SHAPE.search(line)
    ]
    assert not wrong, "\n".join(wrong)


def test_nothing_is_unpacked_into_a_left_and_a_right_hand() -> None:
    wrong = [
        f"{relative(path)}:{node.lineno}"
        for path in SOURCES
        if relative(path).startswith(COUNTING) and relative(path) != SIDES_OF_A_LINE
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Tuple) and [ast.unparse(part) for part in node.elts] == ["left", "right"]
    ]
    assert not wrong, "\n".join(wrong)


def test_others_enter_the_room_of_robots_by_its_door() -> None:
    wrong = [
        str(one)
        for one in all_imports()
        if is_within(one.target, "planner.robots")
        and not is_within(one.module, "planner.robots")
        and one.target not in DOOR
    ]
    assert not wrong, "\n".join(wrong)


def test_what_is_allowed_is_still_there() -> None:
    idle = [
        name
        for name, (pattern, _) in ALLOWED.items()
        if not any(re.fullmatch(pattern, word, re.IGNORECASE) for _, word in literals(ROOT / name))
    ]
    assert not idle, f"no exception is needed any more for {idle}"
