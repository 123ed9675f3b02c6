"""A garment that lies spread out before anything has been done to it: what is seen while there is no plan."""

import numpy as np

from planner.cloth.garment import Garment
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.table import Table
from planner.geometry.table_top import TableTop
from planner.plan.frame import ClothSurface

_HEIGHT_M = 0.0015


def lying_cloth(garment: Garment, table: Table) -> ClothSurface:
    """The garment at its placement, hanging where it goes beyond the table."""
    placed = Region.polygon(garment.placement.to_outer(np.array(garment.outline)).tolist())
    top = TableTop.of(table)
    pieces: tuple[Region, ...] = (placed,)
    for edge in top.edges:
        pieces = tuple(part for piece in pieces for part in _halves(piece, edge))
    flat = np.concatenate([piece.triangles for piece in pieces]).reshape(-1, 2)
    vertices = top.over_edge(np.column_stack([flat, np.zeros(len(flat))]), _HEIGHT_M)
    triangles = np.arange(len(vertices), dtype=np.int64).reshape(-1, 3)
    return ClothSurface(vertices, triangles, np.zeros(len(triangles), dtype=np.int64))


def _halves(region: Region, edge: Segment) -> tuple[Region, ...]:
    return (*region.left_of(edge).pieces, *region.left_of(edge.reversed).pieces)
