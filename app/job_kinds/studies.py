"""A study as a job: the product of its axes, a plan for each cell, one table and one report."""

import json
import logging
from pathlib import Path
from typing import Any

from app.jobs.job_kind import JobKind, Stores
from app.store.storage_error import storing
from app.store.study_store import StudyStore
from app.studies.garment_entries import Sources
from app.studies.results import Results
from app.studies.run_study import do_study
from app.studies.study import Study
from app.studies.study_file import StudyFields, study_of
from app.studies.table import CSV, PARQUET, TIMING, written_files
from planner.errors import RequestError
from planner.robots.known_robots import require_name

CELLS_LIMIT = 10_000
"""The most cells of a study that a server takes: an hour or so of one core."""

_log = logging.getLogger(__name__)
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
    return study_of(wanted.content, Sources(stores.garments.garment), CELLS_LIMIT), stores.studies.folder


def _finish(stores: Stores, answer: dict[str, Any]) -> dict[str, Any]:
    study_id = answer["study_id"]
    keep_study(stores.studies, study_id)
    paths = {name.replace(".", "_"): f"/api/studies/{study_id}/{name}" for name in (_REPORT, *written_files())}
    return {**answer, "files": paths}


def keep_study(studies: StudyStore, study_id: str) -> bool:
    """Put a study that is done in its folder into the database; return whether there is one.

    Raises:
        StorageError: the system or the database refuses.
        StudyFolderError: the folder holds no results of a study, or they are in use.
    """
    folder = studies.folder / study_id
    if not all((folder / name).is_file() for name in (_REPORT, CSV, TIMING)):
        return False
    with storing(f"study {study_id} could not be kept"):
        with Results(folder) as results:
            study = results.study()
        files = {name: (folder / name).read_bytes() for name in STUDY_FILES if (folder / name).is_file()}
    if study is None:
        return False
    studies.keep(study_id, study.title, json.dumps(study.to_dict()), files)
    return True


STUDIES = JobKind(
    name="studies",
    does="Plan the product of garments, tables, placements and limits (docs/studies.md), as a job.",
    body=StudyFields,
    example={"garments": [{"name": "hand-towel"}], "table": {"height_m": [0.7, 0.8]}},
    prepare=_prepare,
    work=do_study,
    finish=_finish,
    about=lambda asked: asked[0].title,
    path="/api/studies",
    may_begin_anew=True,
)
