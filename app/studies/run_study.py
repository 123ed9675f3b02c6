"""Run a study: plan the cells that have no answer yet, keep each answer at once, and write table and report."""

from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass

from app.studies.answer import FAILED, SOLVED, Answer
from app.studies.report import write_report
from app.studies.results import Results
from app.studies.study import Study
from app.studies.table import write_tables
from app.studies.workers import Workers

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
    should_stop: Callable[[], bool] = lambda: False,
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
