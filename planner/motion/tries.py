"""How many ways to do the same are tried before a step is rejected.

Most plans are found with few tries. Only where what was left untried may hide a quicker plan, or a plan at all, is more
tried; and then so much work, counted and not timed, that equal tasks get equal answers on every machine.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Tries:
    """The caps on what is tried.

    Attributes:
        ways: ways to do what a run does that are looked at.
        variants: choices of each step that are combined with those of the others in its run.
        alone: ways in vain with one arm until a run is given up.
        together: the same with both arms: to lead these takes several times as long.
        late: ways that take longer than they seem to, of which the quickest counts.
        spread: other ways to do the same that are looked at once a step is rejected.
        tried: those of them that are tried.
        enough: real ones among them that suffice.
        vain: those that take both arms and are tried in vain until no more are.
        failures: times that the same is tried from a station by the same arms, the cloth here or there, in vain.
    """

    ways: int
    variants: int
    alone: int
    together: int
    late: int
    spread: int
    tried: int
    enough: int
    vain: int
    failures: int


QUICK = Tries(ways=40, variants=6, alone=8, together=2, late=2, spread=64, tried=12, enough=4, vain=6, failures=5)
"""What is tried at first."""

THOROUGH = Tries(
    ways=320, variants=24, alone=32, together=8, late=8, spread=256, tried=48, enough=16, vain=24, failures=20
)
"""What is tried where the first leaves a doubt."""

MORE_RUNS = 160
"""Runs that the arms are led through in the second round, where there is no plan yet."""
