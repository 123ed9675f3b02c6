"""A simulated world that keeps frames of its cloth over the time of the plan performed in it."""

from collections.abc import Callable

from app.rehearsal.physics.physics_world import PhysicsWorld
from app.rehearsal.trace import Frames, rounded
from app.rehearsal.world import Observation, Performed, StepMotion, Truth
from planner.task.plan import Plan

_PERIOD_S = 0.2
"""The time between two frames (s)."""

Tick = Callable[[], None]


class FilmedWorld:
    """A world whose frames are kept until the rest is planned again.

    Attributes:
        frames: where the points of the cloth are, by the time of the plan (s).
    """

    def __init__(
        self,
        plan: Plan,
        begun: Callable[[Tick], PhysicsWorld],
        progress: Callable[[float], None] = lambda _: None,
    ) -> None:
        """Film a world.

        Args:
            plan: the plan.
            begun: returns the world, given what that calls after every time step.
            progress: called with the fraction of the plan's steps that is done.
        """
        self.frames: list[tuple[float, Frames]] = []
        self._plan: Plan | None = plan
        self._progress = progress
        self._step = 0
        self._next_s: float | None = None
        self._starts_s = self._ends_s = 0.0
        self._world = begun(self._tick)
        self._keep(0.0)

    @property
    def elapsed_s(self) -> float:
        """The time that has passed in the world (s)."""
        return self._world.elapsed_s

    def observe(self) -> Observation:
        """Return what the world shows."""
        return self._world.observe()

    def truth(self) -> Truth:
        """Return where the cloth is."""
        return self._world.truth()

    def perform(self, motion: StepMotion) -> Performed:
        """Perform a step; if it is tried again, the frames of the last try are kept."""
        if self._plan is None or not motion.grips:
            return self._world.perform(motion)
        step = self._plan.steps[motion.step]
        first_s = step.start_s + min(grip.times_s[0] for grip in motion.grips)
        self.frames = [frame for frame in self.frames if frame[0] < first_s]
        self._step = motion.step
        self._starts_s, self._ends_s = first_s - self._world.elapsed_s, step.end_s
        self._keep(first_s)
        self._next_s = self._world.elapsed_s + _PERIOD_S
        answer = self._world.perform(motion)
        self._next_s = None
        self._keep(min(self._starts_s + self._world.elapsed_s, self._ends_s))
        return answer

    def end(self) -> None:
        """Keep no more frames: from here on another plan is performed."""
        self._plan = None

    def _tick(self) -> None:
        if self._next_s is None or self._world.elapsed_s < self._next_s:
            return
        self._next_s += _PERIOD_S
        t_s = min(self._starts_s + self._world.elapsed_s, self._ends_s)
        self._keep(t_s)
        if self._plan is not None:
            step = self._plan.steps[self._step]
            self._progress((self._step + (t_s - step.start_s) / step.duration_s) / len(self._plan.steps))

    def _keep(self, t_s: float) -> None:
        """Keep a frame in place of all that are not earlier."""
        while self.frames and self.frames[-1][0] >= t_s:
            self.frames.pop()
        self.frames.append((t_s, rounded(self._world.truth().positions)))
