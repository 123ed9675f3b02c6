"""What would have to be true of the world for there to be a plan: friction, grip radius, comfort.

Each of these only ever allows more the further it goes. So the furthest is tried first, and if even that gives no
plan, nothing less does.
"""

from collections.abc import Sequence
from dataclasses import replace

from planner.cloth.garment import DrawnFold
from planner.message import Message
from planner.plan.suggestion_trial import Asked, Proof, Search, Trial
from planner.plan.suggestion_words import in_cm

FRICTIONS = (1.5, 2.0, 4.0)
GRIP_RADII_M = (0.15, 0.2, 0.25, 0.3, 0.4, 0.5)
COMFORTS_M = (0.02, 0.01, 0.0)


def comforts(asked: Asked) -> Search:
    """Look for the largest comfort radius below the one asked for that gives a plan."""
    return _least([_comfort(asked, c) for c in COMFORTS_M if c < asked.comfort_radius_m])


def frictions(asked: Asked) -> Search:
    """Look for the smallest friction coefficient above the scene's that gives a plan."""
    return _least([_friction(asked, mu) for mu in FRICTIONS if mu > asked.scene.friction])


def grip_radii(asked: Asked, folds: Sequence[int]) -> Search:
    """Look for the smallest grip radius of some folds that gives a plan."""
    smallest = min((asked.garment.folds[i].grip_radius_m for i in folds), default=max(GRIP_RADII_M))
    return _least([_grip_radius(asked, folds, r) for r in GRIP_RADII_M if r > smallest])


def _least(trials: Sequence[Trial]) -> Search:
    """The first trial that works, once the last is known to; trials are in ascending order."""
    if not trials:
        return
    most = Proof.of(trials[-1], (yield trials[-1]))
    if most is None:
        return
    for trial in trials[:-1]:
        proof = Proof.of(trial, (yield trial))
        if proof is not None:
            yield proof.suggestion
            return
    yield most.suggestion


def _comfort(asked: Asked, radius_m: float) -> Trial:
    text = f"Assume that a comfort radius of {in_cm(radius_m)} is enough, not {in_cm(asked.comfort_radius_m)}"
    says = Message("assume_comfort", text, {"comfort_m": radius_m, "now_m": asked.comfort_radius_m})
    size = asked.comfort_radius_m - radius_m
    return Trial(
        "comfort_radius", says, {"comfort_radius_m": radius_m}, size, replace(asked, comfort_radius_m=radius_m)
    )


def _friction(asked: Asked, friction: float) -> Trial:
    scene = replace(asked.scene, friction=friction)
    text = f"Assume a friction coefficient of {friction:g}, not {asked.scene.friction:g}"
    says = Message("assume_friction", text, {"friction": friction, "now": asked.scene.friction})
    size = friction - asked.scene.friction
    return Trial("friction", says, {"scene": scene.to_dict()}, size, replace(asked, scene=scene))


def _grip_radius(asked: Asked, folds: Sequence[int], radius_m: float) -> Trial:
    def widened(index: int, fold: DrawnFold) -> DrawnFold:
        return replace(fold, grip_radius_m=max(radius_m, fold.grip_radius_m)) if index in folds else fold

    drawn = asked.garment.folds
    garment = replace(asked.garment, folds=tuple(widened(i, fold) for i, fold in enumerate(drawn)))
    names = ", ".join(f"fold {i} '{drawn[i].name}'" for i in folds)
    text = f"Assume that one grip holds the cloth within {in_cm(radius_m)} in {names}"
    says = Message("assume_grip_radius", text, {"grip_radius_m": radius_m, "folds": list(folds)})
    size = radius_m - min(drawn[i].grip_radius_m for i in folds)
    return Trial("grip_radius", says, {"garment": garment.to_dict()}, size, replace(asked, garment=garment))
