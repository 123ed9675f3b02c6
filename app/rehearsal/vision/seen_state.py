"""Find the state of a garment's folds that a picture shows, and the error of its last crease.

Every set of folds that the Fold-DAG allows leaves another outline. Those of about the area seen are fitted, and for
the best few the crease of the last fold is fitted too. A crease far from its line can make one state look like
another, so of states that fit equally well the one whose crease is nearest to its line is taken.
"""

import math
from dataclasses import dataclass, replace
from typing import Any

from app.rehearsal.camera.calibration import Calibration
from app.rehearsal.vision.fit_fold import FoldedOutline, fit_fold
from app.rehearsal.vision.fit_stack import fit_stack, thinned
from app.rehearsal.vision.neatness import Neatness
from app.rehearsal.vision.on_table import OnTable, outline_on_table
from app.rehearsal.vision.picture import read_picture
from app.rehearsal.vision.scale_said import read_scale
from app.rehearsal.vision.stack_figure import POINTS, Figure, fits_as_well
from app.rehearsal.vision.stack_fit import LOOKS_ALIKE, FoldFit, StackFit, unknown_json
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import Garment
from planner.folds.fold_sequence import FoldSequence, replayed
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from planner.message import Message
from planner.task.plan import Plan

_SETS = 200
"""The most sets of folds that are tried; garments with many independent folds have more."""

_FITTED, _FITTED_WITH_CREASE = 6, 3
"""The number of states that are fitted, those of the nearest area first, and of those fitted with their last crease."""

_CLEARLY = 0.5
"""Of two states that fit equally well, one is known if its crease is off by less than this share of the other's."""


@dataclass(frozen=True, slots=True)
class FittedState:
    """A state fitted to an outline.

    Attributes:
        done: the folds done, as a bit mask.
        last: the fold done last; None where nothing is folded.
        fit: where the stack lies, and, where something is folded, how its crease lies.
        misfit_m: the mean distance between outline and points seen (m).
    """

    done: int
    last: int | None
    fit: FoldFit | StackFit
    misfit_m: float

    @property
    def off_m(self) -> float:
        """The largest error of the part that moved last (m)."""
        return self.fit.off_m if isinstance(self.fit, FoldFit) else 0.0

    @property
    def stack(self) -> StackFit:
        """The stack's placement."""
        return self.fit.stack if isinstance(self.fit, FoldFit) else self.fit


@dataclass(frozen=True, slots=True)
class SeenState:
    """The state of a garment that a picture shows.

    Attributes:
        garment: the garment.
        found: the state.
        frame: "sheet", "marker", "picture" or "table"; see `OnTable.frame`.
        scale_from: what gave the scale.
        size_error: by which share the size may be wrong; None where a length was typed.
        neatness: how well the stack matches that state.
        unknown: why the state is not known; None where it is.
    """

    garment: Garment
    found: FittedState
    frame: str
    scale_from: str
    size_error: float | None
    neatness: Neatness
    unknown: Message | None

    @property
    def folds(self) -> tuple[int, ...]:
        """The folds done, in the garment's order."""
        return tuple(k for k in range(len(self.garment.folds)) if self.found.done >> k & 1)

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON; ``fit`` says whether the placement is known too."""
        return {
            "garment": self.garment.name,
            "folds_done": list(self.folds),
            "last_fold": self.found.last,
            "fit": self.found.fit.to_dict(),
            "neatness": self.neatness.to_dict(),
            "frame": self.frame,
            "scale_from": self.scale_from,
            "size_error": self.size_error,
            **unknown_json(self.unknown),
        }


def see_state(data: bytes, scale: str | Calibration | None, garment: Garment, plan: Plan | None = None) -> SeenState:
    """Find which state of a garment's folds a picture shows.

    Args:
        data: a PNG or JPEG.
        scale: what gives the scale, as `read_scale` takes it, or a calibrated camera; None to look for a sheet of
            paper. A length is that of the cloth as it lies there.
        garment: the garment, with its folds.
        plan: its plan, which says where the stack ought to lie on the table of a calibrated camera.

    Raises:
        PictureError: the file is no picture that can be read, or the scale is not one.
        FoldError: a fold of the garment is not legal.
        NothingToldError: there is nothing to be read from the picture.
        ScaleNeededError: nothing says how large the cloth is.
    """
    said = read_scale(scale) if isinstance(scale, str) else scale
    sequence = replayed(garment)
    seen = outline_on_table(read_picture(data), said)
    found, unknown = state_of(seen.contour, sequence)
    ought = None if plan is None or seen.frame != "table" else _ought(plan, found.done)
    neat = Neatness.of(seen.contour, sequence.cloth(found.done).silhouette, found.stack.placement, ought)
    return SeenState(
        garment, _less_sure(found, seen), seen.frame, seen.scale_from, seen.size_error, neat, seen.doubt or unknown
    )


def _ought(plan: Plan, done: int) -> Pose2 | None:
    """Return where a plan has the stack once exactly these folds are done; None if that never occurs."""
    worlds = (plan.task.start, *(step.after for step in plan.steps))
    return next((world.placement for world in reversed(worlds) if world.done == done), None)


def state_of(contour: FloatArray, sequence: FoldSequence) -> tuple[FittedState, Message | None]:
    """Return the state whose outline was seen, and why it may be another; None where there is no reason.

    Args:
        contour: points of the visible outline, shape (n, 2), m.
        sequence: the garment's folds.
    """
    area = Region.polygon(contour).area
    sets = sorted(_sets(sequence), key=lambda done: abs(math.log(sequence.cloth(done).silhouette.area / area)))
    rough = sorted((_flat(contour, sequence, done) for done in sets[:_FITTED]), key=lambda one: one.misfit_m)
    found = [_creased(contour, sequence, one) for one in rough[:_FITTED_WITH_CREASE]]
    least = min(one.misfit_m for one in found)
    alike = sorted((one for one in found if fits_as_well(one.misfit_m, least)), key=lambda one: one.off_m)
    best = alike[0]
    if best.stack.unknown is not None and best.stack.unknown.code != LOOKS_ALIKE:
        return best, best.stack.unknown
    if len(alike) > 1 and best.off_m > _CLEARLY * alike[1].off_m:
        text = f"{len(alike)} states of the folds fit equally well"
        return best, Message("states_alike", text, {"states": len(alike)})
    return best, None


def _sets(sequence: FoldSequence) -> list[int]:
    """Return sets of folds, as bit masks, that may have been done: those of the user's order first."""
    sets = [(1 << count) - 1 for count in range(len(sequence.folds) + 1)]
    known = set(sets)
    for done in sets:  # it grows while it is walked
        for index in sequence.dag.available(done):
            after = done | 1 << index
            if after not in known and len(sets) < _SETS:
                known.add(after)
                sets.append(after)
    return sets


def _flat(contour: FloatArray, sequence: FoldSequence, done: int) -> FittedState:
    """Return a state fitted with all creases on their lines."""
    stack = sequence.cloth(done)
    fit = fit_stack(contour, stack)
    return FittedState(done, None, fit, _misfit(stack.silhouette, fit, contour))


def _creased(contour: FloatArray, sequence: FoldSequence, flat: FittedState) -> FittedState:
    """Return a state fitted with the crease of the last fold of the garment's order."""
    if not flat.done:
        return flat
    last = sequence.last_done(flat.done)
    if FOLD_KINDS[sequence.folds[last].kind].is_whole:
        return flat
    before = flat.done & ~(1 << last)
    fit = fit_fold(contour, sequence, before, last)
    outline = FoldedOutline(sequence, before, last).region(fit.offset_m, fit.turn_rad)
    return FittedState(flat.done, last, fit, _misfit(outline, fit.stack, contour))


def _misfit(outline: Region, fit: StackFit, contour: FloatArray) -> float:
    figure = Figure.about(outline)
    return figure.misfit(figure.fit_at(fit.placement).row, thinned(contour, POINTS))


def _less_sure(found: FittedState, seen: OnTable) -> FittedState:
    """Return a state whose errors include that of the picture's scale."""
    reach_m = float(abs(seen.contour - seen.contour.mean(axis=0)).max()) * (seen.size_error or 0.0)
    stack = replace(found.stack, error_m=math.hypot(found.stack.error_m, reach_m))
    if not isinstance(found.fit, FoldFit):
        return replace(found, fit=stack)
    error_m = math.hypot(found.fit.offset_error_m, reach_m)
    return replace(found, fit=replace(found.fit, stack=stack, offset_error_m=error_m))
