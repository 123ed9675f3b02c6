"""Websockets that are refused with an answer of their own, as with status 401 or 429.

uvicorn sends such an answer, but does not note that nothing is left to be sent: it logs an error for each.
"""

from typing import Any

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol


class WebSocketProtocol(WebSocketsSansIOProtocol):
    """A websocket that is done with its handshake once it was refused."""

    async def send(self, message: Any) -> None:  # noqa: ANN401
        """Send a message; the last part of a refusal ends the handshake."""
        await super().send(message)
        if message["type"] == "websocket.http.response.body" and not message.get("more_body", False):
            self.handshake_complete = True
