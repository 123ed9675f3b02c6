"""The playback of a plan: a clock that can be started, stopped, moved and sped up.

A value: it says what the time was at one instant of the wall clock and how it has run since, so that asking
for the time changes nothing and any number of viewers agree.
"""

from dataclasses import dataclass, replace

SPEED_MIN, SPEED_MAX = 0.1, 20.0


@dataclass(frozen=True, slots=True)
class Playback:
    """Where a plan's playback is.

    Attributes:
        duration_s: the plan's length (s); 0 when there is none.
        t_s: the time in the plan at the instant `since_s` (s); beyond the end of a plan that has become shorter it
            waits for a longer one.
        since_s: an instant of the wall clock (s).
        is_playing: whether time runs.
        speed: how many seconds of the plan pass in one.
    """

    duration_s: float = 0.0
    t_s: float = 0.0
    since_s: float = 0.0
    is_playing: bool = False
    speed: float = 1.0

    def at(self, now_s: float) -> float:
        """The time in the plan (s), never beyond its ends."""
        ran_s = self.speed * (now_s - self.since_s) if self.is_playing else 0.0
        return min(max(self.t_s + ran_s, 0.0), self.duration_s)

    def lasting(self, now_s: float, duration_s: float) -> "Playback":
        """The playback of another plan, of this length (s), at the same time in it."""
        t_s = self.at(now_s) if self.is_playing else self.t_s
        is_playing = self.is_playing and duration_s > 0.0
        return replace(self, duration_s=duration_s, t_s=t_s, since_s=now_s, is_playing=is_playing)

    def has_ended(self, now_s: float) -> bool:
        """Whether the plan has been played to its end."""
        return self.at(now_s) >= self.duration_s

    def played(self, now_s: float) -> "Playback":
        """Running; from the start again when it stood at the end."""
        start_s = 0.0 if self.has_ended(now_s) else self.at(now_s)
        return replace(self, t_s=start_s, since_s=now_s, is_playing=self.duration_s > 0.0)

    def paused(self, now_s: float) -> "Playback":
        """Standing where it is."""
        return replace(self, t_s=self.at(now_s), since_s=now_s, is_playing=False)

    def sought(self, now_s: float, t_s: float) -> "Playback":
        """At another time (s), running or standing as before."""
        return replace(self, t_s=min(max(t_s, 0.0), self.duration_s), since_s=now_s)

    def sped(self, now_s: float, speed: float) -> "Playback":
        """At another speed, kept between `SPEED_MIN` and `SPEED_MAX`."""
        kept = min(max(speed, SPEED_MIN), SPEED_MAX)
        return replace(self, t_s=self.at(now_s), since_s=now_s, speed=kept)
