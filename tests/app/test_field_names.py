"""Errors name the fields of what was sent, and no variant of a type that was tried."""

from typing import Any

import pytest

from app.api.document_messages import COMMANDS
from planner.errors import FieldError
from planner.json_form import JsonForm
from planner.robots.card_file import CardFile
from planner.robots.known_robots import shipped_card


@pytest.mark.parametrize(
    ("command", "told"),
    [
        ({}, "do: is missing"),
        ({"do": "seek"}, "t_s: is missing"),
        ({"do": "seek", "t_s": None}, "t_s: Input should be a valid number, not None"),
        ({"do": "seek", "t_s": 1.0, "speed": 2.0}, "speed: is not a known field"),
        ({"do": "plan_from_state", "start": {"held": [{"arm": "left"}]}}, "start.held[0].point: is missing"),
    ],
)
def test_a_commands_field_is_named_without_the_command(command: dict[str, Any], told: str) -> None:
    with pytest.raises(FieldError) as error:
        COMMANDS.read(command)
    assert str(error.value) == told


def test_an_unknown_command_is_named_beside_those_that_there_are() -> None:
    with pytest.raises(FieldError, match=r"do: expected one of 'play', 'pause', .*; got 'dance'"):
        COMMANDS.read({"do": "dance"})


def test_a_robots_scene_needs_stations() -> None:
    card = shipped_card("so101-pair").to_dict()
    card["scene"]["stations"] = None
    with pytest.raises(FieldError, match=r"scene\.stations: Input should be an object, not None"):
        JsonForm(CardFile).read(card)
