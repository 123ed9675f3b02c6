"""All overlays that the board can show to explain a plan."""

from collections.abc import Callable, Collection
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

import numpy as np
from pydantic import BaseModel

from app.document_state import DocumentState
from app.overlays.moment import Moment
from app.overlays.motions import BaseWayAnswer, PathsAnswer, base_overlay, paths_overlay
from app.overlays.reach_region import RegionAnswer, reach_regions
from app.overlays.shortfall import ShortfallAnswer, shortfall_overlay
from app.overlays.slip import SlipAnswer, slip_overlay
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2, Pose2
from planner.geometry.region import Region
from planner.robots.load_robot import load_robot

NOTCH_M, FRINGE_M = 0.04, 0.1
"""Widths below which notches of a reach region are filled, and parts of it left out (m)."""


class RobotAnswer(BaseModel):
    """The base's pose (m, rad)."""

    station: str | None
    back_off_m: float
    pose: Pose2
    outline: list[Point2]
    radius_m: float


class ReachAnswer(BaseModel):
    """The region in which an arm can take cloth on the table, within the comfort radius and without it (m)."""

    arm: str
    comfort_m: float
    regions: list[RegionAnswer]
    bare: list[RegionAnswer]


class OverlaysAnswer(BaseModel):
    """The overlays at one moment, in the garment frame as the garment lies then."""

    version: int
    plan_version: int | None
    t_s: float | None
    primitive: int | None
    done: list[int]
    fold_step: int | None
    placement: Pose2
    robot: RobotAnswer
    table: list[Point2]
    reach: list[ReachAnswer] | None
    slip: SlipAnswer | None
    base: BaseWayAnswer | None
    paths: list[PathsAnswer] | None
    shortfall: ShortfallAnswer | None


def overlays(state: DocumentState, moment: Moment, shown: Collection[str]) -> OverlaysAnswer:
    """Return the overlays at a moment, in the garment frame; those not in `shown` are None."""
    frame = moment.frame
    is_in_order = moment.done == tuple(range(len(moment.done)))
    made = {name: make(moment) if name in shown else None for name, make in OVERLAYS.items()}
    return OverlaysAnswer(
        version=state.version,
        plan_version=state.shown.version if state.shown is not None and moment.plan is not None else None,
        t_s=None if frame is None else frame.t_s,
        primitive=None if frame is None else frame.primitive,
        done=list(moment.done),
        fold_step=len(moment.done) if is_in_order else None,
        placement=moment.placement,
        robot=_robot(moment),
        table=[edge.start for edge in moment.table.edges],
        **made,
    )


def _robot(moment: Moment) -> RobotAnswer:
    card, base = load_robot(moment.robot).card, moment.base_in_garment
    length, width = card.base_size_m
    corners = np.array([(-length, -width), (length, -width), (length, width), (-length, width)]) / 2.0
    return RobotAnswer(
        station=moment.station,
        back_off_m=moment.back_off_m,
        pose=base,
        outline=base.to_outer(corners).tolist(),
        radius_m=card.base_radius_m,
    )


def _reach(moment: Moment) -> list[ReachAnswer]:
    """Return for each arm the region where it can take cloth on the table, with and without the comfort radius."""
    scene, base = moment.scene, moment.base_in_garment
    to_garment = Isometry.rotation(base.yaw_rad, base.x_m, base.y_m)
    ask = partial(reach_regions, load_robot(moment.robot), scene.torso_m, table_height_m=scene.table.height_m)
    with ThreadPoolExecutor() as both:  # uncached it takes long, mostly outside the interpreter
        with_comfort, bare = both.map(ask, (moment.comfort_m, 0.0))
    return [
        ReachAnswer(
            arm=arm.name,
            comfort_m=moment.comfort_m,
            regions=_on_table(moment, with_comfort[number], to_garment),
            bare=_on_table(moment, bare[number], to_garment),
        )
        for number, arm in enumerate(load_robot(moment.robot).card.arms)
    ]


def _on_table(moment: Moment, region: Region, to_garment: Isometry) -> list[RegionAnswer]:
    """Return the part of a region of the base frame that lies on the table, garment frame.

    Close to the base, single orientations reach in between the limits of others. This leaves a fringe of teeth along
    the table's edge, which is useless and left out.
    """
    even = region.evened(NOTCH_M, FRINGE_M).moved(to_garment)
    return [RegionAnswer.of(part) for part in even.intersection(moment.table.region).pieces]


OVERLAYS: dict[str, Callable[[Moment], Any]] = {
    "reach": _reach,
    "slip": slip_overlay,
    "base": base_overlay,
    "paths": paths_overlay,
    "shortfall": shortfall_overlay,
}
"""All overlays by name, with the functions that make them."""
