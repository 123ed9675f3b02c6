"""How a base may drive to and fro while hands follow their paths: a question about reach, and the answer to it."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

IMPOSSIBLE = 1 << 20
"""A number of steps that stands for "no way"."""

Wanted: TypeAlias = Literal["unbeaten", "every", "any"]
"""Which ends are wanted: those that cannot be had as quickly by driving on from another, every one, or just one."""


@dataclass(frozen=True, slots=True, eq=False)
class Driving:
    """The least steps of driving in all, for each place on a grid at which the base may stand in the end.

    Attributes:
        steps: so many, `IMPOSSIBLE` where there is no way or none that is wanted, shape (count,).
        first: where the base stands when the hands begin, shape (count,).
        choice: for each hand the number of its approach among those that it was allowed, shape (hands, count).
        more: the least steps that a way not looked for yet might take; `IMPOSSIBLE` where none is left.
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
        """The hands' approaches on the way to an end, of those that they were allowed."""
        return tuple(int(of_hand[number]) for of_hand, number in zip(allowed, self.choice[:, end], strict=True))
