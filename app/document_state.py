"""What a document is at one instant: a drawing and its history, the answer to it, the clock."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from app.drawing.draft import Draft
from app.drawing.drawing import Drawing
from app.drawing.solution import Solution
from app.playback import Playback
from planner.geometry.pose import Point2
from planner.motion.timeline import Timeline
from planner.task.plan import Plan
from planner.task.task import Task
from planner.task.world_state import WorldState


@dataclass(frozen=True, eq=False)
class Answer:
    """A plan, and what it answers.

    Attributes:
        version: the document's version that it belongs to.
        task: what was asked, whatever may be spent on it.
        plan: the plan.
        plan_id: the name under which it can be read.
        is_final: whether nothing better is looked for any more.
    """

    version: int
    task: Task
    plan: Plan
    plan_id: str
    is_final: bool = True

    @cached_property
    def body(self) -> dict[str, Any]:
        """The plan as JSON."""
        return self.plan.answer()


@dataclass(frozen=True, slots=True, eq=False)
class Film:
    """What is played.

    Attributes:
        version: the document's version that it belongs to.
        plan: the plan.
        timeline: what robot and cloth do at every moment.
    """

    version: int
    plan: Plan
    timeline: Timeline


@dataclass(frozen=True, slots=True)
class HeldFold:
    """What one fold needs.

    Attributes:
        must_hold: the vertices that must be held, article frame (m).
        grips: the grips that hold them (m); empty when the arms do not suffice.
        grips_needed: how many; None when more than there are arms.
    """

    must_hold: tuple[Point2, ...]
    grips: tuple[Point2, ...]
    grips_needed: int | None


@dataclass(frozen=True, slots=True)
class Checks:
    """What the folds need, fold by fold.

    Attributes:
        version: the document's version that they belong to.
        folds: one for each legal fold.
    """

    version: int
    folds: tuple[HeldFold, ...]


@dataclass(frozen=True, slots=True)
class DocumentState:
    """A document at one instant.

    Attributes:
        version: grows with every change of the draft.
        draft: what is drawn, and how it came about.
        answer: the latest answer; it may belong to an older version.
        committed: the latest answer to a drawing that was committed.
        before: the one before that to another task, for comparing.
        film: what is played; it may belong to an older version.
        checks: what the folds need.
        start: the state of the world from which the folds are planned; None: from before all of them, as drawn.
        failure: why the planner gave no answer at all to this version.
        is_thorough: whether more work than usual is done for this version's answer, since somebody asked for that.
        playback: the clock.
        is_dark: whether it is shown on a dark ground; of several pages, the last one to say decides.
    """

    version: int
    draft: Draft
    answer: Answer | None = None
    committed: Answer | None = None
    before: Answer | None = None
    film: Film | None = None
    checks: Checks | None = None
    start: WorldState | None = None
    failure: str | None = None
    is_thorough: bool = False
    playback: Playback = Playback()
    is_dark: bool = False

    @property
    def solution(self) -> Solution:
        """The drawing, and what it comes to."""
        return self.draft.solution

    @property
    def drawing(self) -> Drawing:
        """What is drawn."""
        return self.draft.drawing

    @property
    def task(self) -> Task | None:
        """What is to be planned; None while something is wrong with the drawing."""
        garment, drawing = self.solution.garment, self.drawing
        if garment is None:
            return None
        station, comfort_m = drawing.start_station, drawing.comfort_radius_m
        return Task.of(garment, drawing.scene, start_station=station, comfort_radius_m=comfort_m, start=self.start)

    @property
    def is_answered(self) -> bool:
        """Whether the answer belongs to this version."""
        return self.answer is not None and self.answer.version == self.version

    @property
    def plan_on_show(self) -> Plan | None:
        """The solved plan on show for this version, if a quicker one is being looked for."""
        answer = self.answer
        is_shown = answer is not None and self.is_answered and not answer.is_final
        return answer.plan if answer is not None and is_shown and answer.plan.is_solved else None

    @property
    def may_look_longer(self) -> bool:
        """Whether more work than was done for the answer may come to a better one."""
        if self.is_thorough or self.answer is None or not self.is_answered or not self.answer.is_final:
            return False
        return self.answer.plan.statistics.is_cut_short

    @property
    def is_planning(self) -> bool:
        """Whether the answer is still being worked out."""
        return not (self.is_answered or self.failure or self.solution.problems)

    def redrawn(self, draft: Draft, now_s: float) -> "DocumentState":
        """The next version, at a time of the wall clock (s).

        An answer to the same question is an answer to it too; the plan of a garment of another name is none of it.
        """
        version = self.version + 1
        after = replace(self, version=version, draft=draft, start=None, failure=None, is_thorough=False)
        if draft.drawing.name != self.drawing.name:
            after = replace(after, answer=None, committed=None, before=None)
        elif self.start is not None:  # what is left of a plan is nothing to compare whole plans with
            after = replace(after, committed=None, before=None)
        answer, task = after.answer, after.task
        if task is None or answer is None:
            return replace(after, film=None, playback=self.playback.lasting(now_s, 0.0))
        if answer.task != task:
            return after
        if self.film is not None and self.film.plan is answer.plan:
            after = replace(after, film=replace(self.film, version=version))
        if self.checks is not None and self.checks.version == self.version:
            after = replace(after, checks=replace(self.checks, version=version))
        renewed = replace(answer, version=version)
        return after.answered(renewed) if after.film is not None else after.answered(renewed).filmed(renewed, now_s)

    def started_at(self, start: WorldState | None, now_s: float) -> "DocumentState":
        """Planned from another state of the world on, None: as drawn, at a time of the wall clock (s)."""
        if start == self.start:
            return self
        after = replace(self, start=start, answer=None, committed=None, before=None, film=None)
        playback = self.playback.paused(now_s).sought(now_s, 0.0)
        return replace(after, playback=playback, failure=None, is_thorough=False)

    def filmed(self, answer: Answer, now_s: float) -> "DocumentState":
        """With the answer's plan played, at a time of the wall clock (s); nothing is played where there is none."""
        if not answer.plan.is_solved:
            return replace(self, film=None, playback=self.playback.lasting(now_s, 0.0))
        film = Film(answer.version, answer.plan, Timeline.of(answer.plan))
        return replace(self, film=film, playback=self.playback.lasting(now_s, film.timeline.duration_s))

    def answered(self, answer: Answer) -> "DocumentState":
        """With an answer; that to a committed drawing is remembered, for comparing with the next."""
        after = replace(self, answer=answer)
        if self.draft.gesture is not None or answer.version != self.version:
            return after
        is_another = self.committed is not None and self.committed.task != answer.task
        return replace(after, committed=answer, before=self.committed if is_another else self.before)
