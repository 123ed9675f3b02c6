"""The kinds of steps for the app: their words, how they are drawn, and how a world performs them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from app.language import Language, named, numeral, say, translated
from planner.cloth.garment import Garment
from planner.task.plan import Plan, PlanStep


@dataclass(frozen=True, slots=True)
class StepKind:
    """A kind of step.

    Attributes:
        moves: what it moves: a "part" of the cloth, turned over; the "cloth" as a whole, along the table; or the "base"
            alone, to another station; or "nothing".
        words: a few English words on what a step of it does, given its details and its garment.
        on_sheet: the same in a reader's language, for the instruction sheet.
        is_pulled: whether the cloth follows the base as it drives, and may come less far than that.
    """

    moves: Literal["part", "cloth", "base", "nothing"]
    words: Callable[[Mapping[str, Any], Garment], str]
    on_sheet: Callable[[Mapping[str, Any], Garment, Language], str]
    is_pulled: bool = False


def step_kind(name: str) -> StepKind:
    """Return a kind of step by its name; for an unknown name, a kind without motion and words."""
    return STEP_KINDS.get(name, _OTHER)


def step_words(step: PlanStep, garment: Garment) -> str:
    """Return a few words on what a step does; empty for a kind without words."""
    return step_kind(step.kind).words(step.details, garment)


def step_caption(plan: Plan, number: int, language: Language) -> str:
    """Return what is to be read during a step of a plan, counted from 0, in a reader's language."""
    step = plan.steps[number]
    kind, what = named(language, "kind", step.kind), step_kind(step.kind).on_sheet(step.details, plan.garment, language)
    return f"{number + 1}/{len(plan.steps)}  {say(language, 'kind.whole', kind=kind, what=what) if what else kind}"


def _fold(details: Mapping[str, Any], garment: Garment) -> str:
    return garment.folds[int(details["fold"])].name


def _drag(details: Mapping[str, Any], _garment: Garment) -> str:
    return f"{details['distance_m']:.2f} m towards the robot" + (", holds on" if details["holds"] else "")


def _drag_on_sheet(details: Mapping[str, Any], _garment: Garment, language: Language) -> str:
    on = say(language, "sheet.holds_on") if details["holds"] else ""
    return say(language, "sheet.towards_robot", length=_length(details, language)) + on


def _length(details: Mapping[str, Any], language: Language) -> str:
    return f"{numeral(language, details['distance_m'], 2)} m"


def _move(details: Mapping[str, Any], _garment: Garment) -> str:
    return f"{details['from'] or 'elsewhere'} to {details['to'] or 'elsewhere'}"


def _move_on_sheet(details: Mapping[str, Any], _garment: Garment, language: Language) -> str:
    start, end = (named(language, "station", details[name] or "elsewhere") for name in ("from", "to"))
    return say(language, "step_words.from_to", **{"from": start, "to": end})


STEP_KINDS: Mapping[str, StepKind] = {
    "fold": StepKind("part", _fold, lambda details, garment, language: translated(language, _fold(details, garment))),
    "drag": StepKind("cloth", _drag, _drag_on_sheet, is_pulled=True),
    "arm_drag": StepKind(
        "cloth",
        lambda details, _: f"{details['distance_m']:.2f} m by the arms",
        lambda details, _, language: say(language, "sheet.by_arms", length=_length(details, language)),
    ),
    "move": StepKind("base", _move, _move_on_sheet),
}
"""The kinds of steps by their names in plans, those of the planner's primitives."""

_OTHER = StepKind("nothing", lambda *_: "", lambda *_: "")
