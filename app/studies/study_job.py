"""A study as a job of the server: in a folder of its own, where it goes on after the server's end."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from app.studies.findings import STATUSES, Findings
from app.studies.results import Results
from app.studies.run_study import Progress, run_study
from app.studies.study import Study
from app.studies.study_error import StudyError, StudyFolderError
from app.studies.workers import InProcess

_ID_LETTERS = 32


def study_id(study: Study) -> str:
    """Return the id of a study: the same study asked for again has the same."""
    return study.digest[:_ID_LETTERS]


def do_study(asked: tuple[Study, Path], progress: Callable[[float, str], None]) -> dict[str, Any]:
    """Plan the cells that have no answer yet, one after the other, in the job's own process.

    Args:
        asked: the study, and the folder of all studies.
        progress: told the share that is done.

    Returns:
        The study's id, and how many cells have which status.

    Raises:
        StudyError: the same study is under way already.
    """
    study, folder = asked

    def tell(now: Progress) -> None:
        progress(now.done / now.count, f"{now.done:,} of {now.count:,} cells")

    try:
        results = Results(folder / study_id(study))
    except StudyFolderError:
        raise StudyError("", "the same study is under way already") from None
    with results:
        results.begin(study, resume=True)
        run_study(study, results, InProcess(), tell)
        counts = Findings(study, results).counts
    return {"study_id": study_id(study), "cells": study.count, "statuses": dict(zip(STATUSES, counts, strict=True))}
