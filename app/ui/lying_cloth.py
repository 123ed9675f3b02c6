"""A garment spread out before the first step, shown while there is no plan."""

import numpy as np

from planner.cloth.garment import Garment
from planner.geometry.drape import bends, draped
from planner.geometry.region import Region
from planner.geometry.table import Table
from planner.geometry.table_top import TableTop
from planner.geometry.triangles import creased
from planner.motion.sample import ClothSurface


def lying_cloth(garment: Garment, table: Table) -> ClothSurface:
    """Return the garment at its placement, hanging where it extends beyond the table."""
    placed = Region.polygon(garment.placement.to_outer(np.array(garment.outline)).tolist())
    top, height_m = TableTop.of(table), garment.layer_m
    flat = creased(placed.triangles, bends(top, placed.triangles, height_m))[0].reshape(-1, 2)
    unrolled = np.column_stack([flat, np.full(len(flat), height_m)])
    vertices = draped(top, np.column_stack([flat, np.zeros(len(flat))]), height_m)
    triangles = np.arange(len(vertices), dtype=np.int64).reshape(-1, 3)
    return ClothSurface(vertices, triangles, np.zeros(len(triangles), dtype=np.int64), unrolled)
