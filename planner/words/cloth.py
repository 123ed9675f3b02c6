"""Sentences about cloth that does not stay where it lies, and about folds that leave it so."""

from collections.abc import Callable, Mapping

from planner.words.lengths import Values, carried, on_garment, rounded_up

_SMALL_M = 0.005
"""Shortest way off the table that a sentence tells (m)."""


def _beside_table(values: Values) -> str:
    off_m = values["off_m"]
    where = f": it is {off_m:.2f} m beside it" if off_m >= _SMALL_M else ""
    return f"nothing of the cloth lies on the table{where}"


def _corner_covered(values: Values) -> str:
    (x, y), depth_m = values["corner"], values["depth_m"]
    return f"the cloth covers the table's corner at ({x:.3f}, {y:.3f}) m, which is {depth_m:.2f} m inside it"


def _slips(values: Values) -> str:
    hanging, lying_m2 = values["hanging_m2"], values["lying_m2"]
    whole = lying_m2 + sum(hanging.values())
    over = [
        f"{area:.3f} m^2 of cloth ({area / whole:.1%}) hangs over the {edge} edge" for edge, area in hanging.items()
    ]
    lying = f"{lying_m2:.3f} m^2 ({lying_m2 / whole:.1%}) lies on the table, layers counted"
    return f"the cloth slips: {', '.join(over)} and {lying}; {_friction(values)}"


def _friction(values: Values) -> str:
    needed = values["needed_friction"]
    enough = "" if needed is None else f", {rounded_up(needed, 2)} would hold it"
    return f"the friction is {values['friction']:.2f}{enough}"


_AT_REST: Mapping[str, Callable[[Values], str]] = {
    "beside_table": _beside_table,
    "corner_covered": _corner_covered,
    "hangs_from_several": lambda values: (
        f"a part of {values['area_m2']:.3f} m^2 hangs from {' and '.join(values['edges']) or 'no edge'} at once"
    ),
    "hangs_loose": lambda values: (
        f"layer {values['layer']} hangs over the {values['edge']} edge and nothing holds its corner at "
        f"{on_garment([values['at']])}, {values['beyond_m']:.2f} m beyond the edge"
    ),
    "slips": _slips,
}


def _at_start(values: Values) -> str:
    what = values["what"]
    remedy = "it is too large for the table" if values["is_too_large"] else "place it so that it stays"
    return f"as the garment lies at the start, {_AT_REST[what['code']](what)}; {remedy}{carried(values)}"


def _afterwards(values: Values) -> str:
    what = values["what"]
    return f"afterwards {_AT_REST[what['code']](what)}{carried(values)}"


CLOTH: Mapping[str, Callable[[Values], str]] = {
    **_AT_REST,
    "slips_on_the_way": lambda values: f"the cloth slips wherever it would be in reach; {_friction(values)}",
    "at_start": _at_start,
    "afterwards": _afterwards,
    "line_off_table": lambda values: (
        f"all of its line lies beyond the table's edge, by {values['off_m']:.2f} m; a part must be on the table"
        f"{carried(values)}"
    ),
    "turn_off_table": lambda values: (
        f"the edge about which it turns reaches {values['off_m']:.2f} m beyond the table's edge; all of it must be on "
        f"the table{carried(values)}"
    ),
    "behind_line": lambda values: (
        f"the part that moves reaches {values['behind_m']:.2f} m behind the line's extension, where the fold cannot "
        f"carry it; turn or lengthen the line, or fold that part by itself first{carried(values)}"
    ),
}
"""Sentences about cloth by the message's code."""
