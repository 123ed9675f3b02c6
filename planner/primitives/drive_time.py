"""The time of a base that drives or turns from rest to rest."""

from dataclasses import dataclass

from planner.geometry.keyframes import Ramps, least_s, ramps

ACCELERATION_M_S2, TURN_ACCELERATION_RAD_S2 = 0.5, 1.0
"""Accelerations of a base whose card gives none; no card gives that of turning."""


@dataclass(frozen=True, slots=True)
class DriveTime:
    """The speeds and accelerations of a base.

    Attributes:
        speed_m_s, turn_rad_s: its top speeds.
        acceleration_m_s2, turn_acceleration_rad_s2: its top accelerations, slowing down included.
    """

    speed_m_s: float
    turn_rad_s: float
    acceleration_m_s2: float = ACCELERATION_M_S2
    turn_acceleration_rad_s2: float = TURN_ACCELERATION_RAD_S2

    def driving_s(self, distance_m: float) -> float:
        """Return the least time to drive straight over a distance (m), from rest to rest."""
        return least_s(distance_m, self.speed_m_s, self.acceleration_m_s2)

    def turning_s(self, angle_rad: float) -> float:
        """Return the least time to turn in place by an angle (rad), from rest to rest."""
        return least_s(angle_rad, self.turn_rad_s, self.turn_acceleration_rad_s2)

    def ramps(self, distance_m: float, angle_rad: float) -> Ramps:
        """Return how far a leg is done over the least time for it; a leg is driven, or turned in place."""
        driving_s, turning_s = self.driving_s(distance_m), self.turning_s(angle_rad)
        if driving_s >= turning_s:
            way, limits = distance_m, (self.speed_m_s, self.acceleration_m_s2)
        else:
            way, limits = angle_rad, (self.turn_rad_s, self.turn_acceleration_rad_s2)
        return ramps(driving_s + turning_s, way, *limits)
