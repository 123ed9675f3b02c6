"""The states of the search: folds done, placement, where the base stands, what is held."""

from dataclasses import dataclass, field
from typing import TypeAlias

from planner.geometry.pose import Point2
from planner.geometry.tolerance import grid_key

HeldKey: TypeAlias = tuple[int, int, int]
"""A grip on the grid: the arm, and the point that it holds."""

StateKey: TypeAlias = tuple[int, int, int, int, int, tuple[HeldKey, ...], int]
"""A state on the grid: folds done, place (x, y), station, standoff, grips held, length of the drag they come from."""


ANYWHERE = -1
"""A station or standoff that is not fixed, in a state that stands for many."""


UNDRAGGED: Point2 = (0.0, 0.0)
"""The offset of cloth that has not been dragged (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class Held:
    """A grip that has not been let go.

    Attributes:
        arm: the arm's number, from left to right.
        point: the point held, garment frame (m).
        key: the grip on the grid.
    """

    arm: int
    point: Point2
    key: HeldKey = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "key", (self.arm, grid_key(self.point[0]), grid_key(self.point[1])))


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """A node of the search. Two states are equal if they agree on the grid.

    Attributes:
        done: the folds finished, as a bit mask.
        offset: how far drags have carried the garment since the start, table frame (m).
        station: index of the base's station in the scene's order.
        standoff: how many grid steps the base stands back from its station.
        held: the grips held; empty when the hands are.
        dragged: the length of the drag from which they are held, in steps of the grid of drags; a fold's real duration
            may depend on it. 0 if nothing is held, or if a fold left them held for a red fold.
        key: all of that, places in steps of the grid.
    """

    done: int
    offset: Point2
    station: int
    standoff: int
    held: tuple[Held, ...] = ()
    dragged: int = 0
    key: StateKey = field(init=False, repr=False)
    _hash: int = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Compute the key: the state on the grid."""
        x, y = self.offset
        held = tuple([h.key for h in self.held])
        key = (self.done, grid_key(x), grid_key(y), self.station, self.standoff, held, self.dragged)
        object.__setattr__(self, "key", key)
        object.__setattr__(self, "_hash", hash(key))

    @property
    def is_dragged(self) -> bool:
        """Whether the grips are held from a drag."""
        return self.dragged > 0

    @property
    def hold(self) -> tuple[object, ...]:
        """The grips held, and the standoff; empty while nothing is held, because the standoff then does not matter."""
        return (*(h.key for h in self.held), self.is_dragged, self.standoff) if self.held else ()

    @property
    def grasp(self) -> tuple[object, ...]:
        """The grips held, the station and the garment's place, but not the standoff."""
        return (self.place, self.station, self.is_dragged, *(h.key for h in self.held))

    @property
    def place(self) -> tuple[int, int]:
        """The garment's place, in steps of the grid."""
        return self.key[1], self.key[2]

    def __eq__(self, other: object) -> bool:
        """Return whether both states are the same on the grid."""
        return isinstance(other, State) and self.key == other.key

    def __hash__(self) -> int:
        """Return the key's hash."""
        return self._hash
