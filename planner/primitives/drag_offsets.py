"""Find the offsets to which drags can carry an article."""

import numpy as np

from planner.geometry.pose import FloatArray, Point2
from planner.geometry.tolerance import grid_key
from planner.primitives.context import Context
from planner.primitives.drag_grips import arm_drag_steps, dragged


def drag_offsets(context: Context, most: int) -> FloatArray:
    """Return the offsets to which drags can carry the article with a part of it on the table, shape (n, 2), m.

    The search for offsets stops once there are more than `most`.
    """
    table, size = context.scene.table, context.sequence.garment.pattern.bounds
    corners = context.placement.to_outer(np.array([(size[i], size[j]) for i in (0, 2) for j in (1, 3)]))
    low, high = corners.min(axis=0), corners.max(axis=0)
    half = np.array([table.depth_m / 2, table.width_m / 2])
    (x0, y0), (x1, y1) = (-half - high).tolist(), (half - low).tolist()
    steps = [dragged(context, (0.0, 0.0), station, 1) for station in range(len(context.scene.stations))]
    if context.is_fixed:
        steps = list(arm_drag_steps(context, 0))
    found: dict[tuple[int, int], Point2] = {(0, 0): (0.0, 0.0)}
    front = [(0.0, 0.0)]
    while front and len(found) <= most:
        x, y = front.pop()
        for dx, dy in steps:
            after = (x + dx, y + dy)
            key = (grid_key(after[0]), grid_key(after[1]))
            if key not in found and x0 < after[0] < x1 and y0 < after[1] < y1:
                found[key] = after
                front.append(after)
    return np.array(list(found.values()))
