"""Two states are equal if and only if all their fields are, to the grid."""

import pytest

from planner.primitives.state import Held, State

HERE = State(0b01, (0.1, 0.2), 1, 3, (Held(0, (0.3, 0.4)),), dragged=1)


def test_sums_in_another_order_are_the_same_state() -> None:
    other = State(0b01, (0.3 - 0.1 - 0.1, 0.1 + 0.1), 1, 3, (Held(0, (0.1 + 0.2, 0.4)),), dragged=1)
    assert other == HERE and hash(other) == hash(HERE)


@pytest.mark.parametrize(
    "other",
    [
        State(0b11, (0.1, 0.2), 1, 3, HERE.held, dragged=1),
        State(0b01, (0.1001, 0.2), 1, 3, HERE.held, dragged=1),
        State(0b01, (0.1, 0.2), 0, 3, HERE.held, dragged=1),
        State(0b01, (0.1, 0.2), 1, 2, HERE.held, dragged=1),
        State(0b01, (0.1, 0.2), 1, 3, (), dragged=1),
        State(0b01, (0.1, 0.2), 1, 3, (Held(1, (0.3, 0.4)),), dragged=1),
        State(0b01, (0.1, 0.2), 1, 3, (Held(0, (0.3001, 0.4)),), dragged=1),
        State(0b01, (0.1, 0.2), 1, 3, HERE.held, dragged=2),
    ],
    ids=["folds", "placement", "station", "standoff", "free hands", "other arm", "other grip", "held from a fold"],
)
def test_whatever_differs_makes_another_state(other: State) -> None:
    assert other != HERE


def test_a_state_is_no_other_kind_of_thing() -> None:
    assert HERE.key != HERE
