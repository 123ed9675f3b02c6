"""Messages in the page's own words: made from a code and numbers, in its unit, never from a sentence."""

import re
from typing import Any

import pytest
from playwright.sync_api import Page

from tests.messages import FOLDED, FOLDS, HEM, MESSAGES, RADII, REACH, codes_in

NAMED = [f"{number}-{says['code']}" for number, says in enumerate(MESSAGES)]


def told(modules: Page, says: dict[str, Any], unit: str) -> str:
    """Return the page's words for a message whose sentence is useless."""
    words: str = modules.evaluate(
        """async ([told, folds, name]) => {
          const { unit } = await import("/static/js/board/units.js");
          const { inWords } = await import("/static/js/messages/in_words.js");
          unit.name = name;
          return inWords(told, folds);
        }""",
        [{"says": says, "message": "RUBBISH"}, FOLDS, unit],
    )
    return words


def test_the_page_has_words_for_every_message_that_is_made(modules: Page) -> None:
    codes = codes_in("planner", "app")
    known = {says["code"] for says in MESSAGES}
    assert {code for code in codes if not any(name.startswith(code) for name in known)} == set()
    assert {name for name in known if not any(name.startswith(code) for code in codes)} == set()


@pytest.mark.parametrize("says", MESSAGES, ids=NAMED)
def test_a_message_is_told_in_the_pages_unit_from_its_numbers_alone(modules: Page, says: dict[str, Any]) -> None:
    in_cm, in_inches = (told(modules, says, unit).replace(HEM, "").replace("mum", "") for unit in ("cm", "in"))
    for words in (in_cm, in_inches):
        assert not re.search(r"RUBBISH|undefined|NaN|null|object|_|\de\+|fold 0|edge 0|point 0|layer 0", words)
        assert not re.search(r"\d\)? m\b|\d mm\b|\dm\b", words)
        assert "-5 cm over" not in words
    assert not re.search(r"\d\)? in\b", in_cm)
    assert not re.search(r"\bcm\b", in_inches)


TOLD_EXACTLY = [
    ({"code": "edges_cross", "edges": [0, 2], "at": [0.25, 0.25]}, "edges 1 and 3 cross at (25, 25) cm of the garment"),
    (
        {"code": "measure_not_less", **FOLDED, "what": "the width less {}", "by_m": 0.02},
        "folded width (70 cm) must be less than the width less 2 cm (66.6 cm)",
    ),
    (
        {"code": "end_off_boundary", "at": [0.42, 0.75], "off_m": 0.1047, "most_m": 0.005},
        "its end at (42, 75) cm of the garment is 10.5 cm from the cloth\u2019s edge; ends within 0.5 cm snap to it",
    ),
    (
        {"code": "stand_also_at", "station": "middle_left", "at": [0.0, 400.0]},
        "let the robot also stand at a station \u201cmiddle left\u201d, 40000 cm to the left as seen from the "
        "table\u2019s middle",
    ),
    (
        {"code": "too_many_grips", "points": [[0.42, 0.75], [0.6, 0.4], [0.6, 0.0]], "hands": 2, **RADII},
        "3 points of its edge must be held, at (42, 75) cm, (60, 40) cm and (60, 0) cm of the garment: more than 2 "
        "hands can when each holds what is within 12.7 cm of it. A grip radius of 15.1 cm would do, or a fold that "
        "moves less",
    ),
    (
        REACH,
        "the left grip at (-50, 25) cm from the table\u2019s middle, 5 cm below the table\u2019s top at the top of its "
        "way, as high as it is far from the fold line, is 4 cm out of reach from where the base is by then (too far "
        "up, shoulder pan limit). Closest: front right, backed off 20 cm (the cloth dragged 10 cm towards the robot "
        "from where it starts and held on to). All of its way is in reach 5 cm nearer to the robot: move the cloth or "
        "the station",
    ),
    ({"code": "waits_for", "folds": [0, 1]}, f"waits for fold 1 and {HEM}, which cannot be done"),
]


@pytest.mark.parametrize(("says", "words"), TOLD_EXACTLY, ids=[str(says["code"]) for says, _ in TOLD_EXACTLY])
def test_a_message_says_where_how_much_and_what_to_do(modules: Page, says: dict[str, Any], words: str) -> None:
    assert told(modules, says, "cm") == words


def test_a_message_without_numbers_is_its_sentence(modules: Page) -> None:
    assert modules.evaluate(
        "import('/static/js/messages/in_words.js').then((m) => m.inWords({ says: null, message: 'so it is' }, []))"
    ) == ("so it is")
