"""Who sends a request, and to which workspace."""

from fastapi import Request

from app.workspace import Workspace


def workspace_of(request: Request) -> Workspace:
    """Return the server's workspace."""
    workspace: Workspace = request.app.state.workspace
    return workspace


def client_of(request: Request) -> str:
    """Return who asks: the address of the client."""
    return "" if request.client is None else request.client.host
