"""What the search tells apart: folds done, placement, where the base stands, what is held."""

from dataclasses import dataclass, field
from typing import TypeAlias

from planner.geometry.pose import Point2
from planner.geometry.tolerance import grid_key

HeldKey: TypeAlias = tuple[int, int, int]
"""A grip to the grid: the arm, and where it holds."""

StateKey: TypeAlias = tuple[int, int, int, int, int, tuple[HeldKey, ...], int]
"""A state to the grid: folds done, place (x, y), station, back-off, what is held, and from a drag how long."""


ANYWHERE = -1
"""Instead of a station or a back-off where a state stands for many: the base may stand anywhere."""


@dataclass(frozen=True, slots=True, eq=False)
class Held:
    """One grip that has not been let go.

    Attributes:
        arm: the arm's number, from left to right.
        point: what it holds, article frame (m).
        key: the grip to the grid.
    """

    arm: int
    point: Point2
    key: HeldKey = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Work out the key."""
        object.__setattr__(self, "key", (self.arm, grid_key(self.point[0]), grid_key(self.point[1])))


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """A node of the search. Two states are equal if they agree to the grid.

    Attributes:
        done: the folds finished, as a bit mask.
        offset: how far drags have carried the article since the start, table frame (m).
        station: index of the base's station in the scene's order.
        back_off: how many steps the base has backed off from it.
        held: what is held; empty when the hands are free.
        dragged: how long the drag was from which it is held, in steps of the grid of drags: what a fold really takes
            may depend on that. 0: nothing is held, or from a fold, for a red fold.
        key: all of that, places in steps of the grid.
    """

    done: int
    offset: Point2
    station: int
    back_off: int
    held: tuple[Held, ...] = ()
    dragged: int = 0
    key: StateKey = field(init=False, repr=False)
    _hash: int = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Work out the key: the state to the grid."""
        x, y = self.offset
        held = tuple([h.key for h in self.held])
        key = (self.done, grid_key(x), grid_key(y), self.station, self.back_off, held, self.dragged)
        object.__setattr__(self, "key", key)
        object.__setattr__(self, "_hash", hash(key))

    @property
    def is_dragged(self) -> bool:
        """Whether what is held is held from a drag."""
        return self.dragged > 0

    @property
    def hold(self) -> tuple[object, ...]:
        """What is held, and how far the base has backed off from it; while hands are free that does not matter."""
        return (*(h.key for h in self.held), self.is_dragged, self.back_off) if self.held else ()

    @property
    def grasp(self) -> tuple[object, ...]:
        """What is held, from which station, where the article lies; but not how far the base has backed off."""
        return (self.place, self.station, self.is_dragged, *(h.key for h in self.held))

    @property
    def place(self) -> tuple[int, int]:
        """Where the article lies, in steps of the grid."""
        return self.key[1], self.key[2]

    def __eq__(self, other: object) -> bool:
        """Whether both are the same to the grid."""
        return isinstance(other, State) and self.key == other.key

    def __hash__(self) -> int:
        """The key's hash."""
        return self._hash
