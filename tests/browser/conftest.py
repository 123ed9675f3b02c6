"""Browsers and servers. Most tests do without a 3D view: the page then loads at once and leaves the processor free."""

from collections.abc import Callable, Generator, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, Playwright, expect, sync_playwright

from tests.app.conftest import REST as REST
from tests.app.conftest import Served
from tests.app.conftest import served as served
from tests.browser.status_pill import expect_planned
from tests.patience import wait_until

PATIENCE_MS = 60_000
VIEW_PATIENCE_MS = 60_000
OFF = [
    # Each window renders two pages of the address bar's own: a third of what a blank page takes.
    "WebUIOmniboxPopup",
    "WebUIOmniboxAimPopup",
    # A process is kept in readiness for the next page: a fifth of what a page takes.
    "SpareRendererForSitePerProcess",
    # What Playwright turns off for Chromium, since the last list counts.
    "AimEnabled",
    "AvoidCorsURLLoaderRestartOnRedirect",
    "AvoidUnnecessaryBeforeUnloadCheckSync",
    "DestroyProfileOnBrowserClose",
    "HttpsFirstBalancedModeAutoEnable",
    "HttpsUpgrades",
    "LensOverlay",
    "MediaRouter",
    "NetworkTimeServiceQuerying",
    "OptimizationHints",
    "PaintHolding",
    "PreconnectToSearch",
    "ThirdPartyStoragePartitioning",
]
QUIET = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # In the process of another page a page needs half of what it needs in one of its own.
    "--process-per-site",
    f"--disable-features={','.join(OFF)}",
]
FLAT = [*QUIET, "--disable-gpu"]
BY_SOFTWARE = [*QUIET, "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]

NO_VIEW = """{
  const { set, ...rest } = Object.getOwnPropertyDescriptor(HTMLIFrameElement.prototype, "src");
  const setOther = function (url) { if (!url.includes("/viser/")) set.call(this, url); };
  Object.defineProperty(HTMLIFrameElement.prototype, "src", { ...rest, set: setOther });
}"""
"""Loads no 3D view. Playwright's `route` would keep the page out of the browser's cache, and see each request."""

IN_VIEW = "document.getElementById('view3d').contentWindow.__viserMutable"
IS_THERE = f"(name) => Boolean({IN_VIEW}?.nodeRefFromName[name])"

SELDOM_AND_PLAIN = """
if (location.pathname.includes("/viser/")) {
  window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 400);
  window.cancelAnimationFrame = clearTimeout;
  const made = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, asked) {
    return made.call(this, kind, kind.startsWith("webgl") ? { ...asked, antialias: false } : asked);
  };
}
"""
"""Has the 3D view drawn five times in two seconds, with rough edges: drawn by software it would take all there is."""

Garment = str | dict[str, Any] | None


class Browsers:
    """Browsers that stay open from one module to the next: to start one takes as long as several tests."""

    def __init__(self) -> None:
        self._open = ExitStack()
        self._playwright: Playwright | None = None
        self._by_flags: dict[tuple[str, ...], Browser] = {}

    def opened(self, path: str | None, flags: list[str]) -> Browser:
        """Return the browser with these flags; start it, and Playwright, where that is not done."""
        if self._playwright is None:
            self._playwright = self._open.enter_context(sync_playwright())
        key = tuple(flags)
        if key not in self._by_flags or not self._by_flags[key].is_connected():
            self._by_flags[key] = self._playwright.chromium.launch(executable_path=path, args=flags)
        return self._by_flags[key]

    def close(self) -> None:
        """Close them all: a process can have only one Playwright, and no other event loop can run beside it."""
        self._open.close()
        self._playwright = None
        self._by_flags.clear()


BROWSERS = Browsers()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> Generator[None, object, object]:
    """Close the browsers after a module, unless the next one begins with a test in one of them."""
    result = yield
    if nextitem is None or (nextitem.path != item.path and not {"chromium", "browser"} & set(_fixtures_of(nextitem))):
        BROWSERS.close()
    return result


def _fixtures_of(item: pytest.Item) -> list[str]:
    """Return the names of the fixtures that a test asks for, itself or through others."""
    names: list[str] = getattr(item, "fixturenames", [])
    return names


@pytest.fixture(scope="module")
def chromium(chromium_path: str | None) -> Browser:
    return BROWSERS.opened(chromium_path, FLAT)


@pytest.fixture(scope="module")
def browser(chromium_path: str | None) -> Browser:
    """Return a browser that can draw in three dimensions."""
    return BROWSERS.opened(chromium_path, BY_SOFTWARE)


def new_view_page(browser: Browser) -> Page:
    """Open a small window that can show the 3D view."""
    page = browser.new_page(viewport={"width": 900, "height": 500}, reduced_motion="reduce")
    page.add_init_script(SELDOM_AND_PLAIN)
    page.set_default_timeout(VIEW_PATIENCE_MS)
    return page


@pytest.fixture(scope="module")
def view_window(
    browser: Browser, designer: Served, new_sheet: Callable[[Garment], "Sheet"]
) -> Iterator[tuple[Page, list[str]]]:
    """Open the page on a T-shirt with its 3D view, planned, and record errors and requests to other hosts."""
    faults: list[str] = []
    page = new_view_page(browser)
    expect.set_options(timeout=VIEW_PATIENCE_MS)
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("request", lambda request: faults.append(request.url) if is_foreign(request.url, designer) else None)
    page.goto(new_sheet("t-shirt").page_url)
    expect_planned(page)
    page.wait_for_function(IS_THERE, arg="/cloth/front")
    yield page, faults
    page.close()


@pytest.fixture
def view_page(view_window: tuple[Page, list[str]]) -> Iterator[Page]:
    """Return one page for all tests of a module, since loading takes long; anything wrong in it fails a test."""
    page, faults = view_window
    yield page
    assert faults == []


def is_foreign(url: str, server: Served) -> bool:
    return not url.startswith((server.url, server.url.replace("http", "ws"), "data:", "blob:"))


@pytest.fixture(scope="session")
def designer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    server = Served(tmp_path_factory.mktemp("designer"))
    yield server
    server.stop()


class Sheet:
    """A document on the server."""

    def __init__(self, url: str, document: str) -> None:
        self.page_url = f"{url}/d/{document}"
        self.path = f"{url}/api/documents/{document}"

    @property
    def state(self) -> dict[str, Any]:
        state: dict[str, Any] = REST.get(self.path).json()
        return state

    def at_rest(self) -> dict[str, Any]:
        """Return the document once no gesture is in progress: the server hears of a dropped gesture a little later."""
        return self.once(lambda state: state["gesture"] is None)

    def once(self, is_there: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """Return the document once a condition holds."""

        def there() -> dict[str, Any] | None:
            state = self.state
            return state if is_there(state) else None

        return wait_until(there)

    @property
    def drawing(self) -> dict[str, Any]:
        drawing: dict[str, Any] = self.state["drawing"]
        return drawing

    @property
    def fold_names(self) -> list[str]:
        return [fold["name"] for fold in self.drawing["folds"]]

    @property
    def can_undo(self) -> str | None:
        """The name of the step that would be undone."""
        label: str | None = self.state["history"]["can_undo"]
        return label

    def edit(self, change: Callable[[dict[str, Any]], None]) -> None:
        """Change the drawing without the page."""
        state = self.state
        change(state["drawing"])
        body = {"base_version": state["version"], "label": "Elsewhere", "drawing": state["drawing"]}
        REST.put(f"{self.path}/drawing", json=body).raise_for_status()


@pytest.fixture(scope="session")
def new_sheet(designer: Served) -> Callable[[Garment], Sheet]:
    """Return a function that makes documents: for a garment, or blank."""

    def made(garment: Garment) -> Sheet:
        asked = {} if garment is None else {"garment": garment}
        answer = REST.post(f"{designer.url}/api/documents", json=asked).raise_for_status()
        return Sheet(designer.url, answer.json()["id"])

    return made


@pytest.fixture(scope="module")
def context(chromium: Browser) -> Iterator[BrowserContext]:
    """Return a browser context for all tests of a module: of what the first has loaded the others load little."""
    with windows(chromium) as opened:
        yield opened


@contextmanager
def windows(chromium: Browser, **options: Any) -> Iterator[BrowserContext]:
    """Return windows without a 3D view and without animations; any error in a page fails the test.

    While a garment is planned, drawing the animations by software takes as long as planning it (measured).
    """
    faults: list[str] = []
    usual = {"viewport": {"width": 1280, "height": 800}, "reduced_motion": "reduce"}
    opened = chromium.new_context(**{**usual, **options})
    opened.set_default_timeout(PATIENCE_MS)
    expect.set_options(timeout=PATIENCE_MS)
    opened.add_init_script(NO_VIEW)
    opened.on("weberror", lambda error: faults.append(str(error.error)))
    yield opened
    opened.close()
    assert faults == []


@pytest.fixture(scope="module")
def modules(chromium: Browser, designer: Served) -> Iterator[Page]:
    """Return a page in which nothing runs, from which the page's modules are imported."""
    with windows(chromium) as opened:
        page = opened.new_page()
        page.goto(f"{designer.url}/static/icon.svg")  # of the same origin
        yield page


PHONE: dict[str, Any] = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


@pytest.fixture
def phone(chromium: Browser) -> Iterator[Page]:
    """Return a page on a phone."""
    with windows(chromium, **PHONE) as opened:
        yield opened.new_page()


@pytest.fixture
def page(context: BrowserContext) -> Iterator[Page]:
    """Return a page for one test, which leaves nothing in the browser's storage; any error in it fails the test."""
    faults: list[str] = []
    page = context.new_page()
    page.on("pageerror", lambda error: faults.append(str(error)))
    yield page
    if page.url.startswith("http"):
        page.evaluate("localStorage.clear()")
    page.close()
    assert faults == []
