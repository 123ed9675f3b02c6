"""Folded cloth as a surface of flat layers, for the 3D view."""

import numpy as np

from app.ui.editor.aids import Pile
from planner.motion.sample import ClothSurface

_GAP_M = 0.0004


def pile_surface(pile: Pile, bottom_m: float) -> ClothSurface:
    """Return the layers stacked on each other, the lowest at a height (m), with their faces the right way up."""
    corners, layers = [], []
    for number, layer in enumerate(pile.cloth.layers):
        flat = layer.region.triangles if layer.face == "front" else layer.region.triangles[:, ::-1]
        placed = pile.placement.to_outer(flat.reshape(-1, 2))
        corners.append(np.column_stack([placed, np.full(len(placed), bottom_m + number * _GAP_M)]))
        layers.append(np.full(len(flat), number, dtype=np.int64))
    vertices = np.concatenate(corners)
    triangles = np.arange(len(vertices), dtype=np.int64).reshape(-1, 3)
    return ClothSurface(vertices, triangles, np.concatenate(layers), vertices)


def height(pile: Pile | None) -> float:
    """Return the height of the stacked layers (m)."""
    return 0.0 if pile is None else len(pile.cloth.layers) * _GAP_M
