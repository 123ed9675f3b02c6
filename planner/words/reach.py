"""Sentences about points out of reach, collisions, and their remedies."""

from collections.abc import Callable, Mapping, Sequence

from planner.words.lengths import (
    Values,
    carried,
    counted_hands,
    height,
    in_degrees,
    in_metres,
    on_garment,
    point,
    rounded_down,
    rounded_up,
)

_OBLIQUE = 0.5
"""A direction component below this is left out of the words."""

_LISTED_MAX = 4
"""Points that are listed in full; of more, only the outermost are named."""

_MOMENTS = {
    "pick": "where it is picked up",
    "place": "where it is laid down",
    "top": "at the top of its way, as high as it is far from the fold line",
    "up": "on its way up",
    "down": "on its way down",
}

_DEMANDS = {
    "alone": "",
    "one orientation": " in the orientation that suits its way best",
    "driving": " from where the base is by then",
    "with the other hand": " from where the other hand has what it needs",
}

_CAUSES = {
    "too_far": "too far",
    "too_near": "too near",
    "joint_limit": "joint limit",
    "own_body": "the robot's own body is in the way",
}

_SIDES = (
    ("further from the robot", "nearer to the robot"),
    ("further to its left", "further to its right"),
    ("higher", "lower"),
)
"""Both directions along each axis of the base frame."""


def _out_of_reach(values: Values) -> str:
    is_fixed = values["station"] is None and values["back_off_m"] == 0.0
    closest = "" if is_fixed else f"; closest: {_stand(values)}, backed off {values['back_off_m']:.2f} m"
    return (
        f"the {values['arm']} grip at {point(values['at'])} m, {height(values['at'][2])} {_MOMENTS[values['moment']]}, "
        f"{_lack(values)}{closest}{carried(values)}{_advice(values)}"
    )


def _stand(values: Values) -> str:
    """Return the station in words; one without a name is where the base stands at the start."""
    return values["station"] or "where the base stands"


def _lack(values: Values) -> str:
    """Return in words by how much a point is out of reach, and why."""
    limit = None if values["joint"] is None else f"{values['joint']} limit"
    cause, demand = values["cause"], _DEMANDS[values["demand"]]
    by = ("at least " if values["is_at_least"] else "") + in_metres(values["short_by_m"])
    if cause == "comfort_only":
        return (
            f"can be reached, but with a margin of {rounded_down(values['comfort_m'] or 0.0)} m only, not "
            f"{values['wanted_comfort_m']:g} m{demand} ({limit or 'too far'}): reach margin short by {by} m"
        )
    why, up = _CAUSES[cause], values["towards"][2]
    if cause in ("too_far", "too_near") and not values["is_at_least"] and abs(up) > _OBLIQUE:
        why += " down" if up > 0.0 else " up"
    return f"is {by} m out of reach{demand} ({why if limit is None else f'{why}, {limit}'})"


def _advice(values: Values) -> str:
    """Return in words what was tried and brings the point into reach; empty where nothing has been tried yet."""
    movable, shift_m = values["movable"], values["shift_m"]
    is_enough = values.get("is_enough", True)
    if values["enough_comfort_m"] is not None:
        margin = f"a reach margin of {rounded_down(values['enough_comfort_m'])} m"
        return f"; {margin} works" if is_enough else f"; {margin} is part of what it takes"
    if values["enough_cone_rad"] is not None:
        pinches = f"pinches from within {in_degrees(values['enough_cone_rad'])} degrees of the way into the cloth"
        return f"; with {pinches} it can be done" if is_enough else f"; {pinches} are part of what it takes"
    if movable is None:
        return ""
    if movable:
        towards = values["shift_towards"]
        return f"; all of its way is in reach {in_metres(shift_m)} m {_whereto(towards)}: {_how(movable, towards[2])}"
    if values["is_at_least"]:
        return "; place the cloth or a station so that it is nearer"
    return f"; no shift of its path by up to {values['tried_m']:g} m helps: make a smaller fold"


def _how(movable: Sequence[str], up: float) -> str:
    """Return in words what to move, and whether up or down."""
    words = {
        "cloth": "move the cloth",
        "station": "the station" if "cloth" in movable else "move the station",
        "table": "raise the table" if up > 0.0 else "lower the table",
        "torso": "lower the torso" if up > 0.0 else "raise the torso",
    }
    return " or ".join(words[kind] for kind in movable)


def _whereto(towards: Sequence[float]) -> str:
    """Return a direction of the base frame in words."""
    words = [
        forwards if component > 0.0 else backwards
        for component, (forwards, backwards) in zip(towards, _SIDES, strict=True)
        if abs(component) > _OBLIQUE
    ]
    return " and ".join(words) or "nearer to its shoulder"


def _collision(values: Values) -> str:
    first, second = values["parts"]
    return (
        f"{_dragging(values)}from {_stand(values)} all is in reach, but with the {values['arm']} gripper at "
        f"{point(values['at'])} m, {height(values['at'][2])}, the {first} would hit the {second} by "
        f"{values['depth_m']:.3f} m at least, however the arm is bent{carried(values)}"
    )


def _dragging(values: Values) -> str:
    """Return in words the drag in which the arms collide; empty where they collide in the fold."""
    return "" if values["drag"] is None else f"to drag the cloth by {point(values['drag'])} m, "


def _too_many_grips(values: Values) -> str:
    points = values["points"]
    where = f"from {point(points[0])} round to {on_garment(points[-1:])}"
    return (
        f"{len(points)} points of its edge must be held, {where if len(points) > _LISTED_MAX else on_garment(points)}, "
        f"more than {counted_hands(values['hands'])} can when each holds what is within {values['grip_radius_m']:g} m "
        f"of it; a grip radius of {rounded_up(values['needed_grip_radius_m'])} m would do, or a fold that moves less"
    )


def _wider_grip(values: Values) -> str:
    where = ", in drags too," if values["in_drags"] else ""
    needed = rounded_up(values["needed_grip_radius_m"])
    return f"a grip radius of {needed} m{where} would do, now {values['grip_radius_m']:g} m"


def _stiffer_cloth(values: Values) -> str:
    needed, now = in_degrees(values["needed_support_angle_rad"]), in_degrees(values["support_angle_rad"])
    return f"too many points must be held, unless cloth holds itself within {needed} degrees of upright, now {now}"


REACH: Mapping[str, Callable[[Values], str]] = {
    "out_of_reach": _out_of_reach,
    "arms_cannot_get_there": lambda values: (
        f"{_dragging(values)}from {_stand(values)} the hands could be where they must, but the arms cannot get them "
        f"there and along their way within the limits of their joints, without touching the table, the robot or each "
        f"other{carried(values)}"
    ),
    "collision": _collision,
    "too_many_grips": _too_many_grips,
    "grips_too_close": lambda values: (
        f"its grips, at {on_garment(values['points'])}, are {values['apart_m']:.3f} m apart, and two hands need "
        f"{values['needed_apart_m']:.2f} m; with a grip radius of {rounded_up(values['needed_grip_radius_m'])} m, now "
        f"{values['grip_radius_m']:g} m, one hand would hold both"
    ),
    "wider_grip": _wider_grip,
    "stiffer_cloth": _stiffer_cloth,
    "one_more_hand": lambda values: (
        f"must be held at more points than {counted_hands(values['hands'])} can; one more would do"
    ),
}
"""Sentences about hands by the message's code."""
