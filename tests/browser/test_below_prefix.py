import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

import pytest
from playwright.sync_api import Browser, expect

from tests.app.conftest import Served
from tests.browser.conftest import IS_THERE, REST, Garment, Sheet, new_view_page
from tests.browser.status_pill import expect_planned

PREFIX = "/tools/pleat"


@contextmanager
def below_prefix(server_port: int) -> Iterator[str]:
    """Return the address of the server below the prefix."""
    listener = socket.create_server(("127.0.0.1", 0))
    port = listener.getsockname()[1]
    threading.Thread(target=_accept, args=(listener, server_port), daemon=True).start()
    try:
        yield f"http://127.0.0.1:{port}{PREFIX}"
    finally:
        listener.close()


def _accept(listener: socket.socket, server_port: int) -> None:
    with suppress(OSError):
        while True:
            browser, _ = listener.accept()
            threading.Thread(target=_serve, args=(browser, server_port), daemon=True).start()


def _serve(browser: socket.socket, server_port: int) -> None:
    """Serve one request for each connection; everything after its head is passed through, websockets too."""
    with browser, suppress(OSError), socket.create_connection(("127.0.0.1", server_port)) as server:
        head, rest = _head(browser)
        if head:
            server.sendall(_rewritten(head, server_port) + rest)
            back = threading.Thread(target=_pump, args=(server, browser), daemon=True)
            back.start()
            _pump(browser, server)
            back.join()


def _head(browser: socket.socket) -> tuple[bytes, bytes]:
    data = b""
    while b"\r\n\r\n" not in data:
        part = browser.recv(65536)
        if not part:
            return b"", b""
        data += part
    head, _, rest = data.partition(b"\r\n\r\n")
    return head, rest


def _rewritten(head: bytes, server_port: int) -> bytes:
    first, *lines = head.decode("latin-1").split("\r\n")
    method, path, version = first.split(" ")
    if not path.startswith(f"{PREFIX}/"):
        path = "/outside-the-prefix"
    headers = dict(line.split(": ", 1) for line in lines)
    named = {name.lower(): name for name in headers}
    host = headers.pop(named["host"])
    if "upgrade" not in named:
        headers.pop(named.get("connection", ""), None)
        headers["Connection"] = "close"
    forwarded = {"Host": f"127.0.0.1:{server_port}", "X-Forwarded-Host": host, "X-Forwarded-Prefix": PREFIX}
    lines = [f"{name}: {value}" for name, value in {**headers, **forwarded}.items()]
    return "\r\n".join([f"{method} {path.removeprefix(PREFIX)} {version}", *lines, "", ""]).encode("latin-1")


def _pump(source: socket.socket, sink: socket.socket) -> None:
    with suppress(OSError):
        while part := source.recv(65536):
            sink.sendall(part)
    with suppress(OSError):
        sink.shutdown(socket.SHUT_WR)


@pytest.mark.long
@pytest.mark.slow
def test_page_3d_view_and_edits_work_below_a_proxys_prefix(
    browser: Browser, designer: Served, new_sheet: Callable[[Garment], Sheet]
) -> None:
    REST.get(new_sheet("t-shirt").page_url).raise_for_status()  # the address without a document leads to the last one
    with below_prefix(designer.port) as url:
        faults: list[str] = []
        page = new_view_page(browser)
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("response", lambda answer: faults.append(answer.url) if answer.status >= 400 else None)
        page.goto(f"{url}/")
        expect_planned(page)
        assert page.url.startswith(f"{url}/d/")
        page.wait_for_function(IS_THERE, arg="/cloth/front")
        page.locator("#garment").select_option("garment:hand-towel")
        expect(page).to_have_title("Hand towel - Pleat")
        expect_planned(page)
        page.goto(f"{url}/docs")
        expect(page.get_by_role("heading", name="Pleat")).to_be_visible()
        expect(page.get_by_text("POST", exact=True).first).to_be_visible()
        page.close()
    assert PREFIX in url and faults == []
