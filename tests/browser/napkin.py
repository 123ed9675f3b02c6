"""A napkin of three folds that is planned at once: two sides in, independent of each other, then in half."""

from typing import Any


def napkin(**changes: Any) -> dict[str, Any]:
    return {
        "name": "napkin",
        "title": "Napkin",
        "outline": [[0.0, 0.0], [0.6, 0.0], [0.6, 0.4], [0.0, 0.4]],
        "folds": [
            {"name": "left", "kind": "blue", "start": [0.15, 0.0], "end": [0.15, 0.4]},
            {"name": "right", "kind": "blue", "start": [0.45, 0.4], "end": [0.45, 0.0]},
            {"name": "half", "kind": "blue", "start": [0.45, 0.2], "end": [0.15, 0.2]},
        ],
        "placement": {"x_m": -0.7, "y_m": -0.3, "yaw_rad": 0.0},
        **changes,
    }
