"""Garments rolled up: turns of one width from one end, each over the roll so far."""

from collections.abc import Sequence
from itertools import islice

import pytest

from planner import Garment, load_garment, propose_folds
from planner.proposals.packet import Packet
from planner.proposals.rolling import RollSearch

NAPKIN = Garment.from_dict({"name": "napkin", "outline": [[0, 0], [0.2, 0], [0.2, 0.3], [0, 0.3]]})


def rolls(garment: Garment, count: int) -> Sequence[Packet]:
    return tuple(islice(RollSearch(garment, 8).packets(), count))


def test_each_turn_is_as_wide_as_the_roll_and_takes_it_along() -> None:
    first = rolls(NAPKIN, 1)[0]
    width_m = 0.1
    assert first.size_m == pytest.approx((0.2, width_m))
    assert [fold.start[1] for fold in first.folds] == pytest.approx([width_m, 2 * width_m])
    assert (first.layers, [fold.name for fold in first.folds]) == (3, ["bottom roll"] * 2)


def test_a_t_shirt_is_made_a_full_rectangle_before_it_is_rolled() -> None:
    t_shirt = load_garment("t-shirt")
    bare = Garment.from_dict({"name": "t-shirt", "outline": [list(point) for point in t_shirt.outline]})
    found = rolls(bare, 4)
    assert all(packet.moves[0][0] in ("flaps", "sides") for packet in found)
    assert all(packet.hollow < 0.01 for packet in found)


def test_folds_that_stand_are_the_beginning_and_count_among_the_most() -> None:
    folded = Garment.from_dict(
        {**NAPKIN.to_dict(), "folds": [{"name": "half", "kind": "blue", "start": [0.1, 0.3], "end": [0.1, 0.0]}]}
    )
    found = tuple(RollSearch(folded, 3).packets())
    assert found and all(packet.folds[0].name == "half" and len(packet.folds) <= 3 for packet in found)


def test_a_robot_rolls_a_napkin_up() -> None:
    proposal = next(propose_folds(NAPKIN, "roll", count=1))
    assert proposal.status == "solved"
    assert min(proposal.size_m) == pytest.approx(0.1)
