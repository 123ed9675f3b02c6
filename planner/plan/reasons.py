"""Why there is no plan: for each fold that was never done, what stood in its way."""

from dataclasses import dataclass
from typing import Any

from planner.primitives.obstacle import Code
from planner.primitives.work import Work


@dataclass(frozen=True, slots=True)
class Reason:
    """One reason, about one fold or about the whole.

    Attributes:
        fold: the fold's index, or None.
        code: which constraint.
        message: a sentence with the numbers.
    """

    fold: int | None
    code: Code
    message: str

    def to_dict(self) -> dict[str, Any]:
        """The reason as JSON."""
        return {"fold": self.fold, "code": self.code.value, "message": self.message}


def reasons(work: Work, achieved: int) -> tuple[Reason, ...]:
    """The reasons after an exhausted search.

    Args:
        work: the problem, with the obstacles met on the way.
        achieved: the folds that some state reached had done, as a bit mask.
    """
    folds = work.sequence.folds
    missing = [f.index for f in folds if not achieved >> f.index & 1] or [f.index for f in folds]
    found = [reason for fold in missing for reason in _of_fold(work, fold, achieved)]
    blocked = [r for r in found if r.code is not Code.WAITS_FOR_FOLD]
    waiting = [r for r in found if r.code is Code.WAITS_FOR_FOLD]
    return (*blocked, *waiting)


def _of_fold(work: Work, fold: int, achieved: int) -> list[Reason]:
    obstacles = work.obstacles.of(fold)
    if obstacles:
        return [Reason(fold, o.code, o.message) for o in obstacles]
    waits_for = [a for a, b in work.sequence.dag.edges if b == fold and not achieved >> a & 1]
    if not waits_for:
        return []
    label = work.sequence.folds[fold].label
    before = ", ".join(work.sequence.folds[a].label for a in waits_for)
    return [Reason(fold, Code.WAITS_FOR_FOLD, f"{label}: waits for {before}, which cannot be done")]
