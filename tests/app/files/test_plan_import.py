"""A plan file is imported as the garment that it is a plan of."""

import json
from dataclasses import replace
from typing import Any

import httpx
import pytest

from app.files.import_file import LARGEST_FILE, import_file, largest
from planner import Plan, make_plan
from planner.cloth.garment import Garment
from planner.errors import FieldError
from planner.geometry.pose import Pose2
from tests.app.samples import towel
from tests.app.test_garbage import assert_problem

GARMENT = Garment.from_dict(towel())
ELSEWHERE = Pose2(-0.75, 0.2, -1.5707963267948966)


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(GARMENT, placement=ELSEWHERE)


def data(plan: Plan, **changes: Any) -> bytes:
    return json.dumps({**plan.to_dict(), **changes}).encode()


def test_it_is_the_garment_where_it_lies_at_the_plans_start(plan: Plan) -> None:
    found = import_file("towel.plan.json", data(plan))
    assert found.garment == replace(GARMENT, placement=ELSEWHERE)
    assert found.format == "json"
    assert (found.creases, found.sizes) == (None, None)


def test_a_note_says_that_it_was_a_plan_and_how_many_folds_were_done_at_its_start(plan: Plan) -> None:
    (note,) = import_file("towel.plan.json", data(plan)).notes
    assert note.to_dict() == {"code": "garment_of_plan", "folds_done": 0}
    assert note.text.startswith("the file is a plan: its garment was taken")
    rest = make_plan(replace(plan.task, start=plan.end))
    found = import_file("rest.json", data(rest))  # whatever it is called
    assert found.notes[0].to_dict() == {"code": "garment_of_plan", "folds_done": 1}
    assert "a plan after 1 of its folds" in found.notes[0].text
    assert found.garment == replace(GARMENT, placement=plan.end.placement)


@pytest.mark.parametrize(
    ("changes", "field"),
    [({"pleat_plan": 2}, "pleat_plan"), ({"steps": 3}, "steps"), ({"cost_s": 1.0}, "cost_s"), ({"more": 1}, "more")],
)
def test_what_is_wrong_with_a_plan_file_is_named(plan: Plan, changes: dict[str, Any], field: str) -> None:
    with pytest.raises(FieldError) as caught:
        import_file("towel.plan.json", data(plan, **changes))
    assert caught.value.field == field


def test_what_is_wrong_with_its_garment_is_named_within_its_task(plan: Plan) -> None:
    task = plan.task.to_dict()
    task["garment"] |= {"outline": [[0.0, 0.0]]}
    with pytest.raises(FieldError) as caught:
        import_file("towel.plan.json", data(plan, task=task))
    assert caught.value.field.startswith("task.garment.outline")


@pytest.mark.anyio
async def test_a_plan_file_may_be_larger_than_a_drawing(client: httpx.AsyncClient, plan: Plan) -> None:
    wide = data(plan) + b" " * LARGEST_FILE
    answer = await client.post("/api/imports", params={"filename": "a.plan.json"}, content=wide)
    assert answer.json()["says"] == [{"code": "garment_of_plan", "folds_done": 0}]
    assert answer.json()["garment"]["placement"] == ELSEWHERE.to_dict()
    problem = await client.post("/api/imports", params={"filename": "a.json"}, content=wide)
    assert_problem(problem, 413)
    assert largest("A.PLAN.JSON") == largest("a.plan.json") > largest("plan.json") == LARGEST_FILE


@pytest.mark.anyio
async def test_a_document_says_of_a_plan_that_is_none_which_field_is_wrong(
    client: httpx.AsyncClient, plan: Plan
) -> None:
    spoilt = data(plan, status="perhaps")
    answer = await client.post("/api/imports", params={"filename": "a.plan.json"}, content=spoilt)
    assert assert_problem(answer, 422)["errors"][0]["field"] == "status"
