"""Metrics for Prometheus: latency by route, what waits and runs in each lane, open documents, the process itself."""

import time
from collections.abc import Iterator

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from prometheus_client import CollectorRegistry, Counter, Histogram, ProcessCollector
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4, generate_latest
from prometheus_client.metrics_core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.workspace import Workspace

router = APIRouter(include_in_schema=False)

_BUCKETS_S = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0)
_NO_ROUTE = "none"
"""The label of requests to no route, whose paths anybody can make up."""


class Metrics:
    """The metrics of one server.

    Attributes:
        registry: what `/metrics` shows.
    """

    def __init__(self, workspace: Workspace) -> None:
        """Start all counters at zero."""
        self.registry = CollectorRegistry()
        ProcessCollector(registry=self.registry)
        self.registry.register(_Work(workspace))
        labels = ("method", "route")
        self.latency = Histogram(
            "pleat_request_seconds",
            "Time from a request to the beginning of its answer.",
            labels,
            buckets=_BUCKETS_S,
            registry=self.registry,
        )
        self.answers = Counter("pleat_answers", "Answers by status.", (*labels, "status"), registry=self.registry)


class _Work(Collector):
    """Reads off the work of a server when it is asked."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace

    def collect(self) -> Iterator[Metric]:
        waiting = GaugeMetricFamily("pleat_lane_waiting", "Work that waits, by lane.", labels=("lane",))
        running = GaugeMetricFamily("pleat_lane_running", "Work that runs, by lane.", labels=("lane",))
        ended = CounterMetricFamily("pleat_lane_ended", "Work that has ended, by lane.", labels=("lane",))
        for lane, (waits, runs, so_far) in self._workspace.lanes.load().items():
            waiting.add_metric((lane,), waits)
            running.add_metric((lane,), runs)
            ended.add_metric((lane,), so_far)
        yield from (waiting, running, ended)
        yield GaugeMetricFamily("pleat_open_documents", "Open documents.", value=self._workspace.open_count)


class Measured:
    """Middleware that measures how long each route takes to answer."""

    def __init__(self, app: ASGIApp, metrics: Metrics) -> None:
        """Wrap the routes."""
        self._app = app
        self._metrics = metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Call the routes, and note when the answer begins."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        began_s = time.perf_counter()

        async def send_noted(message: Message) -> None:
            if message["type"] == "http.response.start":
                labels = (scope["method"], _route(scope))
                self._metrics.latency.labels(*labels).observe(time.perf_counter() - began_s)
                self._metrics.answers.labels(*labels, str(message["status"])).inc()
            await send(message)

        await self._app(scope, receive, send_noted)


def _route(scope: Scope) -> str:
    return str(getattr(scope.get("route"), "path", _NO_ROUTE))


@router.get("/metrics")
async def read_metrics(request: Request) -> Response:
    """Return the metrics in Prometheus's text format."""
    metrics: Metrics = request.app.state.metrics
    return Response(await run_in_threadpool(generate_latest, metrics.registry), media_type=CONTENT_TYPE_PLAIN_0_0_4)
