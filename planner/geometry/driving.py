"""The types of a reach query for a base that drives while hands follow their paths, and of its answer."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

STANDOFFS_PER_M = 20
"""The resolution of the grid of standoffs: one every 5 cm (1/m)."""

STANDOFF_STEP_M = 1 / STANDOFFS_PER_M
"""The distance between neighbouring standoffs (m)."""

IMPOSSIBLE = 1 << 20
"""A number of steps that means that there is no way."""

Wanted: TypeAlias = Literal["unbeaten", "every", "any"]
"""The ends wanted: those not reached as quickly by driving on from another end, every end, or any single end."""


@dataclass(frozen=True, slots=True, eq=False)
class Driving:
    """The least total driving for each place on a grid at which the base may stand in the end.

    Attributes:
        steps: the steps of driving, `IMPOSSIBLE` where there is no way or none is wanted, shape (count,).
        first: where the base stands when the hands begin, shape (count,).
        choice: for each hand the number of its approach among those allowed, shape (hands, count).
        more: the least steps of ways not searched yet; `IMPOSSIBLE` where none is left.
    """

    steps: NDArray[np.int64]
    first: NDArray[np.int64]
    choice: NDArray[np.int64]
    more: int

    @property
    def ends(self) -> list[int]:
        """The places at which the base may stand in the end."""
        return [end for end, steps in enumerate(self.steps.tolist()) if steps < IMPOSSIBLE]

    def approaches(self, end: int, allowed: tuple[NDArray[np.int64], ...]) -> tuple[int, ...]:
        """Return the hands' approaches on the way to an end, chosen among those allowed."""
        return tuple(int(of_hand[number]) for of_hand, number in zip(allowed, self.choice[:, end], strict=True))
