"""Assembly of the server: REST, page, 3D views, guard. Nothing is built at import."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import cache

from fastapi import APIRouter, FastAPI
from fastapi.concurrency import run_in_threadpool
from fastapi_offline import FastAPIOffline
from starlette.exceptions import HTTPException

from app.api import (
    document_routes,
    file_routes,
    garment_routes,
    job_answers,
    job_routes,
    live,
    page_routes,
    plan_routes,
    rehearsal_routes,
    robot_routes,
    scene_routes,
    study_routes,
    suggestion_routes,
    template_routes,
    view_3d_routes,
)
from app.api.client_limits import ClientLimits
from app.api.described import describe
from app.api.document_answers import LiveCommand, LiveMessage
from app.api.guard import OwnNamesOnly
from app.api.middleware import BelowPrefix, HeadAsGet, WholeRequests
from app.api.problems import FailuresAsProblems, Problem, install_problems
from app.api.shared import Shared
from app.api.token_only import TokenOnly
from app.distribution import missing, own_version
from app.job_kinds.kinds import KINDS
from app.server.request_id import RequestIds
from app.settings import Settings
from app.store.access_token import AccessToken
from app.workspace import Workspace


def create_app(settings: Settings, token: AccessToken | None = None) -> FastAPI:
    """Return the server for these settings; documents are opened when it starts to serve.

    Args:
        settings: the settings.
        token: the token to ask for; None: everybody is let in.
    """
    workspace = Workspace(settings, KINDS)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        await run_in_threadpool(workspace.start)
        try:
            yield
        finally:
            await run_in_threadpool(workspace.close)

    app = FastAPIOffline(
        docs_url="/docs",
        redoc_url=None,
        title="Pleat",
        summary="Plans how a robot can really fold a garment.",
        version=own_version(),
        lifespan=lifespan,
    )
    app.state.workspace = workspace
    app.router.routes.extend(_routes().routes)
    page_routes.mount_files(app)
    install_problems(app)
    describe(app, LiveCommand, Problem, LiveMessage, *suggestion_routes.EVENTS, *job_answers.EVENTS)
    app.add_middleware(FailuresAsProblems)
    _measure(app, workspace)
    if token is not None:
        app.add_middleware(TokenOnly, token=token, port=settings.port)
    app.add_middleware(Shared, shares=workspace.shares)
    app.add_middleware(ClientLimits, requests_per_s=settings.requests_per_s, connections=settings.connections)
    app.add_middleware(HeadAsGet)
    app.add_middleware(OwnNamesOnly, settings=settings)
    app.add_middleware(BelowPrefix, prefix=settings.root_path)
    app.add_middleware(WholeRequests)
    app.add_middleware(RequestIds)
    return app


def _measure(app: FastAPI, workspace: Workspace) -> None:
    """Measure the server for `/metrics`; without the library for it, that says what to install."""
    if (lacking := missing("prometheus_client")) is None:
        from app.api.metrics import Measured, Metrics, router

        app.state.metrics = Metrics(workspace)
        app.router.routes.extend(router.routes)
        app.add_middleware(Measured, metrics=app.state.metrics)
        return

    @app.get("/metrics", include_in_schema=False)
    async def read_metrics() -> None:
        raise HTTPException(501, lacking.text)


@cache
def _routes() -> APIRouter:
    """Return all routes; servers share them, since working out what each takes and answers takes .2 s."""
    every = APIRouter()
    for routes in (
        scene_routes,
        garment_routes,
        robot_routes,
        plan_routes,
        suggestion_routes,
        job_routes,
        rehearsal_routes,
        study_routes,
        template_routes,
        document_routes,
        file_routes,
        live,
        view_3d_routes,
        page_routes,
    ):
        every.include_router(routes.router)
    return every
