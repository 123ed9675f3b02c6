"""A process that watches a 3D view: ``python -m bench.viewers PORT SECRET COUNT``.

Each viewer is a client of viser's protocol on a websocket of its own and reads all messages. Once all viewers have the
scene, the process prints a line; when standard input ends, it prints as JSON how much each has read, and disconnects.
"""

import asyncio
import json
import sys

import viser
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Subprotocol

from app.ui.viser_patches import LOOPBACK, SECRET_HEADER

READY = "watching"
QUIET_S = 0.5
"""Silence after which a viewer has the whole scene (s)."""

SUBPROTOCOL = Subprotocol(f"viser-v{viser.__version__}")


async def watch(port: int, secret: str, count: int) -> None:
    """Connect `count` viewers, and read until standard input ends."""
    address, headers = f"ws://{LOOPBACK}:{port}", {SECRET_HEADER: secret}
    connections = [
        await connect(address, subprotocols=[SUBPROTOCOL], additional_headers=headers, proxy=None, max_size=None)
        for _ in range(count)
    ]
    await asyncio.gather(*(_read_scene(connection) for connection in connections))
    print(READY, flush=True)
    readers = [asyncio.create_task(_read(connection)) for connection in connections]
    await asyncio.to_thread(sys.stdin.read)
    for connection in connections:
        await connection.close()
    print(json.dumps([{"messages": messages, "bytes": size} for messages, size in await asyncio.gather(*readers)]))


async def _read_scene(connection: ClientConnection) -> None:
    """Read the scene that is there already."""
    await connection.recv()
    try:
        while True:
            async with asyncio.timeout(QUIET_S):
                await connection.recv()
    except TimeoutError:
        return


async def _read(connection: ClientConnection) -> tuple[int, int]:
    """Read until the connection is closed; return the number of messages and bytes."""
    messages, size = 0, 0
    async for message in connection:
        messages, size = messages + 1, size + len(message)
    return messages, size


if __name__ == "__main__":
    asyncio.run(watch(int(sys.argv[1]), sys.argv[2], int(sys.argv[3])))
