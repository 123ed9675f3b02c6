"""A window for all tests of a module, since loading takes long, and garments laid out in it."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page

from tests.app.conftest import Served
from tests.browser.board_desk import Desk
from tests.browser.conftest import windows


@pytest.fixture(scope="module")
def page(chromium: Browser) -> Iterator[Page]:
    with windows(chromium) as context:
        yield context.new_page()


@pytest.fixture(scope="module")
def desk(page: Page, designer: Served) -> Desk:
    return Desk(page, designer)


@pytest.fixture
def shirt(page: Page, desk: Desk) -> Desk:
    desk.lay(desk.garment("t-shirt"))
    return desk


@pytest.fixture
def cloth(page: Page, desk: Desk) -> Desk:
    """Return the T-shirt's outline without its folds, so that nothing is planned."""
    desk.lay({**desk.garment("t-shirt"), "folds": []})
    return desk


@pytest.fixture
def towel(desk: Desk) -> Desk:
    desk.lay(desk.garment("hand-towel"))
    return desk
