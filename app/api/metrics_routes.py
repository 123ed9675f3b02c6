"""The route of the metrics."""

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4, generate_latest
from starlette.responses import Response

from app.api.metrics import Metrics

router = APIRouter(include_in_schema=False)


@router.get("/metrics")
async def read_metrics(request: Request) -> Response:
    """Return the metrics in Prometheus's text format."""
    metrics: Metrics = request.app.state.metrics
    return Response(await run_in_threadpool(generate_latest, metrics.registry), media_type=CONTENT_TYPE_PLAIN_0_0_4)
