"""Sentences that name folds of the garment: why a fold cannot be done, and changes that would give a plan."""

from collections.abc import Callable, Mapping

from planner.words.lengths import Folds, Values, called, direction, in_cm, moved, on_garment, rounded_up

_TURNS = ("", "by 90 degrees to the left", "by 180 degrees", "by 90 degrees to the right")
"""Quarter turns in words."""


def _red_unheld(values: Values, folds: Folds) -> str:
    return (
        f"{on_garment([values['at']])} must be held, but no hand that still holds from "
        f"{called(folds, values['before'])} is on the part that moves; make it a blue fold"
    )


def _red_held_too_far(values: Values, folds: Folds) -> str:
    needed = values["needed_grip_radius_m"]
    return (
        f"{on_garment([values['at']])} must be held, but the nearest hand that still holds from "
        f"{called(folds, values['before'])} is {needed:.2f} m away and holds what is within "
        f"{values['grip_radius_m']:g} m; a grip radius of {rounded_up(needed)} m would do, or a blue fold"
    )


def _waits_for(values: Values, folds: Folds) -> str:
    return f"waits for {' and '.join(called(folds, fold) for fold in values['folds'])}, which cannot be done"


def _not_with_the_others(_values: Values, _folds: Folds) -> str:
    return "can be done, but not together with the others"


def _place(values: Values, _folds: Folds) -> str:
    way, turn = moved(*values["by"]), _TURNS[values["quarters"]]
    if not turn:
        return f"Move the garment {way}"
    return f"Turn the garment {turn}" + (f" and move it {way}" if way else "")


def _smaller(values: Values, _folds: Folds) -> str:
    width, height = (in_cm(length_m) for length_m in values["size_m"])
    return f"Make the garment {100.0 * values['by']:.0f} % smaller, {width} by {height}"


def _shift_fold(values: Values, folds: Folds) -> str:
    return f"Shift {called(folds, values['fold'])} {in_cm(values['by_m'])} {direction(*values['towards'])}"


def _shift_folds(values: Values, folds: Folds) -> str:
    return " and ".join(_shift_fold(shift, folds) for shift in values["shifts"])


def _flip_fold(values: Values, folds: Folds) -> str:
    return f"Fold the other side of the cloth at {called(folds, values['fold'])}"


def _fold_before(values: Values, folds: Folds) -> str:
    return f"Make {called(folds, values['fold'])} before {called(folds, values['before'])}"


def _fold_in_order(values: Values, folds: Folds) -> str:
    return "Fold in the order " + ", ".join(f"{fold} '{folds[fold].name}'" for fold in values["folds"])


def _split_fold(values: Values, folds: Folds) -> str:
    return f"Do {called(folds, values['fold'])} in two, the outer {in_cm(values['depth_m'])} first"


def _halve_first(values: Values, folds: Folds) -> str:
    return f"Halve the cloth across {called(folds, values['fold'])} first"


def _stand_also_at(values: Values, _folds: Folds) -> str:
    where = moved(*values["at"])
    named = f"Let the robot also stand at a station {values['station']!r}"
    return f"{named}, {where} as seen from the table's middle" if where else named


def _other_robot(values: Values, _folds: Folds) -> str:
    return f"Let {values['title']} fold it, at its own table"


def _assume_comfort(values: Values, _folds: Folds) -> str:
    return f"Assume that a comfort radius of {in_cm(values['comfort_m'])} is enough, not {in_cm(values['now_m'])}"


def _assume_friction(values: Values, _folds: Folds) -> str:
    return f"Assume a friction coefficient of {values['friction']:g}, not {values['now']:g}"


def _assume_grip_radius(values: Values, folds: Folds) -> str:
    names = ", ".join(called(folds, fold) for fold in values["folds"])
    return f"Assume that one grip holds the cloth within {in_cm(values['grip_radius_m'])} in {names}"


def _assume_together(values: Values, folds: Folds) -> str:
    first, *others = [FOLDS[part["code"]](part, folds) for part in values["parts"]]
    return " and ".join((first, *(other[0].lower() + other[1:] for other in others)))


FOLDS: Mapping[str, Callable[[Values, Folds], str]] = {
    "red_unheld": _red_unheld,
    "red_held_too_far": _red_held_too_far,
    "waits_for": _waits_for,
    "not_with_the_others": _not_with_the_others,
    "place": _place,
    "smaller": _smaller,
    "shift_fold": _shift_fold,
    "shift_folds": _shift_folds,
    "flip_fold": _flip_fold,
    "fold_before": _fold_before,
    "fold_in_order": _fold_in_order,
    "split_fold": _split_fold,
    "halve_first": _halve_first,
    "stand_also_at": _stand_also_at,
    "other_robot": _other_robot,
    "assume_comfort": _assume_comfort,
    "assume_friction": _assume_friction,
    "assume_grip_radius": _assume_grip_radius,
    "assume_together": _assume_together,
}
"""Sentences about folds and changes by the message's code."""
