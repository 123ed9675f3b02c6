"""A fold as a step of a plan: reach the grips, lift them over the fold line, lay them down."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Approach, FloatArray, point3
from planner.primitives.base_legs import travel
from planner.primitives.context import Context
from planner.primitives.fold_motion import FoldMotion
from planner.primitives.fold_obstacles import geometric_obstacle
from planner.primitives.fold_trial import FoldTrial, fold_trials
from planner.primitives.fold_variants import Variant, fold_spread, fold_variants, trial_variants
from planner.primitives.fold_way import FoldWay
from planner.primitives.grasping import by_nearness, holdings, like_approach
from planner.primitives.state import Held, State
from planner.task.trajectory import Phase
from planner.task.world_state import Grip, Holding

_LIKE = 8
"""The number of approaches of each arm that count as like its former one; trying all takes several times as long."""


@dataclass(frozen=True)
class FoldStep:
    """A fold as a step of a plan.

    Attributes:
        context: the planning context.
        way: grips, arms and paths.
        before: the state it starts in.
        after: the state it leads to.
        first_stand: the standoff from which the path is begun.
        driven: how many steps of the grid of standoffs the base drives from there on.
    """

    context: Context
    way: FoldWay
    before: State
    after: State
    first_stand: int
    driven: int
    kind: str = "fold"

    @cached_property
    def duration_s(self) -> float:
        """The time of the arm motions and of all the base's legs (s)."""
        steps = self.driven + abs(self.before.standoff - self.first_stand)
        motions = 2 if self.before.held else 3
        return motions * self.context.scene.arm_motion_s + self.context.drive_s(steps)

    @cached_property
    def grips(self) -> tuple[Grip, ...]:
        """Each hand's pick, apex and place, from the leftmost arm to the rightmost."""
        picks, apexes, places = (self._tools(sweep) for sweep in (0.0, 1.0, 2.0))
        names = self.context.reach.arm_names
        return tuple(
            Grip(names[arm], point3(picks[i]), point3(apexes[i]), point3(places[i]))
            for arm, i in sorted(zip(self.way.trial.arms, range(len(picks)), strict=True))
        )

    @property
    def details(self) -> dict[str, Any]:
        """The fold, and whether the hands keep hold for a red fold that follows."""
        return {"fold": self.way.trial.fold, "holds": bool(self.after.held)}

    def holdings(self) -> tuple[Holding, ...]:
        """Return what each arm holds, and which vertices Theorem 1 asks for."""
        context, trial = self.context, self.way.trial
        covers = context.sequence.covers(trial.fold, context.scene.support_angle_rad, len(context.reach.arm_names))
        return holdings(trial.taken, covers.vertices, context.reach.arm_names)

    @cached_property
    def phases(self) -> tuple[Phase, ...]:
        """The phases: drive, reach, follow the path with the base's legs in between."""
        return self._motion.phases()

    def extremes(self) -> tuple[Phase, ...]:
        """Return one phase from the picks to the places."""
        return self._motion.extremes()

    @property
    def hands(self) -> dict[int, Approach]:
        """The orientation in which each arm's hand takes hold, by the arm's number."""
        approaches = self.context.reach.approaches
        return {arm: approaches[one] for arm, one in zip(self.way.trial.arms, self.way.approaches, strict=True)}

    @property
    def _motion(self) -> FoldMotion:
        return FoldMotion(self.context, self.way, self.before, self.first_stand, self.after.standoff, self.driven)

    def variants(self) -> Iterator["FoldStep"]:
        """Yield this step, then every other way between the same states, the quickest first."""
        yield self
        fold, end = self.way.trial.fold, self.after.standoff
        for variant in fold_variants(self.context, self.before, fold, end):
            if variant.first == self.first_stand and variant.way.is_like(self.way):
                continue
            driven = variant.steps - abs(variant.first - self.before.standoff)
            yield replace(self, way=variant.way, first_stand=variant.first, driven=driven)

    @property
    def turns(self) -> Mapping[int, int]:
        """The number of the approach in which each arm begins the fold."""
        return dict(zip(self.way.trial.arms, self.way.approaches, strict=True))

    def turned(self, _turns: Mapping[int, int]) -> Iterator["FoldStep"]:
        """Yield nothing: how the hands are turned decides where the base can stand."""
        yield from ()

    @cached_property
    def motion(self) -> tuple[object, ...]:
        """The key that identifies it: both states, the hands, and the standoff at which it begins."""
        return (self.kind, self.before, self.after, self.first_stand, self.way.trial.tracks, self.way.approaches)

    @cached_property
    def situation(self) -> tuple[object, ...]:
        """The key it shares with folds in which the hands move alike and the base stands elsewhere.

        Which other folds are done does not matter, as long as the hands do the same.
        """
        trial = self.way.trial
        return (self.kind, trial.fold, self.before.hold, self.before.station, self.before.place, trial.hands)

    @property
    def task(self) -> tuple[object, ...]:
        """The key it shares with the same fold from the same station by the same arms, wherever the cloth lies."""
        return (self.kind, self.way.trial.fold, self.before.station, frozenset(self.way.trial.arms))

    def begun_in(self, state: State) -> "FoldStep":
        """Return the fold begun in another state of the same situation."""
        steps = self.driven + abs(self.first_stand - state.standoff)
        return fold_step(self.context, self.way, state, self.first_stand, self.after.standoff, steps)

    def elsewhere(self, count: int) -> Iterator["FoldStep"]:
        """Yield up to `count` other ways to do the same fold in the same state, at any standoffs."""
        for variant in fold_spread(self.context, self.before, self.way.trial.fold, count):
            yield fold_step(self.context, variant.way, self.before, variant.first, variant.end, variant.steps)

    def again(self, context: Context, state: State) -> Iterator["FoldStep"]:
        """Yield the fold again, each hand at the grip nearest to its old one: first unchanged, if it can be.

        The ways in which the base travels least follow, those with the hands held much the same first; then ways with
        other hands.
        """
        old = self.way.trial
        is_next = old.fold in context.sequence.dag.available(state.done)
        is_red_from_drag = is_next and state.is_dragged and context.sequence.folds[old.fold].is_red
        if not is_next or is_red_from_drag or geometric_obstacle(context, state, old.fold) is not None:
            return
        first, end = state.standoff if state.held else self.first_stand, self.after.standoff
        is_on_grid = max(first, end) < context.standoffs
        orientation = dict(zip(old.arms, self.way.approaches, strict=True))
        for trial in by_nearness(old, fold_trials(context, state, old.fold)):
            same = FoldWay(trial, tuple(orientation.get(arm, -1) for arm in trial.arms))
            if is_on_grid and all(a in allowed for a, allowed in zip(same.approaches, trial.approaches, strict=True)):
                driven = int(travel(same.strip(context, state.station)[None], context.standoffs)[0, first, end])
                if driven < IMPOSSIBLE:
                    yield fold_step(context, same, state, first, end, driven + abs(first - state.standoff))
            for v in _variants_like(context, state, trial, orientation, end):
                yield fold_step(context, v.way, state, v.first, v.end, v.steps)

    def _tools(self, sweep: float) -> FloatArray:
        return self.way.trial.path.tool_points(self.way.trial.points, sweep)


def fold_step(context: Context, way: FoldWay, state: State, first: int, end: int, steps: int) -> FoldStep:
    """Return the step of a fold in a state, from its first standoff to its last.

    Before a red fold the hands hold on.

    Args:
        context: the planning context.
        way: grips, arms and paths.
        state: the state it starts in.
        first: the standoff from which the path is begun.
        end: the standoff at its end.
        steps: the steps of driving in all.
    """
    fold = way.trial.fold
    held: tuple[Held, ...] = ()
    if context.sequence.dag.follows_at_once(fold):
        over = Isometry.reflection(context.sequence.folds[fold].line)
        held = tuple(
            Held(arm, over.apply_point(grip)) for arm, grip in sorted(zip(way.trial.arms, way.trial.cover, strict=True))
        )
    after = State(state.done | 1 << fold, state.offset, state.station, end, held)
    return FoldStep(context, way, state, after, first, steps - abs(first - state.standoff))


def _variants_like(
    context: Context, state: State, trial: FoldTrial, orientation: dict[int, int], end: int
) -> Iterator[Variant]:
    """Yield the ways of a trial by rising travel, then by how near they end to a standoff.

    Those in which each arm's approach is like its former one come before all others.
    """

    def rank(variant: Variant) -> tuple[int, int, int]:
        return variant.steps, abs(variant.end - end), variant.rank

    like = tuple(
        like_approach(context, allowed, orientation[arm], _LIKE) if arm in orientation else allowed[:_LIKE]
        for arm, allowed in zip(trial.arms, trial.approaches, strict=True)
    )
    yield from sorted(trial_variants(context, state, trial, approaches=like), key=rank)
    for variant in sorted(trial_variants(context, state, trial), key=rank):
        if any(approach not in some for approach, some in zip(variant.way.approaches, like, strict=True)):
            yield variant
