import base64
import math
import re
from typing import Any

import msgspec
import pytest
import zstandard

from app.files.recording import HOLD_S, recording
from app.language import ENGLISH, LANGUAGES, Language, named, translated
from app.step_kinds import step_caption
from app.ui.withdrawal import LASTS_S
from planner.task.plan import Plan
from tests.replay.planned import shipped_plan
from tests.required import required

DATA = re.compile(r'__VISER_EMBED_DATA__="([A-Za-z0-9+/=]+)"')


@pytest.fixture(scope="module")
def plan() -> Plan:
    return shipped_plan("hand-towel")


@pytest.fixture(scope="module")
def page(plan: Plan) -> str:
    return recording(plan, 2.0, lambda: False, ENGLISH, is_dark=True).decode()


@pytest.fixture(scope="module")
def film(page: str) -> dict[str, Any]:
    return played(page)


def played(page: str) -> dict[str, Any]:
    """Return the recording that a page plays, in viser's format: sizes, messages with their times, numbers."""
    packed = base64.b64decode(required(DATA.search(page)).group(1))
    whole = zstandard.ZstdDecompressor().decompress(packed[8:])
    length = int.from_bytes(whole[:8], "little")
    film: dict[str, Any] = msgspec.msgpack.decode(whole[8 : 8 + length])
    return film


def test_the_recording_lasts_as_long_as_the_plan_and_a_moment_more(plan: Plan, film: dict[str, Any]) -> None:
    assert film["durationSeconds"] == pytest.approx(required(plan.cost_s) + HOLD_S)


def test_there_is_a_frame_at_each_time_asked_for_and_at_the_end_until_the_arms_are_home(
    plan: Plan, film: dict[str, Any]
) -> None:
    times, end_s = {round(t, 6) for t, _ in film["messages"]}, required(plan.cost_s)
    frames = {round(number / 2.0, 6) for number in range(math.ceil(2.0 * end_s))}
    at_end = {round(end_s + number / 2.0, 6) for number in range(math.ceil(2.0 * LASTS_S) + 1)}
    assert at_end <= times <= frames | at_end
    # The hands move nearly always: while they do, a frame has something to say.
    assert len(times) > 0.9 * len(frames)


def test_robot_and_cloth_are_in_it_and_the_camera(film: dict[str, Any]) -> None:
    names = {message.get("name") for _, message in film["messages"]}
    kinds = {message["type"] for _, message in film["messages"]}
    assert {"/cloth/front", "/robot"} <= names
    assert "SetCameraPositionMessage" in kinds


def test_each_step_is_told_in_a_caption_while_it_goes_on(plan: Plan, film: dict[str, Any]) -> None:
    told = [
        (t_s, text)
        for t_s, message in film["messages"]
        if message.get("name") == "/caption"
        for text in [message.get("props", message.get("updates", {})).get("text")]
        if text is not None
    ]
    assert [text.split("/")[0] for _, text in told if text] == [str(n) for n in range(1, len(plan.steps) + 1)]
    for (t_s, text), step in zip(told, plan.steps, strict=True):
        assert step.start_s <= t_s <= step.start_s + 0.5
        assert step.kind in text.lower()


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_recording_speaks_the_documents_language(plan: Plan, language: Language) -> None:
    page = recording(plan, 1.0, lambda: False, language, is_dark=True).decode()
    caption = step_caption(plan, 0, language)
    assert f"<h1>{translated(language, plan.garment.title)}</h1>" in page
    assert caption.startswith(f"1/{len(plan.steps)}  {named(language, 'kind', plan.steps[0].kind)}: ")
    assert caption in str(played(page)["messages"])


def test_the_page_is_one_file_with_the_garments_title_that_asks_for_nothing_elsewhere(page: str) -> None:
    assert "<title>Hand towel - Pleat</title>" in page
    assert not re.search(r'<(?:script|link|img)[^>]+(?:src|href)="(?!data:)', page)
    assert "darkMode:true" in page


def test_it_stops_between_frames_when_nobody_wants_it_any_more(plan: Plan) -> None:
    asked = []

    def should_stop() -> bool:
        asked.append(True)
        return len(asked) > 3

    assert recording(plan, 10.0, should_stop, ENGLISH, is_dark=False) == b""
    assert len(asked) == 4
