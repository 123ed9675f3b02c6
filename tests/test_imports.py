"""The rooms of docs/architecture.md: allowed imports, and the home of each library."""

import ast
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parent.parent

# Modules of planner that stand outside the rooms and that every room but search may use.
GROUND = frozenset(
    {
        "planner.deadline",
        "planner.errors",
        "planner.message",
        "planner.strict_model",
        "planner.json_form",
        "planner.kernels",
    }
)

_ROOMS_BELOW_MOTION = ("geometry", "words", "cloth", "folds", "task", "primitives", "robots")
BELOW_MOTION = GROUND | {f"planner.{room}" for room in _ROOMS_BELOW_MOTION}

# The ladder: what each room may see besides itself.
MAY_SEE: Mapping[str, frozenset[str]] = {
    "planner.deadline": frozenset(),
    "planner.message": frozenset(),
    "planner.kernels": frozenset(),
    "planner.user_cache": frozenset(),
    "planner.kernel_cache": frozenset({"planner.user_cache"}),
    "planner.errors": frozenset({"planner.message"}),
    "planner.strict_model": frozenset({"planner.errors"}),
    "planner.json_form": frozenset({"planner.errors", "planner.strict_model"}),
    "planner.search": frozenset(),
    "planner.geometry": GROUND,
    "planner.robots": GROUND | {"planner.geometry", "planner.user_cache"},
    "planner.words": GROUND | {"planner.geometry"},
    "planner.cloth": GROUND | {"planner.geometry", "planner.words"},
    "planner.folds": GROUND | {"planner.geometry", "planner.cloth"},
    "planner.task": GROUND | {"planner.geometry", "planner.cloth", "planner.folds"},
    "planner.primitives": GROUND | {f"planner.{r}" for r in ("geometry", "words", "cloth", "folds", "task")},
    "planner.motion": BELOW_MOTION,
    "planner.planning": BELOW_MOTION | {"planner.kernel_cache", "planner.motion", "planner.search"},
    "planner.explain": BELOW_MOTION | {"planner.motion", "planner.search", "planner.planning"},
    "planner.plans": BELOW_MOTION | {"planner.motion", "planner.planning", "planner.explain"},
    "planner.proposals": BELOW_MOTION | {"planner.planning", "planner.plans"},
}

# Where a library may be imported; libraries not named here may be imported anywhere.
LIBRARY_HOMES: Mapping[str, tuple[str, ...]] = {
    "shapely": ("planner.geometry",),
    "networkx": ("planner.folds", "planner.primitives"),
    "pinocchio": ("planner.robots",),
    "coal": ("planner.robots",),
    "numba": ("planner.kernels", "planner.robots"),
    "yourdfpy": ("app.ui",),
    "trimesh": ("planner.robots", "app.ui"),
    "viser": ("app.ui",),
    "svg": ("app.files",),
    "rosbags": ("app.files",),
    "matplotlib": ("app.files",),
    "ruamel": ("app.files",),
    "ezdxf": ("app.files",),
    "cv2": ("app.rehearsal.camera", "app.rehearsal.vision"),
    "xacro": ("app.files",),
    "lerobot": ("app.drivers",),
    "rtde_control": ("app.drivers",),
    "rtde_receive": ("app.drivers",),
    "sqlalchemy": ("app.store",),
    "alembic": ("app.store",),
    "prometheus_client": ("app.api",),
    "av": ("app.files",),
    "pyarrow": ("app.studies", "app.files"),
    "distributed": ("app.studies",),
    "mujoco": ("app.rehearsal.physics", "app.files.mjcf"),
    "pxr": ("app.files",),
    "fastapi": ("app.api",),
    "fastapi_offline": ("app.api",),
    "starlette": ("app.api", "app.server"),
    "uvicorn": ("app.server", "app.cli"),
    "typer": ("app.cli",),
}


class Import(NamedTuple):
    """An import: the importing module, the line, and the dotted name."""

    module: str
    path: Path
    line: int
    target: str

    def __str__(self) -> str:
        return f"{self.path.relative_to(ROOT)}:{self.line} imports {self.target}"


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


SOURCES = {module_name(path): path for package in ("planner", "app") for path in (ROOT / package).rglob("*.py")}


def imports_of(module: str, path: Path) -> Iterator[Import]:
    """Return every import in a file, also those in functions; `from a import b` counts as a.b if that is a module."""
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (Import(module, path, node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            outer = package.split(".")[: len(package.split(".")) + 1 - node.level] if node.level else []
            source = ".".join([*outer, node.module] if node.module else outer)
            for alias in node.names:
                inner = f"{source}.{alias.name}"
                yield Import(module, path, node.lineno, inner if inner in SOURCES else source)


@cache
def all_imports() -> tuple[Import, ...]:
    """Return every import of the sources, read when a test first asks: each worker of the tests collects this file."""
    return tuple(one for module, path in sorted(SOURCES.items()) for one in imports_of(module, path))


def is_within(module: str, room: str) -> bool:
    return module == room or module.startswith(f"{room}.")


def rooms_of(module: str) -> list[str]:
    return [room for room in MAY_SEE if is_within(module, room)]


def test_every_module_of_the_planner_is_in_one_room() -> None:
    homeless = [m for m in SOURCES if is_within(m, "planner") and m != "planner" and len(rooms_of(m)) != 1]
    assert not homeless, f"no room of the ladder holds {homeless}"


@pytest.mark.parametrize("room", MAY_SEE)
def test_a_room_imports_only_rooms_further_down_the_ladder(room: str) -> None:
    allowed = MAY_SEE[room] | {room}
    wrong = [
        str(one)
        for one in all_imports()
        if is_within(one.module, room)
        and is_within(one.target, "planner")
        and not any(is_within(one.target, seen) for seen in allowed)
    ]
    assert not wrong, f"{room} may see only {sorted(allowed)}: {wrong}"


def test_planning_imports_nothing_of_explain_whatever_it_imports() -> None:
    below: dict[str, set[str]] = {}
    for one in all_imports():
        below.setdefault(one.module, set()).add(one.target)
    seen, waiting = set[str](), [module for module in SOURCES if is_within(module, "planner.planning")]
    while waiting:
        module = waiting.pop()
        if module not in seen:
            seen.add(module)
            waiting += below.get(module, ())
    assert not [module for module in seen if is_within(module, "planner.explain")]


def test_the_planner_knows_nothing_of_the_app() -> None:
    wrong = [str(one) for one in all_imports() if is_within(one.module, "planner") and is_within(one.target, "app")]
    assert not wrong, wrong


@pytest.mark.parametrize("library", LIBRARY_HOMES)
def test_a_library_is_imported_only_where_it_lives(library: str) -> None:
    homes = LIBRARY_HOMES[library]
    wrong = [
        str(one)
        for one in all_imports()
        if is_within(one.target, library) and not any(is_within(one.module, home) for home in homes)
    ]
    assert not wrong, f"{library} lives in {', '.join(homes)}: {wrong}"


def test_no_modules_import_each_other_in_a_circle() -> None:
    below: dict[str, list[str]] = {module: [] for module in SOURCES}
    for one in all_imports():
        if one.target in SOURCES and one.target != one.module:
            below[one.module].append(one.target)
    finished: set[str] = set()

    def circle_from(module: str, above: tuple[str, ...]) -> tuple[str, ...] | None:
        if module in above:
            return (*above[above.index(module) :], module)
        if module in finished:
            return None
        for target in below[module]:
            if circle := circle_from(target, (*above, module)):
                return circle
        finished.add(module)
        return None

    circles = [" -> ".join(c) for module in SOURCES if (c := circle_from(module, ()))]
    assert not circles, circles[0]


def test_no_module_is_named_for_being_handy() -> None:
    handy = {"utils", "util", "helpers", "helper", "manager", "base", "common", "misc"}
    wrong = [str(path.relative_to(ROOT)) for path in SOURCES.values() if path.stem in handy]
    assert not wrong, f"a module is named for its noun or its verb: {wrong}"


STARTERS = ("multiprocessing", "subprocess", "concurrent.futures.process")


def test_only_the_workers_start_processes() -> None:
    starts = [one for one in all_imports() if any(is_within(one.target, starter) for starter in STARTERS)]
    assert {one.module.rpartition(".")[0] for one in starts} == {"app.worker"}, [*map(str, starts)]
    pools = [str(path) for path in SOURCES.values() if "ProcessPoolExecutor" in path.read_text(encoding="utf-8")]
    assert not pools, pools
