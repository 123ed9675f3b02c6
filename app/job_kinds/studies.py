"""A study as a job: the product of its axes, a plan for each cell, one table and one report."""

from pathlib import Path
from typing import Any

from app.jobs.job_kind import JobKind, Stores
from app.studies.garment_entries import Sources
from app.studies.study import Study
from app.studies.study_fields import StudyFields
from app.studies.study_file import study_of
from app.studies.study_job import do_study
from app.studies.table import CSV, PARQUET, TIMING
from planner.errors import RequestError
from planner.robots.known_robots import require_name

CELLS_LIMIT = 10_000
"""The most cells of a study that a server takes: an hour or so of one core."""

_REPORT = "report.html"
STUDY_FILES = {
    _REPORT: "text/html; charset=utf-8",
    CSV: "text/csv; charset=utf-8",
    TIMING: "text/csv; charset=utf-8",
    PARQUET: "application/vnd.apache.parquet",
}
"""The files of a study, and their media types."""


def _prepare(stores: Stores, wanted: StudyFields) -> tuple[Study, Path]:
    for number, robot in enumerate(wanted.robots or ()):
        try:
            require_name(robot)  # the path of a card would name the server's own files
        except RequestError as error:
            raise RequestError(f"robots[{number}]", error.message) from None
    return study_of(wanted.content, Sources(stores.garments.garment), CELLS_LIMIT), stores.studies


def _finish(_: Stores, answer: dict[str, Any]) -> dict[str, Any]:
    paths = {name.replace(".", "_"): f"/api/studies/{answer['study_id']}/{name}" for name in STUDY_FILES}
    return {**answer, "files": paths}


STUDIES = JobKind(
    name="studies",
    does="Plan the product of garments, tables, placements and limits (docs/studies.md), as a job.",
    body=StudyFields,
    example={"garments": [{"name": "hand-towel"}], "table": {"height_m": [0.7, 0.8]}},
    prepare=_prepare,
    work=do_study,
    finish=_finish,
    path="/api/studies",
    may_begin_anew=True,
)
