"""Garments small enough to plan at once."""

from typing import Any


def towel(name: str = "my-towel", **changes: Any) -> dict[str, Any]:
    """Return a small towel that is folded once."""
    return {
        "name": name,
        "title": "My towel",
        "outline": [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]],
        "folds": [{"name": "half", "kind": "blue", "start": [0.4, 0.15], "end": [0.0, 0.15]}],
        "placement": {"x_m": -0.7, "y_m": 0.2, "yaw_rad": -1.5707963267948966},
        **changes,
    }
