"""Shared settings: which tests need a browser, where it is, and the number of random cases."""

import gc
import os
from collections import Counter
from collections.abc import Generator, Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

from tests.app.nursery import be_had
from tests.laws.law import LONG, TRIED
from tests.replay.planned import PLANS

BROWSER_TESTS = Path(__file__).parent / "browser"
EVEN = Path(__file__).parent / "even"
CASES = "cases"
LONGEST_FIRST = ("browser", "laws", "tests", "app", "explain", "robots", "planning", "replay", "motion", "proposals")
"""Folders whose files take longest, in the order in which workers take them: only short ones are left at the end."""

SYSTEM_CHROMIUM = (Path("/usr/bin/chromium-headless-shell"), Path("/usr/bin/chromium"))
"""Without windows of its own, which cost as much again as what the pages need beside their own processes; else with."""

os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, (str(EVEN), os.environ.get("PYTHONPATH"))))

# The same random cases on every machine and run; no deadline, because a shared machine has slow moments.
settings.register_profile(
    "default", derandomize=True, deadline=None, max_examples=50, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile(LONG, settings.get_profile("default"), max_examples=1000)
settings.load_profile("default")


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config: pytest.Config) -> None:
    """Make the folder of plans; let ``--hypothesis-seed`` set the random cases: the profile is loaded afterwards."""
    if not hasattr(config, "workerinput"):
        plans = TemporaryDirectory(prefix="plans")
        os.environ[PLANS] = plans.name
        be_had(plans.name)
        config.add_cleanup(plans.cleanup)
    if config.getoption("hypothesis_seed") is not None:
        for name in ("default", LONG):
            settings.register_profile(name, settings.get_profile(name), derandomize=False)
        settings.load_profile("default")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if BROWSER_TESTS in item.path.parents:
            item.add_marker("browser")
            # A page whose 3D view the processor draws may be starved of it for minutes; the closing line counts reruns.
            if "browser" in getattr(item, "fixturenames", ()):
                item.add_marker(pytest.mark.flaky(reruns=1))
    items.sort(key=lambda item: _turn(item.path))


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Look for no garbage while tests are imported: modules and tests stay, and looking through them takes seconds."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@cache
def _turn(path: Path) -> int:
    """When the tests of a file have their turn: the folder's place in the order above, or after all of them."""
    folder = path.relative_to(BROWSER_TESTS.parent.parent).parts[:-1][:2][-1]
    return LONGEST_FIRST.index(folder) if folder in LONGEST_FIRST else len(LONGEST_FIRST)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """Send the number of cases along with the test's report: it may be made in another process."""
    before = Counter(TRIED)
    try:
        yield
    finally:
        if TRIED - before:
            item.user_properties.append((CASES, dict(TRIED - before)))


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Print how many random cases the laws were tried on, and how many laws failed."""
    tried: Counter[str] = Counter()
    outcomes: Counter[str] = Counter()
    for outcome in ("passed", "failed"):
        for report in terminalreporter.getreports(outcome):
            for name, cases in report.user_properties:
                if name == CASES and report.when == "call":
                    tried.update(cases)
                    outcomes[outcome] += 1
    if tried:
        cases = ", ".join(f"{count:,} {kind} cases" for kind, count in sorted(tried.items()))
        held, failed = outcomes["passed"], outcomes["failed"]
        terminalreporter.write_sep("-", "laws")
        terminalreporter.write_line(f"{cases}: {held} laws held, {failed} failed")


@pytest.fixture(scope="session")
def chromium_path() -> str | None:
    """Return the path of the system's Chromium for Playwright's ``executable_path``; None means Playwright's own."""
    return next((str(path) for path in SYSTEM_CHROMIUM if path.exists()), None)
