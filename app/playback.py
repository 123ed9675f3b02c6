"""The playback of a plan: a clock that can be started, stopped, moved and sped up.

It is an immutable value with the plan's time at one instant of the wall clock and its speed since. So reading the time
changes nothing, and any number of viewers agree.
"""

from dataclasses import dataclass, replace

SPEED_MIN, SPEED_MAX = 0.1, 20.0
"""Range of the playback's speed (seconds of the plan per second)."""


@dataclass(frozen=True, slots=True)
class Playback:
    """The state of a plan's playback.

    Attributes:
        duration_s: the plan's duration (s); 0 without a plan.
        t_s: the time in the plan at the instant `since_s` (s). If a plan becomes shorter, it keeps its value beyond the
            end, and holds again once the plan is longer.
        since_s: an instant of the wall clock (s).
        is_playing: whether time runs.
        speed: seconds of the plan per second.
    """

    duration_s: float = 0.0
    t_s: float = 0.0
    since_s: float = 0.0
    is_playing: bool = False
    speed: float = 1.0

    def at(self, now_s: float) -> float:
        """Return the time in the plan, within its duration (s)."""
        ran_s = self.speed * (now_s - self.since_s) if self.is_playing else 0.0
        return min(max(self.t_s + ran_s, 0.0), self.duration_s)

    def lasting(self, now_s: float, duration_s: float) -> "Playback":
        """Return the playback of another plan with this duration (s), at the same time."""
        t_s = self.at(now_s) if self.is_playing else self.t_s
        is_playing = self.is_playing and duration_s > 0.0
        return replace(self, duration_s=duration_s, t_s=t_s, since_s=now_s, is_playing=is_playing)

    def has_ended(self, now_s: float) -> bool:
        """Return whether the plan has been played to its end."""
        return self.at(now_s) >= self.duration_s

    def played(self, now_s: float) -> "Playback":
        """Return the playback running; restart it if it was at the end."""
        start_s = 0.0 if self.has_ended(now_s) else self.at(now_s)
        return replace(self, t_s=start_s, since_s=now_s, is_playing=self.duration_s > 0.0)

    def paused(self, now_s: float) -> "Playback":
        """Return the playback stopped at its current time."""
        return replace(self, t_s=self.at(now_s), since_s=now_s, is_playing=False)

    def sought(self, now_s: float, t_s: float) -> "Playback":
        """Return the playback at another time (s), still running or stopped."""
        return replace(self, t_s=min(max(t_s, 0.0), self.duration_s), since_s=now_s)

    def sped(self, now_s: float, speed: float) -> "Playback":
        """Return the playback at another speed, clamped to `SPEED_MIN`..`SPEED_MAX`."""
        kept = min(max(speed, SPEED_MIN), SPEED_MAX)
        return replace(self, t_s=self.at(now_s), since_s=now_s, speed=kept)
