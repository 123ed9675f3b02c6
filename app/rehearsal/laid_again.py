"""Lay down again an edge that a fold has left short of its place: pull it there by the top layers alone.

Slack that a fold leaves stays in the part that was folded over, since cloth rubs on cloth: its edge ends short. Hands
come from above, one finger to either side of the ridge that they pinch, and take the layers that the fold has laid down
there and none below: those stay. The edge of a single layer is pulled wherever arms reach. Of several layers each has
an edge that may be seen, so they are pulled no further from the way that they came than the comfort radius.
"""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.rehearsal.corrections import carried_along
from app.rehearsal.laid_edge import LaidEdge
from app.rehearsal.step_seen import StepSeen
from app.rehearsal.world import LAY, GripMotion, StepMotion, way_done
from planner.geometry.pose import Point3
from planner.geometry.reach_query import ReachQuery
from planner.robots.load_robot import load_robot

SHORT_M = 0.012
"""How far short of its place an edge is laid down again (m)."""

_INSIDE_M = 0.01
"""How far inside of an edge fingers pinch it (m)."""

_POINTS = 121
"""The number of points of its planned path from which the distance of a hand is measured."""

_SPEED_M_S, _LEAST_S = 0.05, 0.5
"""How fast hands pull an edge (m/s), and for how long at least (s)."""


def laid_again(seen: StepSeen, edges: Mapping[str, LaidEdge], short_m: Mapping[str, float]) -> StepMotion | None:
    """Return the motion that pulls the edges that a step's fold has laid down to their places.

    None if no edge is so far short, if it is not known of each hand how far, or if one is out of an arm's reach, or too
    far from the way that it came.

    Args:
        seen: the step, and where the stack lies after it.
        edges: the edge beside each hand, by its arm.
        short_m: how far short of its place each is seen, for some arms (m).
    """
    if not short_m or short_m.keys() != edges.keys() or max(short_m.values()) <= SHORT_M:
        return None
    ways = {grip.arm: grip for grip in seen.planned.grips}
    duration_s = max(_LEAST_S, max(short_m.values()) / _SPEED_M_S)
    times_s = (seen.motion.duration_s, seen.motion.duration_s + duration_s)

    def pulled(edge: LaidEdge) -> GripMotion:
        place = np.array(edge.place) - _INSIDE_M * edge.way
        ends = np.array([place - max(0.0, short_m[edge.arm]) * edge.way, place])
        points = np.column_stack([ends, np.full(2, ways[edge.arm].points[-1][2])])
        return GripMotion(edge.arm, times_s, (), layers=edge.layers).along(points)

    grips = tuple(map(pulled, edges.values()))
    if not all(_is_in_reach(seen, grip) for grip in grips):
        return None
    stacked = [grip for grip in grips if edges[grip.arm].layers > 1]
    if max((_apart_m(ways[grip.arm], at) for grip in stacked for at in grip.points), default=0.0) > seen.radius_m:
        return None
    return replace(seen.motion, kind=LAY, duration_s=times_s[1], grips=grips, needs_all=True)


def _apart_m(way: GripMotion, point: Point3) -> float:
    """Return how far a point is from the way of a hand (m)."""
    times_s = np.linspace(way.times_s[0], way.times_s[-1], _POINTS)
    return min(math.dist(way.at(time_s), point) for time_s in times_s.tolist())


def _is_in_reach(seen: StepSeen, grip: GripMotion) -> bool:
    """Return whether an arm reaches all of a hand's motion from where the base stands, in one direction of the hand."""
    scene, points = seen.plan.scene, np.array(grip.points)
    reach = load_robot(seen.plan.task.robot).reach(scene.torso_m, 0.0, is_passing=True)
    above_floor = points[:, 2] + scene.table.height_m
    asked = np.column_stack([seen.step.after.base.pose.to_inner(points[:, :2]), above_floor])
    query = ReachQuery(reach.arm_names.index(grip.arm), asked, np.arange(len(reach.approaches)))
    return bool(reach.from_anywhere(query).all(axis=1).any())


def opened(seen: StepSeen, edges: Mapping[str, LaidEdge], short_m: Mapping[str, float]) -> StepMotion:
    """Return the motion that takes what a step's fold has laid down at its edges, and lays it back where it was.

    Args:
        seen: the step, and where the stack lay before it.
        edges: the edge beside each hand, by its arm.
        short_m: how far short of its place each is seen, for those that are (m).
    """

    def back(grip: GripMotion) -> GripMotion:
        edge, points = edges[grip.arm], np.array(grip.points)[::-1]
        take = np.array(edge.place) - (_INSIDE_M + short_m.get(grip.arm, 0.0)) * edge.way
        points[:, :2] += (1.0 - way_done(points)[:, None]) * (take - points[0, :2])
        last_s = grip.times_s[-1]
        times_s = tuple(seen.motion.duration_s + last_s - time_s for time_s in reversed(grip.times_s))
        return GripMotion(grip.arm, times_s, (), layers=edge.layers).along(points)

    made = carried_along(seen.planned, seen)
    return replace(made, duration_s=2.0 * made.duration_s, grips=tuple(map(back, made.grips)), needs_all=True)
