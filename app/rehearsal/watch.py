"""Look during a run: before hands close, at the hands, after drags and at the end; with arms withdrawn if need be.

Cloth that a fold has left elsewhere than it should be has another outline than the folded stack. So a look after a fold
to which that outline does not fit is made again with the arms out of the way. If it does not fit then the fold is
opened; if that was done before or leaves another outline too, the run ends, since from cloth that is folded otherwise
than planned there is no plan.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

from app.rehearsal.camera.posture import Posture
from app.rehearsal.eyes import Eyes, Picture, kept
from app.rehearsal.grasp_points import are_edges_hidden
from app.rehearsal.judge import carry
from app.rehearsal.laid_again import laid_again, opened
from app.rehearsal.laid_edge import LaidEdge, laid_edges
from app.rehearsal.step_motions import posture_at
from app.rehearsal.step_seen import StepSeen
from app.rehearsal.vision.look_at_stack import Sight
from app.rehearsal.vision.seen_stack import SeenStack
from app.rehearsal.world import REACH, WITHDRAW, StepMotion, World
from planner.geometry.pose import Point2, Pose2
from planner.task.plan import Plan, PlanStep
from planner.task.task import Task
from planner.task.world_state import WorldState

BLIND_MAX = 1
"""The most steps in a row that are made as planned while the placement of the cloth is unknown."""

FOLDED_OVERLAP = 0.9
"""The least overlap of the outline seen with the folded stack's; below it a fold counts as failed."""

WITHDRAW_S = 3.0
"""The time that arms take to get out of the way (s)."""


@dataclass(frozen=True, slots=True, eq=False)
class _Latest:
    """The latest look if nothing has moved since: the state, what was seen, and whether the arms were withdrawn."""

    ought: WorldState
    sight: Sight
    is_clear: bool


@dataclass
class Watch:
    """The looks of a run, and their results.

    Attributes:
        world: the world.
        task: the robot and the table.
        decide: notes a decision, its code and its numbers.
        posture: how the robot believes to stand; None where nobody has said.
        stack: the stack as it was seen before the hands close; None where that was not to be made out.
        blind: the steps in a row before which it was not to be made out.
        pictures: those looked at.
        has_folded: whether a fold has been made.
    """

    world: World
    task: Task
    decide: Callable[..., None]
    posture: Posture | None = None
    stack: SeenStack | None = None
    blind: int = 0
    pictures: list[Picture] = field(default_factory=list)
    has_folded: bool = False
    _latest: "_Latest | None" = None

    @cached_property
    def eyes(self) -> Eyes:
        """The robot's eyes."""
        return Eyes(self.task)

    def before(self, plan: Plan, step: PlanStep, made: int) -> tuple[Pose2, str]:
        """Return where the stack lies before a step, as seen, and why the run must end, "" if it need not.

        Where that stays uncertain, the estimate is nearer than where it should lie, and is taken, and so it is of a
        stack that was seen before the last fold; where nothing tells it, it is where it was seen then, or should lie.

        Args:
            plan: the plan.
            step: its step.
            made: how many steps have been made.
        """
        sight, self.stack = self._clear_look(plan, step, step.before, made), None
        if sight is None:
            return step.before.placement, ""
        expected = self.eyes.expected
        if self._is_failed(sight):
            return step.before.placement, self._failed(sight, f"before step {made}")
        if sight.fit is not None and (sight.is_estimate or expected is not None):
            self.blind, self.stack = 0, sight.stack
            return sight.fit.placement, ""
        self.blind += 1
        self.decide("kept_blindly")
        lies = step.before.placement if expected is None else expected.placement
        if self.blind <= BLIND_MAX or sight.unknown is None:
            return lies, ""
        return lies, f"before step {made} the cloth is not to be made out: {sight.unknown.text}"

    def at_end(self, plan: Plan, step: PlanStep, made: int) -> str:
        """Return why a run is seen to have failed after its last step; "" if it has not, or nothing is seen.

        Args:
            plan: the plan.
            step: its last step.
            made: how many steps have been made.
        """
        sight = self._clear_look(plan, step, step.after, made) if self.has_folded else None
        return self._failed(sight, "after the last step") if sight is not None and self._is_failed(sight) else ""

    def _clear_look(self, plan: Plan, step: PlanStep, ought: WorldState, made: int) -> Sight | None:
        """Look, unless nothing has moved since; look again with the arms withdrawn if that is not enough."""
        latest, is_clear = self._latest, False
        sight: Sight | None
        if latest is not None and latest.ought == ought:
            sight, is_clear = latest.sight, latest.is_clear
        else:
            sight = self.look(plan, ought, made)
        if sight is None or self.posture is None:
            return sight
        is_hidden = ought is step.before and are_edges_hidden(step, sight.stack)
        if sight.unknown is not None or is_hidden or self._is_failed(sight):
            sight, is_clear = sight if is_clear else self._withdrawn_look(plan, ought, made, sight), True
        self._latest = _Latest(ought, sight, is_clear)
        return sight

    def _withdrawn_look(self, plan: Plan, ought: WorldState, made: int, sight: Sight) -> Sight:
        """Look with the arms withdrawn; return that look, or the one before if it shows more."""
        assert self.posture is not None
        self.posture = self.eyes.withdrawn(self.posture)
        self.world.perform(StepMotion(made, WITHDRAW, WITHDRAW_S, ends=self.posture))
        clear = self.look(plan, ought, made, is_clear=True)
        if clear is None or (clear.unknown is not None and sight.unknown is None):
            return sight
        # One of the two looks is mistaken then: a stack as planned is not seen by chance.
        return sight if sight.is_estimate and self._is_failed(clear) and not self._is_failed(sight) else clear

    def laid_again(self, seen: StepSeen, made: int) -> StepMotion | None:
        """Return the motion that pulls edges to their places if a fold is seen to have left them short; else None.

        Args:
            seen: the step, and where the stack lay before it.
            made: how many steps have been made.
        """
        step, plan = seen.step, seen.plan
        sight = self._clear_look(plan, step, step.after, made)
        if sight is None or sight.fit is None or not sight.is_estimate or self._is_failed(sight):
            return None
        edges, short_m = self._short(seen, sight)
        if short_m.keys() != edges.keys() and self._latest is not None and not self._latest.is_clear:
            sight = self._withdrawn_look(plan, step.after, made, sight)
            self._latest = _Latest(step.after, sight, is_clear=True)
            edges, short_m = self._short(seen, sight)
        motion = laid_again(seen, edges, short_m)
        if motion is not None:
            self.posture, self._latest = motion.ends, None
            self.decide("laid_again", ("short_m", max(short_m.values())))
        return motion

    def opened(self, seen: StepSeen, made: int) -> StepMotion | None:
        """Return the motion that opens a fold again if it has left another outline than planned; else None.

        Args:
            seen: the step, and where the stack lay before it.
            made: how many steps have been made.
        """
        sight = self._clear_look(seen.plan, seen.step, seen.step.after, made)
        if sight is None or sight.fit is None or not self._is_failed(sight):
            return None
        edges = {edge.arm: edge for edge in laid_edges(seen)}
        found = {arm: self.eyes.short_m(edge) for arm, edge in edges.items()}
        motion = opened(seen, edges, {arm: short_m for arm, short_m in found.items() if short_m is not None})
        self.posture, self._latest = motion.ends, None
        self.decide("opened", ("overlap", sight.fit.overlap))
        return motion

    def _short(self, seen: StepSeen, sight: Sight) -> tuple[dict[str, LaidEdge], dict[str, float]]:
        """Return the edges that a fold has laid down, and how far short of their places those seen lie, by arm (m).

        Edges that are short by less than the error of the stack's placement count as in place, unless all of them
        should lie on another edge.
        """
        if sight.fit is None:
            return {}, {}
        there = replace(seen, carried=carry(seen.step.after.placement, sight.fit.placement))
        edges = {edge.arm: edge for edge in laid_edges(there, sight.stack)}
        found = {arm: self.eyes.short_m(edge) for arm, edge in edges.items()}
        measured = {arm: short_m for arm, short_m in found.items() if short_m is not None}
        known_m = 0.0 if all(edge.is_on_edge for edge in edges.values()) else sight.fit.error_m
        return edges, measured if max(measured.values(), default=0.0) > known_m else dict.fromkeys(measured, 0.0)

    def _is_failed(self, sight: Sight) -> bool:
        """Return whether a fold of this run has left the cloth with another outline than it should have."""
        return self.has_folded and sight.fit is not None and sight.fit.overlap < FOLDED_OVERLAP

    def _failed(self, sight: Sight, when: str) -> str:
        assert sight.fit is not None
        overlap = sight.fit.overlap
        self.decide("fold_failed", ("overlap", overlap))
        return (
            f"{when} the cloth's outline and that of the folded stack overlap by only {overlap:.0%} "
            f"({FOLDED_OVERLAP:.0%} needed): the last fold has failed; see the picture"
        )

    def look(self, plan: Plan, ought: WorldState, made: int, *, is_clear: bool = False) -> Sight | None:
        """Look once for a stack where it should lie, and note what was seen; None if the world shows nothing."""
        seen, posture = self.world.observe(), self.posture
        if posture is None:
            return None
        sight = self.eyes.sight(seen, plan.sequence, ought.folds_done, ought.placement, posture)
        if sight is None:
            return None
        fit = sight.fit
        numbers = () if fit is None else (("error_m", fit.error_m), ("overlap", fit.overlap))
        self.decide("seen" if sight.unknown is None else "not_known", *numbers)
        picture = kept(made, ought, seen, sight, is_clear=is_clear)
        self.pictures += [] if picture is None else [picture]
        return sight

    def reached(self, seen: StepSeen, made: int) -> dict[str, Point2]:
        """Move hands to where they close; return the offset of each one seen from its place, by arm, table frame (m).

        Args:
            seen: a step in which all hands close.
            made: how many steps have been made.
        """
        path, motion = seen.plan.trajectory, seen.motion
        if path is None or not self.eyes.has_camera:
            return {}
        self.posture = posture_at(path, seen.step.start_s + max(grip.times_s[0] for grip in motion.grips))
        self.world.perform(StepMotion(made, REACH, 0.0, ends=self.posture))
        hands = self.eyes.hands(self.world.observe(), self.posture)
        if hands:
            self.decide("aimed", ("beside_m", max(math.hypot(*beside) for beside in hands.values())))
        return hands

    def after(self, motion: StepMotion) -> None:
        """Note a step that was made."""
        self.posture, self._latest = motion.ends, None
        self.has_folded |= motion.is_fold
        self.eyes.after(motion)
