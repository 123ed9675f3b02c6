"""Sentences that name folds of the garment: why a fold cannot be done, and changes that would give a plan."""

from collections.abc import Callable, Mapping

from planner.words.lengths import Folds, Values, called, direction, in_cm, moved, on_garment, rounded_up

_TURNS = ("", "by 90 degrees to the left", "by 180 degrees", "by 90 degrees to the right")
"""Quarter turns in words."""


def _red_held_too_far(values: Values, folds: Folds) -> str:
    needed = values["needed_grip_radius_m"]
    return (
        f"{on_garment([values['at']])} must be held, but the nearest hand that still holds from "
        f"{called(folds, values['before'])} is {needed:.2f} m away and holds what is within "
        f"{values['grip_radius_m']:g} m; a grip radius of {rounded_up(needed)} m would do, or a blue fold"
    )


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


def _stand_also_at(values: Values, _folds: Folds) -> str:
    where = moved(*values["at"])
    named = f"Let the robot also stand at a station {values['station']!r}"
    return f"{named}, {where} as seen from the table's middle" if where else named


def _assume_grip_radius(values: Values, folds: Folds) -> str:
    names = ", ".join(called(folds, fold) for fold in values["folds"])
    return f"Assume that one grip holds the cloth within {in_cm(values['grip_radius_m'])} in {names}"


def _assume_together(values: Values, folds: Folds) -> str:
    first, *others = [FOLDS[part["code"]](part, folds) for part in values["parts"]]
    return " and ".join((first, *(other[0].lower() + other[1:] for other in others)))


FOLDS: Mapping[str, Callable[[Values, Folds], str]] = {
    "red_unheld": lambda values, folds: (
        f"{on_garment([values['at']])} must be held, but no hand that still holds from "
        f"{called(folds, values['before'])} is on the part that moves; make it a blue fold"
    ),
    "red_held_too_far": _red_held_too_far,
    "waits_for": lambda values, folds: (
        f"waits for {' and '.join(called(folds, fold) for fold in values['folds'])}, which cannot be done"
    ),
    "not_with_the_others": lambda _values, _folds: "can be done, but not together with the others",
    "place": _place,
    "smaller": _smaller,
    "shift_fold": _shift_fold,
    "shift_folds": lambda values, folds: " and ".join(_shift_fold(shift, folds) for shift in values["shifts"]),
    "flip_fold": lambda values, folds: f"Fold the other side of the cloth at {called(folds, values['fold'])}",
    "fold_before": lambda values, folds: (
        f"Make {called(folds, values['fold'])} before {called(folds, values['before'])}"
    ),
    "fold_in_order": lambda values, folds: (
        "Fold in the order " + ", ".join(f"{fold} '{folds[fold].name}'" for fold in values["folds"])
    ),
    "split_fold": lambda values, folds: (
        f"Do {called(folds, values['fold'])} in two, the outer {in_cm(values['depth_m'])} first"
    ),
    "halve_first": lambda values, folds: f"Halve the cloth across {called(folds, values['fold'])} first",
    "stand_also_at": _stand_also_at,
    "other_robot": lambda values, _folds: f"Let {values['title']} fold it, at its own table",
    "assume_comfort": lambda values, _folds: (
        f"Assume that a reach margin of {in_cm(values['comfort_m'])} is enough, not {in_cm(values['now_m'])}"
    ),
    "assume_friction": lambda values, _folds: (
        f"Assume a friction coefficient of {values['friction']:g}, not {values['now']:g}"
    ),
    "assume_grip_radius": _assume_grip_radius,
    "assume_together": _assume_together,
}
"""Sentences about folds and changes by the message's code."""
