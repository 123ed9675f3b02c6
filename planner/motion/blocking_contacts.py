"""Find the contact that blocks a motion, and how deep it is even in the best postures.

At some waypoints of the motion, every posture that brings an arm's tool to its pose is tested alone, then all arms'
postures together. At each moment the posture of least penetration counts; the moment at which that is deepest tells
what blocks the motion. If some posture is free at every moment, the postures are merely not connected by a path, and
there is no contact to report.
"""

from collections.abc import Iterator
from itertools import product

import numpy as np

from planner.geometry.pose import FloatArray, Point3, Pose2
from planner.motion.waypoints import Waypoints
from planner.primitives.obstacle import BlockingContact
from planner.robots.armed_robot import ArmedRobot
from planner.robots.card import JointLayout
from planner.robots.collision.collisions import Collisions, Contact

_MOMENTS = 16
"""The number of waypoints tested."""

_POSTURES, _POSTURES_TOGETHER = 16, 5
"""The postures tested of an arm alone, and of each arm when several are tested together."""


class BlockingContacts:
    """The search for contacts that block motions of one robot at one table."""

    def __init__(self, machine: ArmedRobot, collisions: Collisions, torso_m: float, height_m: float) -> None:
        """Keep the robot, the height of its lift and that of the table (m)."""
        self._machine = machine
        self._collisions = collisions
        self._torso_m = torso_m
        self._height_m = height_m
        self._layout = JointLayout.of(machine.card)

    def of(self, waypoints: Waypoints) -> BlockingContact | None:
        """Return the contact that blocks a motion; None where no contact does so by itself."""
        looked_at = np.unique(np.linspace(0, len(waypoints) - 1, _MOMENTS).round().astype(int))
        able = {int(waypoint): self._postures(waypoints, int(waypoint)) for waypoint in looked_at}
        for least in (self._least_alone, self._least_together):
            met = [contact for waypoint, postures in able.items() for contact in least(waypoints, waypoint, postures)]
            if met:
                return max(met, key=lambda contact: contact.depth_m)
        return None

    def _postures(self, waypoints: Waypoints, waypoint: int) -> dict[int, FloatArray]:
        """Return the postures that bring each arm that holds cloth to its tool pose, a row each."""
        return {
            int(arm): self._machine.free_postures(
                int(arm),
                waypoints.positions[arm, waypoint],
                waypoints.rotations[arm, waypoint],
                self._torso_m,
                lambda joints: np.ones(len(joints), dtype=bool),
            )
            for arm in np.flatnonzero(waypoints.is_held[:, waypoint])
        }

    def _least_alone(
        self, waypoints: Waypoints, waypoint: int, postures: dict[int, FloatArray]
    ) -> Iterator[BlockingContact]:
        """Yield, for each arm that touches something in every posture, the least of its contacts."""
        for arm, able in postures.items():
            tried = self._layout.at_home(len(able))
            tried[:, self._layout.spans[arm]] = able
            yield from self._least(waypoints, waypoint, arm, _some(tried, _POSTURES))

    def _least_together(
        self, waypoints: Waypoints, waypoint: int, postures: dict[int, FloatArray]
    ) -> Iterator[BlockingContact]:
        """Yield the least contact if the arms touch something in every combination of their postures."""
        if len(postures) < 2:
            return
        some = [_some(able, _POSTURES_TOGETHER) for able in postures.values()]
        combined = np.array([np.concatenate(chosen) for chosen in product(*some)])
        tried = self._layout.at_home(len(combined))
        if len(tried):
            tried[:, self._layout.joints_of(sorted(postures))] = combined
        yield from self._least(waypoints, waypoint, min(postures), tried)

    def _least(self, waypoints: Waypoints, waypoint: int, arm: int, postures: FloatArray) -> Iterator[BlockingContact]:
        base = Pose2.of(waypoints.bases[waypoint])
        met: list[Contact] = []
        for posture in postures:
            contact = self._collisions.deepest_contact(base, posture)
            if contact is None:
                return
            met.append(contact)
        if met:
            contact = min(met, key=lambda one: one.depth_m)
            point = self._in_table(base, waypoints.positions[arm, waypoint])
            name = self._machine.card.arms[arm].name
            yield BlockingContact(name, point, self._cause(contact), (contact.first, contact.second), contact.depth_m)

    def _in_table(self, base: Pose2, position: FloatArray) -> Point3:
        x, y = base.to_outer(position[:2])
        return float(x), float(y), float(position[2]) - self._height_m

    def _cause(self, contact: Contact) -> str:
        if "table" in contact.second:
            return "table"
        arms = [arm.name for arm in self._machine.card.arms]
        owners = {arm for arm in arms for part in (contact.first, contact.second) if part.startswith(f"{arm} ")}
        return "arms" if len(owners) > 1 else "own_body"


def _some(rows: FloatArray, count: int) -> FloatArray:
    """Return `count` of an array's rows, evenly spread."""
    return rows[np.unique(np.linspace(0, len(rows) - 1, count).round().astype(int))] if len(rows) else rows
