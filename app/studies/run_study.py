"""Run a study: plan the cells that have no answer yet, keep each answer at once, and write table and report."""

from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.studies.answer import FAILED, SOLVED, Answer
from app.studies.fields import StudyError, StudyFolderError
from app.studies.findings import STATUSES, Findings
from app.studies.report import write_report
from app.studies.results import Results
from app.studies.study import Study
from app.studies.table import write_tables
from app.studies.workers import InProcess, Workers
from planner.deadline import ShouldStop

OnProgress = Callable[["Progress"], None]


@dataclass(frozen=True, slots=True)
class Progress:
    """The progress of a study.

    Attributes:
        done: the cells that have answers.
        count: all cells.
        begun_with: the cells that had answers at the beginning.
        solved: the cells planned since then that are solved.
        failed: those that failed.
    """

    done: int
    count: int
    begun_with: int = 0
    solved: int = 0
    failed: int = 0

    def after(self, answer: Answer) -> "Progress":
        """Return how far it is after one more answer."""
        status = answer.row["status"]
        is_solved, has_failed = status == SOLVED, status == FAILED
        return Progress(self.done + 1, self.count, self.begun_with, self.solved + is_solved, self.failed + has_failed)


def run_study(
    study: Study,
    results: Results,
    workers: Workers,
    on_progress: OnProgress,
    *,
    keep_plans: bool = False,
    should_stop: ShouldStop = lambda: False,
) -> Progress:
    """Plan a study's cells as far as they have no answers, and write its table and report.

    Args:
        study: the study, which the results have begun.
        results: where answers are kept.
        workers: whatever plans.
        on_progress: called after each answer.
        keep_plans: whether to keep the plans' files.
        should_stop: asked after each answer; true ends the work, as any exception does, with all answers kept.

    Returns:
        How far it came; table and report are of what is known by then.
    """
    indices = study.indices()
    known = frozenset(results.known())
    now = Progress(len(known), len(indices), len(known))
    on_progress(now)
    missing = (index for index in indices if index not in known)
    answers = workers.answers(study.cells(missing), keep_plans=keep_plans) if now.done < now.count else _nothing()
    with closing(answers):
        for answer in answers:
            results.add(answer)
            now = now.after(answer)
            on_progress(now)
            if should_stop():
                break
    write_tables(study, results)
    write_report(study, results)
    return now


def _nothing() -> Generator[Answer]:
    """Yield no answers, so that no workers are started where all are known."""
    yield from ()


_ID_LETTERS = 32


def study_id(study: Study) -> str:
    """Return the id of a study: the same study asked for again has the same."""
    return study.digest[:_ID_LETTERS]


def do_study(asked: tuple[Study, Path], progress: Callable[[float, str], None]) -> dict[str, Any]:
    """Plan the cells that have no answer yet, one after the other, in the job's own process.

    Args:
        asked: the study, and the folder of all studies.
        progress: called with the share that is done.

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
