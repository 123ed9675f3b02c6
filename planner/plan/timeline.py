"""A plan as a film: what robot and cloth do at every moment.

The phases of a plan are turned once into keyframes (base, joints of each arm, gripper openings), between which
everything moves evenly; the cloth is drawn from the phase itself. `Timeline.at` only looks up and interpolates, so
the same time always gives the same frame.
"""

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import accumulate

from planner.errors import RequestError
from planner.geometry.table_top import TableTop
from planner.plan.cloth_surface import ClothSurfaces
from planner.plan.frame import Frame
from planner.plan.hand_track import HandTrack, hand_tracks
from planner.plan.machine import Machine
from planner.primitives.phase import ClothMotion, Hand, Phase
from planner.primitives.state import State
from planner.primitives.work import Work

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
    _starts: tuple[float, ...]
    _phases: tuple[tuple[int, Phase], ...]
    _tracks: tuple[HandTrack, ...]
    _surfaces: ClothSurfaces
    _machine: Machine
    _torso_m: float

    @staticmethod
    def of(phases: list[tuple[int, Phase]], duration_s: float, work: Work, machine: Machine) -> "Timeline":
        """The film of a plan's phases, each with the index of its primitive, lasting as long as the plan (s)."""
        lasting = [(i, phase) for i, phase in phases if phase.duration_s > 0.0] or phases[:1]
        starts = (0.0, *accumulate(phase.duration_s for _, phase in lasting))
        tracks = hand_tracks([phase for _, phase in lasting], starts[:-1], work, machine)
        surfaces = ClothSurfaces(work)
        return Timeline(duration_s, starts[:-1], tuple(lasting), tracks, surfaces, machine, work.scene.torso_m)

    def at(self, t_s: float) -> Frame:
        """The frame at a time (s); times before the start or after the end give the first or last frame."""
        t = min(max(t_s, 0.0), self.duration_s)
        number = max(0, bisect_right(self._starts, t) - 1)
        primitive, phase = self._phases[number]
        fraction = (t - self._starts[number]) / phase.duration_s if phase.duration_s > 0.0 else 0.0
        card = self._machine.card
        openings = [track.opening_at(t) for track in self._tracks]
        joints = card.joint_values(self._torso_m, [track.joints_at(t) for track in self._tracks], openings)
        return Frame(
            t,
            primitive,
            phase.base[0].between(phase.base[1], min(fraction, 1.0)),
            self._torso_m,
            joints,
            {arm.name: opening for arm, opening in zip(card.arms, openings, strict=True)},
            self._surfaces.at(phase.cloth, min(fraction, 1.0), self._droop(number, t)),
            phase.cloth.top,
        )

    def _droop(self, number: int, t_s: float) -> float:
        """How far cloth that was held out in the phase before has sunk: 1 when it hangs."""
        if number == 0 or self._phases[number - 1][1].cloth.top == self._phases[number][1].cloth.top:
            return 1.0
        return min((t_s - self._starts[number]) / _SINK_S, 1.0)

    def samples(self, rate_hz: float) -> Iterator[Frame]:
        """Frames at an even rate from 0 to the end; the last stands exactly at the end.

        Raises:
            RequestError: the rate is not between 1 and 200 Hz.
        """
        if not RATE_HZ[0] <= rate_hz <= RATE_HZ[1]:
            raise RequestError("rate_hz", f"{rate_hz} is not between {RATE_HZ[0]:g} and {RATE_HZ[1]:g}")
        count = 0
        while count / rate_hz < self.duration_s:
            yield self.at(count / rate_hz)
            count += 1
        yield self.at(self.duration_s)


def standing(work: Work, state: State) -> Phase:
    """A phase of no length in which nothing moves: all there is to see of a plan without primitives."""
    base, placement = work.base_pose(state.station, state.back_off), work.placed(state.offset)
    free: tuple[Hand | None, ...] = (None,) * len(work.reach.arm_names)
    still = ClothMotion(state.done, placement, placement, TableTop.of(work.scene.table))
    return Phase(0.0, (base, base), free, still)
