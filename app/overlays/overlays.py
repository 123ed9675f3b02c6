"""All overlays that the board can show to explain a plan."""

from collections.abc import Callable, Collection
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

import numpy as np

from app.document_state import DocumentState
from app.overlays.moment import Moment
from app.overlays.motions import base_overlay, paths_overlay
from app.overlays.reach_region import reach_regions, region_to_dict
from app.overlays.shortfall import shortfall_overlay
from app.overlays.slip import slip_overlay
from planner.geometry.isometry import Isometry
from planner.geometry.region import Region
from planner.robots.load_robot import load_robot

NOTCH_M, FRINGE_M = 0.04, 0.1
"""Widths below which notches of a reach region are filled, and parts of it left out (m)."""


def overlays(state: DocumentState, moment: Moment, shown: Collection[str]) -> dict[str, Any]:
    """Return the overlays at a moment, as JSON, in the article frame; those not in `shown` are null."""
    frame = moment.frame
    is_in_order = moment.done == tuple(range(len(moment.done)))
    return {
        "version": state.version,
        "plan_version": state.shown.version if state.shown is not None and moment.plan is not None else None,
        "t_s": None if frame is None else frame.t_s,
        "primitive": None if frame is None else frame.primitive,
        "done": list(moment.done),
        "fold_step": len(moment.done) if is_in_order else None,
        "placement": moment.placement.to_dict(),
        "robot": _robot(moment),
        "table": [list(edge.start) for edge in moment.table.edges],
        **{name: make(moment) if name in shown else None for name, make in OVERLAYS.items()},
    }


def _robot(moment: Moment) -> dict[str, Any]:
    card, base = load_robot(moment.robot).card, moment.base_in_article
    length, width = card.base_size_m
    corners = np.array([(-length, -width), (length, -width), (length, width), (-length, width)]) / 2.0
    return {
        "station": moment.station,
        "back_off_m": moment.back_off_m,
        "pose": base.to_dict(),
        "outline": base.to_outer(corners).tolist(),
        "radius_m": card.base_radius_m,
    }


def _reach(moment: Moment) -> list[dict[str, Any]]:
    """Return for each arm the region where it can take cloth on the table, with and without the comfort radius."""
    scene, base = moment.scene, moment.base_in_article
    to_article = Isometry.rotation(base.yaw_rad, base.x_m, base.y_m)
    ask = partial(reach_regions, load_robot(moment.robot), scene.torso_m, table_height_m=scene.table.height_m)
    with ThreadPoolExecutor() as both:  # uncached it takes long, mostly outside the interpreter
        with_comfort, bare = both.map(ask, (moment.comfort_m, 0.0))
    return [
        {
            "arm": arm.name,
            "comfort_m": moment.comfort_m,
            "regions": _on_table(moment, with_comfort[number], to_article),
            "bare": _on_table(moment, bare[number], to_article),
        }
        for number, arm in enumerate(load_robot(moment.robot).card.arms)
    ]


def _on_table(moment: Moment, region: Region, to_article: Isometry) -> list[dict[str, Any]]:
    """Return the part of a region of the base frame that lies on the table, article frame.

    Close to the base, single orientations reach in between the limits of others. This leaves a fringe of teeth along
    the table's edge, which is useless and left out.
    """
    even = region.evened(NOTCH_M, FRINGE_M).moved(to_article)
    return [region_to_dict(part) for part in even.intersection(moment.table.region).pieces]


OVERLAYS: dict[str, Callable[[Moment], Any]] = {
    "reach": _reach,
    "slip": slip_overlay,
    "base": base_overlay,
    "paths": paths_overlay,
    "shortfall": shortfall_overlay,
}
"""All overlays by name, with the functions that make them."""
