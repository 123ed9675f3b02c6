"""Lengths and directions in words, as the robot sees them from the near edge of the table."""

_NOTICEABLE_M = 0.0005


def in_cm(length_m: float) -> str:
    """A length, as in "12.5 cm"."""
    return f"{100.0 * length_m:.3g} cm"


def moved_words(dx_m: float, dy_m: float) -> str:
    """A way in the table frame, as in "8 cm towards the robot and 5 cm to the left"; empty for none."""
    parts = []
    if abs(dx_m) > _NOTICEABLE_M:
        parts.append(f"{in_cm(abs(dx_m))} {ahead_word(dx_m)}")
    if abs(dy_m) > _NOTICEABLE_M:
        parts.append(f"{in_cm(abs(dy_m))} {side_word(dy_m)}")
    return " and ".join(parts)


def direction_words(x: float, y: float) -> str:
    """A direction in the table frame, as in "towards the robot"; only what is more than 22 degrees off is oblique."""
    oblique = 0.4
    parts = []
    if abs(x) > oblique * abs(y):
        parts.append(ahead_word(x))
    if abs(y) > oblique * abs(x):
        parts.append(side_word(y))
    return " and ".join(parts)


def ahead_word(x: float) -> str:
    """Which way along the table's x axis."""
    return "away from the robot" if x > 0.0 else "towards the robot"


def side_word(y: float) -> str:
    """Which way along the table's y axis."""
    return "to the left" if y > 0.0 else "to the right"
