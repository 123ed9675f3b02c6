"""nginx in front of a server, below /pleat/, with the lines that docs/operating.md tells operators to use."""

import os
import re
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.patience import wait_until

PROGRAM = next(filter(Path.exists, (Path("/usr/sbin/nginx"), Path(sys.prefix, "nginx/usr/sbin/nginx"))), None)
PREFIX = "/pleat"

_OPERATING = Path(__file__).parents[1] / "docs" / "operating.md"
_DOCUMENTED_PORT = "127.0.0.1:8000"
_CONFIG = """{user}
pid {folder}/nginx.pid;
error_log {folder}/error.log;
daemon off;
events {{}}
http {{
    access_log off;
    client_body_temp_path {folder}/body;
    proxy_temp_path {folder}/proxy;
    fastcgi_temp_path {folder}/fastcgi;
    uwsgi_temp_path {folder}/uwsgi;
    scgi_temp_path {folder}/scgi;
    server {{
        listen 127.0.0.1:{port};
        {location}
    }}
}}
"""


def documented_location() -> str:
    """Return the location block of docs/operating.md."""
    found = re.search(r"^    location .*?^    }$", _OPERATING.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert found is not None
    return found.group()


@contextmanager
def nginx_before(server_port: int, folder: Path) -> Iterator[str]:
    """Return the address of the server below the prefix; skip where there is no nginx."""
    if PROGRAM is None:
        pytest.skip("there is no nginx")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    location = documented_location()
    assert _DOCUMENTED_PORT in location
    config = _CONFIG.format(
        user="user root;" if os.geteuid() == 0 else "",
        folder=folder,
        port=port,
        location=location.replace(_DOCUMENTED_PORT, f"127.0.0.1:{server_port}"),
    )
    (folder / "nginx.conf").write_text(config, encoding="utf-8")
    with subprocess.Popen([PROGRAM, "-p", folder, "-c", folder / "nginx.conf", "-e", folder / "error.log"]) as nginx:
        try:
            _wait_for(port, nginx, folder)
            yield f"http://127.0.0.1:{port}{PREFIX}"
        finally:
            nginx.terminate()


def _wait_for(port: int, nginx: "subprocess.Popen[bytes]", folder: Path) -> None:
    def listens() -> bool:
        assert nginx.poll() is None, (folder / "error.log").read_text(encoding="utf-8")
        with socket.socket() as wire:
            return wire.connect_ex(("127.0.0.1", port)) == 0

    wait_until(listens)
