"""The page's websocket: the document's state goes out, commands come in.

Out: a ``document`` message at the start and whenever garment or plan change, a ``playback`` message whenever
the clock is touched and ten times a second while it runs. In: commands (`app.api.messages`); one that is not
understood is answered with a ``problem`` and changes nothing.
"""

import asyncio
import contextlib

from fastapi import APIRouter, WebSocket
from fastapi.concurrency import run_in_threadpool
from pydantic import ValidationError
from starlette.websockets import WebSocketDisconnect

from app.api.body import parsed
from app.api.live_messages import document_message, playback_message, problem_message
from app.api.messages import COMMANDS, Choose, Pause, Play, Seek, SetSpeed, SetTheme
from app.document import Document
from app.open_document import UnknownDocumentError
from app.workspace import Workspace
from planner.errors import FoldingError, RequestError
from planner.strict_model import first_error

router = APIRouter()

_NOT_FOUND = 4404
_TICK_S = 0.1


@router.websocket("/api/documents/{name}/live")
async def live(websocket: WebSocket, name: str) -> None:
    """Keep a page up to date and do what it says, until it goes."""
    workspace: Workspace = websocket.app.state.workspace
    try:
        document = workspace.opened(name).document
    except UnknownDocumentError:
        await websocket.close(_NOT_FOUND)
        return
    await websocket.accept()
    ways = [
        asyncio.create_task(_tell(websocket, name, document)),
        asyncio.create_task(_listen(websocket, workspace, document)),
    ]
    try:
        await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for way in ways:
            way.cancel()
        await asyncio.gather(*ways, return_exceptions=True)


async def _tell(websocket: WebSocket, name: str, document: Document) -> None:
    changed = asyncio.Event()
    loop = asyncio.get_running_loop()

    def wake() -> None:
        with contextlib.suppress(RuntimeError):  # the loop has ended
            loop.call_soon_threadsafe(changed.set)

    unsubscribe = document.subscribe(wake)
    told: tuple[object, ...] = ()
    try:
        while True:
            changed.clear()
            state = document.state
            current = (state.version, state.plan, state.problem)
            if current != told:
                told = current
                await websocket.send_json(await run_in_threadpool(document_message, name, state))
            await websocket.send_json(playback_message(state, document.t_s))
            timeout_s = _TICK_S if state.playback.is_playing else None
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(changed.wait(), timeout_s)
    except (WebSocketDisconnect, RuntimeError):
        return
    finally:
        unsubscribe()


async def _listen(websocket: WebSocket, workspace: Workspace, document: Document) -> None:
    with contextlib.suppress(WebSocketDisconnect, KeyError):
        while True:
            text = await websocket.receive_text()
            try:
                await run_in_threadpool(_obey, text, workspace, document)
            except FoldingError as error:
                await websocket.send_json(problem_message(error))


def _obey(text: str, workspace: Workspace, document: Document) -> None:
    try:
        command = COMMANDS.validate_python(parsed(text))
    except ValidationError as error:
        raise first_error(error, RequestError) from None
    match command:
        case Play():
            document.play()
        case Pause():
            document.pause()
        case Seek(t_s=t_s):
            document.seek(t_s)
        case SetSpeed(speed=speed):
            document.set_speed(speed)
        case SetTheme(dark=is_dark):
            document.set_theme(is_dark=is_dark)
        case Choose(garment=name):
            document.choose(workspace.garments.garment(name))
