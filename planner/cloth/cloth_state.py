"""The cloth as a stack of layers, bottom to top."""

from collections.abc import Sequence
from functools import cached_property, lru_cache

from planner.cloth.layer import Layer
from planner.errors import FoldError
from planner.geometry.isometry import Isometry
from planner.geometry.region import Region

LAYERS_MAX = 2000
"""The most layers that a stack may have."""

_SPREAD_OUT_KEPT = 16


class ClothState:
    """A stack of layers in the garment frame; never changed after it is made.

    Attributes:
        layers: from bottom to top.
        moved: the number of top layers that the last fold moved; 0 before the first fold.
        slivers: the areas of the pieces that folding has dropped so far as too small to count as cloth (m^2).
    """

    def __init__(self, layers: Sequence[Layer], moved: int = 0, slivers: Sequence[float] = ()) -> None:
        if len(layers) > LAYERS_MAX:
            raise FoldError("", f"leaves {len(layers)} layers, more than {LAYERS_MAX}")
        self.layers = tuple(layers)
        self.moved = moved
        self.slivers = tuple(slivers)

    @staticmethod
    def spread_out(pattern: Region) -> "ClothState":
        """Return the cloth as it lies at the start: one layer, front face up. The latest results are cached."""
        return spread_out(pattern.to_bytes())

    @cached_property
    def silhouette(self) -> Region:
        """The region that the whole stack covers, garment frame."""
        return Region.union(layer.region for layer in self.layers)

    @property
    def flap(self) -> tuple[Layer, ...]:
        """The layers that the last fold moved, bottom to top."""
        return self.layers[len(self.layers) - self.moved :]

    @cached_property
    def area(self) -> float:
        """The summed area of all layers (m^2)."""
        return sum(layer.area for layer in self.layers)


@lru_cache(_SPREAD_OUT_KEPT)
def spread_out(pattern: bytes) -> ClothState:
    """Return one layer of a pattern given in the form of `Region.to_bytes`; see `ClothState.spread_out`."""
    return ClothState([Layer(Region.from_bytes(pattern), Isometry())])
