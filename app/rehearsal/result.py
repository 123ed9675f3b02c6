"""The result of a rehearsal: the verdicts of each run, and the share of runs that held."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from app.rehearsal.judge import StepVerdict
from app.rehearsal.trace import RunTrace

if TYPE_CHECKING:
    from app.rehearsal.eyes import Picture

_CONFIDENCE = 0.95


@dataclass(frozen=True, slots=True)
class Decision:
    """A decision of the feedback, with the numbers that it rests on.

    Attributes:
        step: how many steps had been made.
        code: "seen", "not_known", "kept_blindly", "corrected", "aimed", "regrasped", "laid_again", "opened",
            "replanned" or "fold_failed".
        numbers: what it rests on, by name, in SI units.
    """

    step: int
    code: str
    numbers: tuple[tuple[str, float], ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return the decision as JSON."""
        return {"step": self.step, "code": self.code, **dict(self.numbers)}


@dataclass(frozen=True, slots=True)
class Run:
    """The result of performing a plan once.

    Attributes:
        seed: the seed of its noise.
        steps: the verdicts on the steps after which hands were free, in the order in which they were made.
        decisions: what feedback decided, in order.
        reason: why it ended early; "" if it did not.
        simulated_s: the time that passed in the world (s).
        cpu_s: the processor time that it took (s).
        pictures: what was looked at, in order; not in the JSON, since they are large.
        trace: the cloth and the pictures, for people to look at; None unless asked for, and not in the JSON.
    """

    seed: int
    steps: tuple[StepVerdict, ...]
    decisions: tuple[Decision, ...] = ()
    reason: str = ""
    simulated_s: float = 0.0
    cpu_s: float = 0.0
    pictures: tuple["Picture", ...] = ()
    trace: RunTrace | None = None

    @property
    def held(self) -> bool:
        """Whether all steps were made and held."""
        return not self.reason and all(step.held for step in self.steps)

    def count(self, code: str) -> int:
        """Return how often something was decided."""
        return sum(1 for decision in self.decisions if decision.code == code)

    def to_dict(self) -> dict[str, Any]:
        """Return the run as JSON."""
        return {
            "held": self.held,
            "steps": [step.to_dict() for step in self.steps],
            "final_iou": self.steps[-1].iou if self.steps else None,
            "regrasps": self.count("regrasped"),
            "repairs": self.count("laid_again") + self.count("opened"),
            "replans": self.count("replanned"),
            "seed": self.seed,
            "reason": self.reason,
            "decisions": [decision.to_dict() for decision in self.decisions],
            "simulated_s": self.simulated_s,
            "cpu_s": self.cpu_s,
        }


@dataclass(frozen=True, slots=True)
class RehearsalResult:
    """All runs of a rehearsal."""

    runs: tuple[Run, ...]

    @property
    def held(self) -> int:
        """The number of runs that held."""
        return sum(run.held for run in self.runs)

    @property
    def is_held(self) -> bool:
        """Whether all runs held."""
        return self.held == len(self.runs)

    def to_dict(self) -> dict[str, Any]:
        """Return the result as JSON."""
        low, high = success_bounds(self.held, len(self.runs))
        return {
            "runs": [run.to_dict() for run in self.runs],
            "held": self.held,
            "of": len(self.runs),
            "success_low": low,
            "success_high": high,
        }


def success_bounds(held: int, of: int) -> tuple[float, float]:
    """Return the 95 % confidence bounds of a rate of success by Clopper and Pearson, which never promise too much."""
    from scipy.special import betaincinv  # here, because this import takes a third of a second

    tail = (1.0 - _CONFIDENCE) / 2.0
    low = 0.0 if held == 0 else float(betaincinv(held, of - held + 1, tail))
    high = 1.0 if held == of else float(betaincinv(held + 1, of - held, 1.0 - tail))
    return low, high
