"""Put lengths and directions into words, as the robot sees them from the near edge of the table."""

_NOTICEABLE_M = 0.0005
"""Length below which a component of a move is left out of the words (m)."""


def in_cm(length_m: float) -> str:
    """Return a length in words, as in "12.5 cm"."""
    return f"{100.0 * length_m:.3g} cm"


def moved_words(dx_m: float, dy_m: float) -> str:
    """Put a move in the table frame into words, as in "8 cm towards the robot and 5 cm to the left"; empty for none."""
    parts = []
    if abs(dx_m) > _NOTICEABLE_M:
        parts.append(f"{in_cm(abs(dx_m))} {ahead_word(dx_m)}")
    if abs(dy_m) > _NOTICEABLE_M:
        parts.append(f"{in_cm(abs(dy_m))} {side_word(dy_m)}")
    return " and ".join(parts)


def direction_words(x: float, y: float) -> str:
    """Put a direction in the table frame into words, as in "towards the robot".

    Both axes are named where the direction is more than 22 degrees off either axis.
    """
    oblique = 0.4
    parts = []
    if abs(x) > oblique * abs(y):
        parts.append(ahead_word(x))
    if abs(y) > oblique * abs(x):
        parts.append(side_word(y))
    return " and ".join(parts)


def ahead_word(x: float) -> str:
    """Return the direction along the table's x axis in words."""
    return "away from the robot" if x > 0.0 else "towards the robot"


def side_word(y: float) -> str:
    """Return the direction along the table's y axis in words."""
    return "to the left" if y > 0.0 else "to the right"
