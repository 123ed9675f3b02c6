from collections.abc import Iterator, Sequence
from dataclasses import replace
from heapq import heappush
from types import SimpleNamespace
from typing import Any

import pytest

from app.files.slowed import slowed
from planner import Plan, Scene, Task, load_garment, make_plan, propose_folds
from planner.cloth.garment import DrawnFold
from planner.errors import FoldError, RequestError
from planner.geometry.pose import Pose2
from planner.geometry.region import Region
from planner.planning.plan_check import require_replay
from planner.proposals import proposals
from planner.proposals.packet import Packet
from planner.proposals.proposals import (
    Proposal,
    Proposals,
    _Aside,
    _Proposer,
    _turns,
    all_proposals,
)
from planner.proposals.target import is_fitting
from planner.task.reason import Code
from tests.replay.planned import shipped_plan
from tests.required import required
from tests.small_plan import small_plan

TOWEL = replace(load_garment("hand-towel"), folds=())


@pytest.fixture(scope="module")
def found() -> Proposals:
    return all_proposals(propose_folds(TOWEL, "shelf", count=3))


def test_what_is_proposed_for_a_towel_can_be_done_the_quickest_first(found: Proposals) -> None:
    assert [one.status for one in found.proposals] == ["solved"] * 3
    costs = [one.cost_s for one in found.proposals if one.cost_s is not None]
    assert costs == sorted(costs)
    assert found.is_any_solved
    assert not any(one.is_loose for one in found.proposals)
    assert found.tried.enumerated > 3


def test_a_proposal_has_the_plan_of_its_folds(found: Proposals) -> None:
    for one in found.proposals:
        plan = required(one.plan)
        assert plan.garment == one.garment
        assert one.garment.folds
        require_replay(Plan.from_dict(plan.to_dict()))


def test_proposals_are_different_ways(found: Proposals) -> None:
    assert len({one.size_m for one in found.proposals}) == 3


@pytest.mark.parametrize("is_image", [True, False])
def test_what_the_robot_does_sooner_mirrored_or_from_another_side_stands_in_for_what_was_proposed(
    is_image: bool,
) -> None:
    scarf = load_garment("scarf")
    *_, from_the_other_end = Packet.of(scarf).images(Region.polygon(scarf.outline))
    bare = scarf if is_image else replace(scarf, outline=((0.001, 0.0), *scarf.outline[1:]))  # not symmetric
    task = Task.of(replace(bare, folds=()), work_limit_s=1.0)
    slow, quick = (Packet.of(replace(bare, folds=folds)) for folds in (from_the_other_end, scarf.folds))
    plan = make_plan(replace(task, garment=replace(bare, folds=slow.folds)))
    first = Proposal(plan.garment, slow.size_m, slow.layers, slow.face, plan, number=2)
    (found,) = _Proposer(task, 1, lambda: False).better(slow, first, () if is_image else (quick,))
    assert required(found.cost_s) < required(first.cost_s) - 1.0
    assert found.cost_s == pytest.approx(required(shipped_plan("scarf").cost_s), abs=1e-5)
    assert (found.number, found.garment.folds) == (2, required(found.plan).garment.folds)
    assert found.size_m == pytest.approx(first.size_m, abs=0.005)


def test_a_tie_is_proposed_as_quick_as_its_own_folds_are_whatever_end_is_folded_first() -> None:
    tie = load_garment("tie")
    (found,) = all_proposals(propose_folds(replace(tie, folds=()), (0.102, 0.3745), count=1)).proposals
    assert required(found.cost_s) <= required(shipped_plan("tie").cost_s) + 1e-6


def test_its_json_has_the_folds_as_a_garment_file_has_them(found: Proposals) -> None:
    data = found.to_dict()
    assert set(data) == {"proposals", "enumerated"}
    for one, answer in zip(found.proposals, data["proposals"], strict=True):
        assert set(answer) == {"folds", "garment", "size_m", "layers", "face", "status", "cost_s", "is_loose", "number"}
        assert answer["folds"] == answer["garment"]["folds"] == one.garment.to_dict()["folds"]
        assert answer["cost_s"] == required(one.plan).cost_s


def test_each_is_told_as_it_is_found_after_different_ways_without_a_plan() -> None:
    heard: list[Proposal] = []
    answer = all_proposals(propose_folds(TOWEL, "shelf", count=2, untried=2), heard.append)
    assert sorted(heard[2:], key=lambda one: one.cost_s or 0.0) == list(answer.proposals)
    assert [(one.status, one.plan, one.cost_s) for one in heard[:2]] == [("untried", None, None)] * 2
    assert heard[0].size_m != heard[1].size_m


def test_a_robot_that_can_do_none_of_the_ways_shows_them_first_and_in_the_end_what_comes_nearest() -> None:
    heard: list[Proposal] = []
    jeans = replace(load_garment("jeans"), folds=())
    answer = all_proposals(propose_folds(jeans, "shelf", robot="ur5e-single", count=2, untried=2), heard.append)
    assert [one.status for one in heard[:4]] == ["untried"] * 2 + ["infeasible"] * 2
    assert [one.number for one in heard[2:4]] == [1, 2]
    assert list(answer.proposals) == heard[2:4]
    assert {(one.number, one.status) for one in heard[4:]} == {(0, "solved")}
    assert not any(is_fitting(one.size_m, (0.25, 0.30)) for one in heard[4:])


def test_where_nothing_fits_what_comes_nearest_is_told_as_soon_as_that_is_known() -> None:
    heard: list[Proposal] = []
    answer = all_proposals(propose_folds(TOWEL, (0.02, 0.02), max_folds=1, untried=1), heard.append)
    assert answer.proposals == ()
    assert [(one.number, one.status) for one in heard] == [(0, "untried"), (0, "solved")]
    assert heard[0].size_m == heard[1].size_m == answer.tried.nearest_m


@pytest.mark.long
def test_out_of_the_robots_reach_packets_are_proposed_as_infeasible() -> None:
    scene = replace(Scene(), stations=(("front", Pose2(-3.0, 0.0, 0.0)),))
    answer = all_proposals(propose_folds(TOWEL, "shelf", count=1, scene=scene))
    (only,) = answer.proposals
    assert (only.status, only.cost_s) == ("infeasible", None)
    assert not answer.is_any_solved
    assert required(only.plan).reasons[0].code is Code.OUT_OF_REACH


def test_where_no_packet_has_a_plan_with_its_work_they_are_planned_with_more() -> None:
    (proposal,) = all_proposals(propose_folds(TOWEL, "shelf", count=1, work_limit_s=0.02)).proposals
    assert proposal.status == "solved"
    with_that_work = make_plan(replace(required(proposal.plan).task, limits=Task.of(TOWEL, work_limit_s=0.02).limits))
    assert with_that_work.status == "budget_exceeded"


def test_the_first_comes_again_if_there_is_a_quicker_plan_for_its_folds() -> None:
    scarf = load_garment("scarf")
    heard: list[Proposal] = []
    answer = all_proposals(propose_folds(replace(scarf, folds=()), scarf, count=1), heard.append)
    first, again = (required(one.cost_s) for one in heard)
    assert again < first
    assert answer.proposals == (heard[1],)
    assert heard[1].garment.folds == heard[0].garment.folds


@pytest.mark.parametrize("is_firm", [True, False])
def test_a_loose_proposal_comes_again_with_a_firm_plan_though_that_takes_longer(
    is_firm: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = small_plan()
    packet = Packet.of(plan.garment)
    loose = Proposal(plan.garment, packet.size_m, packet.layers, packet.face, plan, is_loose=True)
    longer = SimpleNamespace(plan=slowed(plan, 0.5), context=SimpleNamespace(is_firm=is_firm))
    monkeypatch.setattr(_Proposer, "plan", lambda *_: longer)
    again = [*_Proposer(plan.task, 1, lambda: False).better(packet, loose, ())]
    assert [(one.is_loose, one.plan) for one in again] == ([(False, longer.plan)] if is_firm else [])


def test_what_is_put_aside_comes_again_the_least_bound_first_and_variants_last() -> None:
    folds = load_garment("hand-towel").folds
    begun = Packet.of(TOWEL)
    one = replace(begun, moves=(("half", 0),), folds=folds[:1])
    variant = replace(one, folds=folds[1:2])
    other = replace(begun, moves=(("thirds", 1),), folds=folds[:2])
    aside: list[_Aside] = []
    turns = _turns((one, variant, other), set(), set(), aside, [])
    for packet, bound_s in ((one, 2.0), (other, 1.0)):
        assert next(turns) == (packet, True)
        heappush(aside, _Aside(bound_s, packet.taste, packet))
    assert [*turns] == [(other, False), (one, False), (variant, False)]


def test_what_is_put_aside_comes_again_where_the_next_one_takes_long() -> None:
    one = replace(Packet.of(TOWEL), moves=(("half", 0),))
    aside: list[_Aside] = []
    turns = _turns((one, None), set(), set(), aside, [])
    assert next(turns) == (one, True)
    heappush(aside, _Aside(1.0, one.taste, one))
    assert next(turns) == (one, False)
    assert not aside


class Given:
    """A search that has found packets."""

    enumerated, nearest_m = 2, 0.0

    def __init__(self, *packets: Packet) -> None:
        self._packets = packets

    def packets(self) -> Iterator[Packet]:
        yield from self._packets


@pytest.mark.parametrize("spared_s", [2.0, 4.0])
def test_a_variant_of_a_sketched_way_is_proposed_only_if_it_spares_an_arm_motion(
    spared_s: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    task, plan = Task.of(TOWEL), small_plan()
    whole_s = required(plan.cost_s)
    costs = {"sketch": whole_s + spared_s, "variant": whole_s}
    folds = {name: (replace(load_garment("hand-towel").folds[0], name=name),) for name in costs}

    def proposal(packet: Packet, *_: object) -> Proposal:
        cost_s = costs[packet.folds[0].name]
        quick = slowed(plan, whole_s / cost_s)
        return Proposal(replace(TOWEL, folds=packet.folds), (cost_s, 0.3), 1, "front", quick)

    monkeypatch.setattr(_Proposer, "plan", lambda *_: None)
    monkeypatch.setattr(proposals, "_proposal", proposal)
    monkeypatch.setattr(_Proposer, "better", lambda *_: ())
    way = replace(Packet.of(TOWEL), moves=(("half", 0),))
    search = Given(*(replace(way, folds=folds[name], is_sketch=name == "sketch") for name in costs))
    found = [*_Proposer(task, 3, lambda: False).planned(search)]  # type: ignore[arg-type]
    names = [one.garment.folds[0].name for one in found]
    assert names == (["sketch", "variant"] if spared_s > task.scene.arm_motion_s else ["sketch"])


def test_nothing_more_is_proposed_once_it_is_stopped() -> None:
    assert all_proposals(propose_folds(TOWEL, "shelf", should_stop=lambda: True)).proposals == ()


def test_a_target_that_nothing_fits_has_no_proposals() -> None:
    answer = all_proposals(propose_folds(TOWEL, "1x1cm", max_folds=2))
    assert answer.proposals == ()
    assert answer.tried.enumerated > 0
    data = answer.to_dict()
    assert set(data) == {"proposals", "enumerated", "nearest_m"}
    assert all(0.01 < side_m < 0.4 for side_m in data["nearest_m"])


@pytest.mark.parametrize(
    ("field", "options"),
    [("count", {"count": 0}), ("count", {"count": 33}), ("max_folds", {"max_folds": 0}), ("face", {"face": "left"})],
)
def test_a_number_out_of_range_is_refused_at_once(field: str, options: dict[str, Any]) -> None:
    with pytest.raises(RequestError) as raised:
        propose_folds(TOWEL, "shelf", **options)
    assert raised.value.field == field


@pytest.mark.parametrize("to", ["attic", (0.2,), (0.0, 0.1)])
def test_a_size_that_is_none_is_refused_at_once(to: str | Sequence[float]) -> None:
    with pytest.raises(RequestError, match="to: "):
        propose_folds(TOWEL, to)


def test_a_fold_that_is_not_legal_is_refused_at_once() -> None:
    beside = DrawnFold("beside", "blue", (2.0, 0.0), (2.0, 1.0))
    with pytest.raises(FoldError, match=r"folds\[0\]"):
        propose_folds(replace(TOWEL, folds=(beside,)), "shelf")
