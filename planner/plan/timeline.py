"""A plan as a film: what robot and cloth do at every moment.

A plan is turned once into cues for base and cloth and keyframes for the arms (see `planner.plan.film`), between which
everything moves evenly; the cloth is drawn from the phase itself. `Timeline.at` only looks up and interpolates, so
the same time always gives the same frame.
"""

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass

from planner.errors import RequestError
from planner.geometry.pose import Pose2
from planner.geometry.table_top import TableTop
from planner.geometry.tolerance import TIME_S
from planner.plan.cloth_surface import ClothSurfaces
from planner.plan.film import Film
from planner.plan.frame import Frame
from planner.primitives.phase import Hand, Phase
from planner.primitives.state import State
from planner.primitives.work import Work
from planner.robot.card import RobotCard
from planner.task.cloth_motion import ClothMotion

RATE_HZ = (1.0, 200.0)

_SINK_S = 0.4
"""How long cloth that is let go beyond an edge is shown sinking (s); the model lets it hang at once."""


@dataclass(frozen=True)
class Timeline:
    """What happens from 0 to the plan's end.

    Attributes:
        duration_s: the plan's cost (s).
    """

    duration_s: float
    _film: Film
    _surfaces: ClothSurfaces
    _card: RobotCard
    _torso_m: float

    @staticmethod
    def of(film: Film, duration_s: float, work: Work, card: RobotCard) -> "Timeline":
        """The timeline of a film that lasts as long as the plan (s)."""
        return Timeline(duration_s, film, ClothSurfaces(work.sequence), card, work.scene.torso_m)

    def at(self, t_s: float) -> Frame:
        """The frame at a time (s); times before the start or after the end give the first or last frame."""
        t = min(max(t_s, 0.0), self.duration_s)
        number = self._cue_at(t)
        cue, since = self._film.cues[number], t - self._film.starts_s[number]
        arms = self._card.arms
        openings = [self._film.track.opening_at(arm, t) for arm in range(len(arms))]
        phase = cue.phase
        return Frame(
            t,
            cue.primitive,
            cue.base_at(since),
            self._torso_m,
            self._card.joint_values(self._torso_m, list(self._film.track.joints_at(t)), openings),
            {arm.name: opening for arm, opening in zip(arms, openings, strict=True)},
            self._surfaces.at(phase.cloth, cue.fraction_at(since), self._droop(number, t)),
            phase.cloth.top,
        )

    def base_at(self, t_s: float) -> Pose2:
        """Where the base is at a time, table frame; the same as in the frame of that time, and soon known."""
        t = min(max(t_s, 0.0), self.duration_s)
        number = self._cue_at(t)
        return self._film.cues[number].base_at(t - self._film.starts_s[number])

    def _cue_at(self, t_s: float) -> int:
        return max(0, bisect_right(self._film.starts_s, t_s) - 1)

    def _droop(self, number: int, t_s: float) -> float:
        """How far cloth that was held out in the phase before has sunk: 1 when it hangs."""
        cues = self._film.cues
        if number == 0 or cues[number - 1].phase.cloth.top == cues[number].phase.cloth.top:
            return 1.0
        return min((t_s - self._film.starts_s[number]) / _SINK_S, 1.0)

    def samples(self, rate_hz: float) -> Iterator[Frame]:
        """Frames at an even rate from 0 to the end; the last stands exactly at the end.

        Raises:
            RequestError: the rate is not between 1 and 200 Hz.
        """
        if not RATE_HZ[0] <= rate_hz <= RATE_HZ[1]:
            raise RequestError("rate_hz", f"{rate_hz} is not between {RATE_HZ[0]:g} and {RATE_HZ[1]:g}")
        count = 0
        while count / rate_hz < self.duration_s - TIME_S:
            yield self.at(count / rate_hz)
            count += 1
        yield self.at(self.duration_s)


def standing(work: Work, state: State) -> Phase:
    """A phase of no length in which nothing moves: all there is to see of a plan without primitives."""
    base, placement = work.base_pose(state.station, state.back_off), work.placed(state.offset)
    free: tuple[Hand | None, ...] = (None,) * len(work.reach.arm_names)
    still = ClothMotion(state.done, placement, placement, TableTop.of(work.scene.table))
    return Phase(0.0, (base, base), free, still)
