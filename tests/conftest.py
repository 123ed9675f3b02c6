"""What all tests share: which need a browser, where it is, and how many random cases are tried."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

BROWSER_TESTS = Path(__file__).parent / "browser"
SYSTEM_CHROMIUM = Path("/usr/bin/chromium")

# The same random cases on every machine and run; no deadline, because a shared machine has slow moments.
settings.register_profile(
    "default", derandomize=True, deadline=None, max_examples=50, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("long", settings.get_profile("default"), derandomize=False, max_examples=1000)
settings.load_profile("default")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if BROWSER_TESTS in item.path.parents:
            item.add_marker("browser")


@pytest.fixture(scope="session")
def chromium_path() -> str | None:
    """The system's Chromium for Playwright's ``executable_path``; None means Playwright's own."""
    return str(SYSTEM_CHROMIUM) if SYSTEM_CHROMIUM.exists() else None
