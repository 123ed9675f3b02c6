"""Limits on the alternatives tried before a step is rejected.

Most plans are found with few tries. More are made only where an untried alternative may hide a quicker plan, or the
only one. The work is counted rather than timed, so that equal tasks get equal answers on every machine.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SearchLimits:
    """The limits of one round.

    Attributes:
        ways: alternatives of a transfer that are tested.
        variants: choices of each step that are combined with those of the others in its transfer.
        alone: failures with one arm after which a transfer is given up.
        together: the same with both arms: their paths take several times as long to find.
        late: transfers longer than estimated that are found before the quickest of them is taken.
        spread: other ways to do the same that are tested once a step is rejected.
        tried: the number of those for which joint paths are searched.
        enough: the number of valid ones among them that suffice.
        vain: failures with both arms after which no more of them are tried.
        failures: failures of the same from one station by the same arms, wherever the cloth lies, after which it is
            given up.
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


QUICK = SearchLimits(
    ways=40, variants=6, alone=8, together=2, late=2, spread=64, tried=12, enough=4, vain=6, failures=5
)
"""The limits of the first round."""

THOROUGH = SearchLimits(
    ways=320, variants=24, alone=32, together=8, late=8, spread=256, tried=48, enough=16, vain=24, failures=20
)
"""The limits where the first round leaves a doubt."""

MORE_TRANSFERS = 160
"""Transfers planned in the second round while there is no plan yet."""
