"""Sentences made from codes and numbers alone: every message of the planner has one, whole and with its numbers."""

import re
from types import SimpleNamespace
from typing import Any

import pytest

from planner.message import Message
from planner.words.catalogue import CODES, sentence, worded
from planner.words.lengths import direction, moved
from tests.messages import FOLDS, MESSAGES, RADII, REACH, codes_in

NAMED = [SimpleNamespace(**fold) for fold in FOLDS]
OURS = [says for says in MESSAGES if says["code"] in CODES]
PLANNING = ("planner/explain", "planner/primitives", "planner/motion", "planner/planning")


def message(says: dict[str, Any]) -> Message:
    """Return a message with rubbish in place of its sentence."""
    return Message(says["code"], "RUBBISH", {name: value for name, value in says.items() if name != "code"})


def test_every_message_about_planning_has_a_sentence_here_and_a_sample_for_the_page() -> None:
    emitted = codes_in(*PLANNING) | codes_in("planner", made_by=("worded",))
    assert {"slips", "out_of_reach", "place"} <= emitted <= CODES
    assert emitted <= {says["code"] for says in MESSAGES}


@pytest.mark.parametrize("says", OURS, ids=[f"{number}-{says['code']}" for number, says in enumerate(OURS)])
def test_a_sentence_is_whole_and_made_from_the_numbers_alone(says: dict[str, Any]) -> None:
    words = sentence(message(says), NAMED, 1)
    assert words.startswith("fold 1 'edge 3, 5 cm from mum's hem': ")
    assert not re.search(r"RUBBISH|None|nan|inf\b|\{|\}|[a-z]_[a-z]*_m\b", words)
    assert not words.endswith((".", ";", " "))
    assert sentence(message(says), NAMED) == words.partition("hem': ")[2]


@pytest.mark.parametrize(
    ("says", "words"),
    [
        (
            REACH,
            "the left grip at (-0.50, 0.25) m, 0.05 m below the table's top at the top of its way, as high as it is "
            "far from the fold line, is 0.04 m out of reach from where the base is by then (too far up, shoulder pan "
            "limit); closest: front_right, backed off 0.20 m (the cloth dragged by (-0.10, 0.00) m from where it "
            "starts and held on to); all of its way is in reach 0.05 m nearer to the robot: move the cloth or the "
            "station",
        ),
        (
            {"code": "too_many_grips", "points": [[0.42, 0.75], [0.6, 0.4], [0.6, 0.0]], "hands": 2, **RADII},
            "3 points of its edge must be held, (0.42, 0.75) and (0.60, 0.40) and (0.60, 0.00) m of the garment, more "
            "than 2 hands can when each holds what is within 0.127 m of it; a grip radius of 0.151 m would do, or a "
            "fold that moves less",
        ),
        (
            {"code": "slips", "hanging_m2": {"near": 0.03}, "lying_m2": 0.01, "friction": 1.0, "needed_friction": 3.0},
            "the cloth slips: 0.030 m^2 of cloth (75.0%) hangs over the near edge and 0.010 m^2 (25.0%) lies on the "
            "table, layers counted; the friction is 1.00, 3.00 would hold it",
        ),
        ({"code": "fold_in_order", "folds": [1, 0]}, "Fold in the order 1 'edge 3, 5 cm from mum's hem', 0 ''"),
    ],
    ids=["out_of_reach", "too_many_grips", "slips", "fold_in_order"],
)
def test_a_sentence_says_where_how_much_and_what_to_do(says: dict[str, Any], words: str) -> None:
    assert sentence(message(says), NAMED) == words


def test_the_sentence_that_a_message_comes_with_is_used_only_where_none_can_be_made() -> None:
    assert sentence(Message.plain("no numbers"), NAMED) == "no numbers"
    assert sentence(Message("from_a_newer_version", "says so", {"off_m": 1.0}), NAMED) == "says so"
    assert sentence(Message("beside_table", "has no number", {}), NAMED) == "has no number"
    assert sentence(Message("beside_table", "no number", {"off_m": "far"}), NAMED) == "no number"
    assert sentence(Message("waits_for", "no such fold", {"folds": [7]}), NAMED) == "no such fold"


def test_a_message_is_made_with_its_sentence() -> None:
    made = worded("waits_for", {"folds": [0]}, NAMED, 1)
    assert made.text == sentence(message({"code": "waits_for", "folds": [0]}), NAMED, 1)
    assert made.to_dict() == {"code": "waits_for", "folds": [0]}


def test_directions_are_the_robots() -> None:
    assert moved(-0.08, 0.05) == "8 cm towards the robot and 5 cm to the left"
    assert moved(0.1, 0.0) == "10 cm away from the robot"
    assert direction(0.0, -1.0) == "to the right"
    assert direction(0.7, 0.7) == "away from the robot and to the left"
