"""The state of a document at one instant: a drawing and its history, the answer to it, and the playback."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from app.drawing.draft import Draft
from app.drawing.drawing import Drawing
from app.drawing.solution import Solution
from app.held_folds import FoldChecks
from app.language import ENGLISH, Language
from app.playback import Playback
from app.rehearsal.trace import RunTrace
from planner.errors import FieldError, RequestError
from planner.geometry.pose import Pose2
from planner.motion.cloth_surface import ClothAlone
from planner.motion.timeline import Timeline
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan
from planner.task.task import DEFAULT_ROBOT, Task
from planner.task.world_state import WorldState


@dataclass(frozen=True, eq=False)
class VersionPlan:
    """A plan of a document, with its task and the version that it belongs to.

    Attributes:
        version: the document's version that it belongs to.
        task: the task.
        plan: the plan.
        plan_id: the id under which the plan can be read.
        is_final: whether the search for a better plan has ended.
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
class ShownPlan:
    """The plan on show, with the trajectory's timeline.

    Attributes:
        version: the document's version that it belongs to.
        plan: the plan.
        timeline: the samples of robot and cloth at every time.
    """

    version: int
    plan: Plan
    timeline: Timeline


@dataclass(frozen=True, slots=True, eq=False)
class Rehearsed:
    """A rehearsed run of a plan.

    Attributes:
        plan: the plan.
        trace: the run.
    """

    plan: Plan
    trace: RunTrace


@dataclass(frozen=True, slots=True)
class DocumentState:
    """A document at one instant.

    Attributes:
        version: increases with every change of the draft.
        draft: the drawing and its history.
        answer: the latest answer; it may belong to an older version.
        committed: the latest answer to a committed drawing.
        before: the committed answer before that, to another task, for comparison.
        shown: the plan on show; it may belong to an older version.
        checks: the grips that the folds need.
        start: the world state from which to plan; None for the state before all folds, as drawn.
        failure: why this version has no answer.
        prepared: while the robot's arms are mapped before its first plan, how far that is (0 to 1); None otherwise.
        is_compiling: whether the planner is being compiled before the first plan.
        is_thorough: whether a user has requested more search than usual for this version.
        playback: the playback.
        is_dark: whether the background is dark; the last page to set it decides for all.
        language: the language of exports for people; decided in the same way.
        work_s: the limit on the work of a search (s on the machine of `planner.planning.budget`), None for the usual
            one; decided in the same way.
        preview: the plan of a change that is pointed at; the 3D view shows it in place of `shown`, and where it is not
            solved, the cloth folded by nobody.
        rehearsed: a run whose cloth the 3D view shows along with its plan.
    """

    version: int
    draft: Draft
    answer: VersionPlan | None = None
    committed: VersionPlan | None = None
    before: VersionPlan | None = None
    shown: ShownPlan | None = None
    checks: FoldChecks | None = None
    start: WorldState | None = None
    failure: str | None = None
    prepared: float | None = None
    is_compiling: bool = False
    is_thorough: bool = False
    playback: Playback = Playback()
    is_dark: bool = False
    language: Language = ENGLISH
    work_s: float | None = None
    preview: ShownPlan | ClothAlone | None = None
    rehearsed: Rehearsed | None = None

    @property
    def solution(self) -> Solution:
        """The drawing, solved."""
        return self.draft.solution

    @property
    def drawing(self) -> Drawing:
        """The drawing."""
        return self.draft.drawing

    @property
    def task(self) -> Task | None:
        """The task to plan; None while the drawing has problems."""
        garment, drawing = self.solution.garment, self.drawing
        if garment is None:
            return None
        return Task.of(
            garment,
            drawing.scene,
            robot=drawing.robot,
            start_station=drawing.start_station,
            comfort_radius_m=drawing.comfort_radius_m,
            start=self.start,
        )

    @property
    def is_answered(self) -> bool:
        """Whether the answer belongs to this version."""
        return self.answer is not None and self.answer.version == self.version

    @property
    def plan_on_show(self) -> Plan | None:
        """The solved plan on show for this version while the search for a quicker one goes on, or None."""
        answer = self.answer
        is_shown = answer is not None and self.is_answered and not answer.is_final
        return answer.plan if answer is not None and is_shown and answer.plan.is_solved else None

    @property
    def trace(self) -> RunTrace | None:
        """The rehearsed run of the plan on show, if it is to be shown."""
        is_of_plan = self.shown is not None and self.rehearsed is not None and self.rehearsed.plan is self.shown.plan
        return self.rehearsed.trace if self.rehearsed is not None and is_of_plan else None

    @property
    def may_look_longer(self) -> bool:
        """Whether more search may improve this version's answer."""
        if self.is_thorough or self.answer is None or not self.is_answered or not self.answer.is_final:
            return False
        return self.answer.plan.statistics.is_cut_short

    @property
    def waiting_base(self) -> Pose2:
        """Where the robot waits before a plan begins."""
        stations = dict(self.drawing.scene.stations)
        return stations.get(self.drawing.start_station) or next(iter(stations.values()))

    @property
    def is_planning(self) -> bool:
        """Whether the answer is still being searched for."""
        return not (self.is_answered or self.failure or self.solution.problems)

    def redrawn(self, draft: Draft, now_s: float) -> "DocumentState":
        """Return the next version, at a wall-clock time (s).

        An answer stays valid if the task is the same. A garment of another name starts without answers.
        """
        version = self.version + 1
        after = replace(self, version=version, draft=draft, start=None, failure=None, is_thorough=False, preview=None)
        if draft.drawing.name != self.drawing.name:
            after = replace(after, answer=None, committed=None, before=None)
        elif self.start is not None:  # whole plans cannot be compared with the rest of one
            after = replace(after, committed=None, before=None)
        answer, task = after.answer, after.task
        if task is None or answer is None:
            return replace(after, shown=None, playback=self.playback.lasting(now_s, 0.0))
        if answer.task != task:
            return after
        if self.shown is not None and self.shown.plan is answer.plan:
            after = replace(after, shown=replace(self.shown, version=version))
        if self.checks is not None and self.checks.version == self.version:
            after = replace(after, checks=replace(self.checks, version=version))
        renewed = replace(answer, version=version)
        return after.answered(renewed) if after.shown is not None else after.answered(renewed).showing(renewed, now_s)

    def start_after(self, step: int) -> WorldState:
        """Return the world state after a step of the plan, counted from 0; -1 is before the first."""
        if self.answer is None or not self.is_answered or not self.answer.plan.is_solved:
            raise RequestError("step", "there is no plan of the drawing as it is now")
        try:
            return self.answer.plan.state_after(step)
        except RequestError as error:
            raise RequestError("step", error.message) from None

    def start_in(self, start_of: Callable[[Task], WorldState]) -> WorldState:
        """Return a start that is made from the task as drawn; raise `RequestError` if it cannot be one."""
        task = replace(self, start=None).task
        if task is None:
            raise RequestError("start", "the drawing has problems, which come first")
        return replace(task, start=start_of(task)).start

    def started_at(self, start: WorldState | None, now_s: float) -> "DocumentState":
        """Return the state planned from another world state, None for the drawing's start, at a wall-clock time (s)."""
        if start == self.start:
            return self
        after = replace(self, start=start, answer=None, committed=None, before=None, shown=None)
        playback = self.playback.paused(now_s).sought(now_s, 0.0)
        return replace(after, playback=playback, failure=None, is_thorough=False)

    def showing(self, answer: VersionPlan, now_s: float) -> "DocumentState":
        """Return the state that plays an answer's plan, at a wall-clock time (s), or nothing if it is not solved."""
        if not answer.plan.is_solved:
            return replace(self, shown=None, playback=self.playback.lasting(now_s, 0.0))
        shown = ShownPlan(answer.version, answer.plan, Timeline.of(answer.plan))
        return replace(self, shown=shown, playback=self.playback.lasting(now_s, shown.timeline.duration_s))

    def stopped(self, why: str) -> "DocumentState":
        """Return the state that waits for no answer to this version, nor for a better one."""
        if self.is_planning:
            return replace(self, failure=why)
        if self.answer is None or not self.is_answered or self.answer.is_final:
            return self
        return replace(self, answer=replace(self.answer, is_final=True))

    def previewing(self, plan: Plan | None) -> "DocumentState":
        """Return the state in which the 3D view shows the plan of a change that is pointed at; None: its own again."""
        if plan is None:
            return self if self.preview is None else replace(self, preview=None)
        if not plan.is_solved:
            return replace(self, preview=ClothAlone.of(plan.sequence, plan.scene.table))
        return replace(self, preview=ShownPlan(self.version, plan, Timeline.of(plan)))

    def tracing(self, trace: RunTrace | None) -> "DocumentState":
        """Return the state in which the 3D view shows this rehearsed run; None shows the plan."""
        if trace is None or self.shown is None:
            return self if self.rehearsed is None else replace(self, rehearsed=None)
        return replace(self, rehearsed=Rehearsed(self.shown.plan, trace))

    def answered(self, answer: VersionPlan) -> "DocumentState":
        """Return the state with an answer; keep an answer to a committed drawing for comparison with the next."""
        after = replace(self, answer=answer)
        if self.draft.gesture is not None or answer.version != self.version:
            return after
        is_another = self.committed is not None and self.committed.task != answer.task
        return replace(after, committed=answer, before=self.committed if is_another else self.before)


def shown_robot(name: str) -> RobotCard:
    """Return a robot's card, or the default robot's where there is none of this name or it is not valid.

    A robot of one's own may be removed, or become invalid, while drawings name it: they stay readable and can be given
    another robot; planning them says what is wrong.
    """
    try:
        return load_robot(name).card
    except FieldError:
        return load_robot(DEFAULT_ROBOT).card
