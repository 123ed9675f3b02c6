"""Messages to pages in words and numbers, and their described models."""

from dataclasses import replace

import pytest

from app.api.answers import ReasonAnswer
from app.api.live_messages import plan_message, status_text
from app.document import Document
from app.document_state import DocumentState
from app.drawing.draft import draft_of
from app.drawing.garment_drawing import drawing_of
from planner import Plan, load_garment, make_plan
from tests.replay.planned import planned, shipped_plan
from tests.required import required

T_SHIRT = load_garment("t-shirt")


def answered(plan: Plan, *, is_final: bool = True) -> DocumentState:
    """Return a T-shirt's document with its plan."""
    document = Document(draft_of(drawing_of(T_SHIRT)))
    task = document.state.task
    assert task is not None
    document.settle(1, task, plan, "id", is_final=is_final)
    return document.state


@pytest.fixture(scope="module")
def cut_short() -> Plan:
    return make_plan(T_SHIRT, max_expanded=1)


def test_when_a_search_is_cut_short_it_is_said_how_far_the_search_came_and_what_would_help(cut_short: Plan) -> None:
    state = answered(cut_short)
    # Each of five blue folds takes three arm motions of 3 s.
    assert status_text(state) == (
        f"No plan: searched {cut_short.statistics.ways} ways and found none; any plan takes at least 45.0 s. "
        "To look longer may help, or fewer folds that may be done in any order"
    )
    message = plan_message(state)
    assert (message["status"], message["plan"]["reasons"]) == ("budget_exceeded", [])
    assert message["may_look_longer"] and not plan_message(answered(shipped_plan("t-shirt")))["may_look_longer"]


def test_many_ways_are_told_with_a_comma_and_a_bound_only_where_there_is_one(cut_short: Plan) -> None:
    later = replace(cut_short, statistics=replace(cut_short.statistics, ways=12345, bound_s=None))
    assert "searched 12,345 ways and found none. To look longer" in status_text(answered(later))


def test_what_any_plan_takes_is_told_until_that_is_known_to_be_the_plans_cost() -> None:
    plan = shipped_plan("t-shirt")
    open_s = replace(plan, statistics=replace(plan.statistics, bound_s=required(plan.cost_s) - 2.0))
    told = [plan_message(answered(one))["plan"]["at_least_s"] for one in (plan, open_s)]
    assert told == [None, required(plan.cost_s) - 2.0]


def test_of_a_garment_without_folds_it_is_said_what_is_missing() -> None:
    plan = make_plan(replace(T_SHIRT, folds=()))
    assert plan.primitives == ()
    assert status_text(answered(plan)) == "No folds yet: draw the first one"


def test_whether_a_quicker_plan_is_looked_for_is_told_beside_the_same_words() -> None:
    plan = shipped_plan("t-shirt")
    states = [answered(plan, is_final=is_final) for is_final in (False, True)]
    assert [plan_message(state)["plan"]["is_final"] for state in states] == [False, True]
    told = f"Planned: {len(plan.primitives)} steps, {plan.cost_s:.1f} s"
    assert [status_text(state) for state in states] == [told, told]


@pytest.mark.long
def test_a_reason_has_the_fields_that_are_described_and_no_others() -> None:
    (reason, *_) = planned("tie-halved").plan["reasons"]
    assert set(reason) == set(ReasonAnswer.model_fields)
    assert ReasonAnswer.model_validate(reason).model_dump(mode="json", exclude_unset=True) == reason
