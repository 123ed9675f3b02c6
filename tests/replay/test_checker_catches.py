"""The checker itself: a tampered plan must not replay."""

import copy
import re
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tests.replay.checker import check
from tests.replay.planned import planned

Json = dict[str, Any]


def refusal(name: str, spoil: Callable[[Json], None], scene: Json | None = None) -> str:
    """Return the checker's error for a shipped garment's plan after it was tampered with."""
    case = planned(name)
    plan = copy.deepcopy(case.plan)
    spoil(plan)
    with pytest.raises(AssertionError) as caught:
        check(case.garment, {**case.scene, **(scene or {})}, plan)
    return str(caught.value)


def nth(plan: Json, kind: str, number: int = 0) -> Json:
    found: Json = [p for p in plan["primitives"] if p["kind"] == kind][number]
    return found


def retimed(plan: Json) -> None:
    """Return a plan with consistent start times and cost, so that only its order is wrong."""
    now = 0.0
    for primitive in plan["primitives"]:
        primitive["start_s"] = now
        now += primitive["duration_s"]
    plan["cost_s"] = now


def swap(plan: Json, a: int, b: int) -> None:
    primitives = plan["primitives"]
    primitives[a], primitives[b] = primitives[b], primitives[a]
    retimed(plan)


def drop(plan: Json, kind: str, number: int = 0) -> None:
    plan["primitives"].remove(nth(plan, kind, number))
    retimed(plan)


def shift(point: list[float], axis: int, by: float) -> None:
    point[axis] += by


def exchange_arms(grips: list[Json]) -> None:
    for grip in grips:
        grip["arm"] = {"left": "right", "right": "left"}[grip["arm"]]


def test_two_folds_in_the_wrong_order_are_caught() -> None:
    assert "waits for the folds [0]" in refusal("hand-towel", lambda plan: swap(plan, 0, 1))


def test_a_drag_that_is_left_out_is_caught() -> None:
    # Without it the skirt's first fold has neither the grips in hand nor the cloth where it says.
    assert "is not where cloth rests" in refusal("skirt", lambda plan: drop(plan, "drag"))


def test_a_fold_that_is_left_out_is_caught() -> None:
    assert "only the folds [0, 1] were done" in refusal("hand-towel", lambda plan: drop(plan, "fold", 2))


def test_a_fold_done_twice_is_caught() -> None:
    def repeat(plan: Json) -> None:
        plan["primitives"].append(copy.deepcopy(nth(plan, "fold", 2)))
        retimed(plan)

    assert "folded twice" in refusal("hand-towel", repeat)


def test_a_red_fold_that_its_blue_one_lets_go_before_is_caught() -> None:
    message = refusal("letter-towel", lambda plan: nth(plan, "fold").update(holds=False))
    assert "lets go before one" in message


def test_holding_on_where_no_red_fold_follows_is_caught() -> None:
    message = refusal("hand-towel", lambda plan: nth(plan, "fold", 1).update(holds=True))
    assert "holds on without a red fold" in message


def test_a_drag_said_to_hold_before_another_primitive_than_a_fold_is_caught() -> None:
    def hold_on(plan: Json) -> None:
        drag = nth(plan, "drag")
        drag["holds"] = True
        plan["primitives"].insert(plan["primitives"].index(drag) + 1, copy.deepcopy(drag))
        retimed(plan)

    assert "a drag while the hands hold cloth" in refusal("t-shirt", hold_on)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("kind", ["fold", "drag"])
def test_a_grip_three_centimetres_off_is_caught(kind: str, axis: int) -> None:
    message = refusal("t-shirt", lambda plan: shift(nth(plan, kind)["grips"][0]["pick"], axis, 0.03))
    assert any(words in message for words in ("the grip at", "best", "nearest grip", "from the table's edge"))


def test_a_grip_that_slides_along_the_edge_is_caught_though_it_still_holds_every_vertex() -> None:
    def slide(plan: Json) -> None:
        for key in ("pick", "apex", "place"):
            shift(nth(plan, "fold")["grips"][0][key], 1, -0.03)

    assert "best [0.0, 0.0]" in refusal("hand-towel", slide)


def test_arms_that_are_exchanged_are_caught() -> None:
    message = refusal("hand-towel", lambda plan: exchange_arms(nth(plan, "fold")["grips"]))
    assert "the left arm takes the grip on the right" in message


def test_arms_that_are_exchanged_while_they_hold_cloth_are_caught() -> None:
    message = refusal("letter-towel", lambda plan: exchange_arms(nth(plan, "fold", 1)["grips"]))
    assert "arm holds" in message


def test_a_grip_too_few_is_caught() -> None:
    assert "from the nearest grip" in refusal("hand-towel", lambda plan: nth(plan, "fold")["grips"].pop())


def test_two_grips_for_one_arm_are_caught() -> None:
    message = refusal("hand-towel", lambda plan: nth(plan, "fold")["grips"][0].update(arm="right"))
    assert "the arms are ['right', 'right']" in message


@pytest.mark.parametrize("key", ["apex", "place"])
def test_a_path_that_ends_or_turns_elsewhere_is_caught(key: str) -> None:
    message = refusal("shirt", lambda plan: shift(nth(plan, "fold", 3)["grips"][0][key], 2, 0.03))
    assert f"the {key} is 0.0300 m off" in message


def test_a_hanging_corner_taken_at_the_height_of_the_table_is_caught() -> None:
    # The big towel's first drag, by 0.4 m, takes its near corners from 0.05 m inside the edge to 0.35 m beyond it. Let
    # go there they would hang at the edge, 0.35 m below where the tool is at rest on the table: at
    # 0.02 - 0.35 = -0.33 m, 0.03 m outside the edge.
    assert nth(planned("big-towel").plan, "drag")["grips"][0]["place"][0] == pytest.approx(-0.75 - 0.4)

    def let_go(plan: Json) -> None:
        nth(plan, "drag")["holds"] = False
        nth(plan, "fold")["duration_s"] += 3.0
        retimed(plan)

    message = refusal("big-towel", let_go)
    rest = re.search(r"is not where cloth rests, that would be \((\S+), (\S+), (\S+)\)", message)
    assert rest is not None, message
    assert [float(rest[1]), float(rest[3])] == pytest.approx([-0.8 - 0.03, 0.02 - 0.35])


def test_a_drag_off_the_grid_is_caught() -> None:
    assert "no multiple of 0.10 m" in refusal("t-shirt", lambda plan: nth(plan, "drag").update(distance_m=0.25))


def test_a_drag_of_another_length_is_caught() -> None:
    assert "hand ends at" in refusal("t-shirt", lambda plan: nth(plan, "drag").update(distance_m=0.1))


def test_a_drag_towards_an_edge_from_which_cloth_hangs_is_caught() -> None:
    def drag_twice(plan: Json) -> None:
        # The big towel's first drag takes its near part beyond the edge, where it hangs once it is let go.
        drag = nth(plan, "drag")
        drag["holds"] = False
        plan["primitives"].insert(plan["primitives"].index(drag) + 1, copy.deepcopy(drag))
        retimed(plan)

    assert "towards an edge from which cloth hangs" in refusal("big-towel", drag_twice)


@pytest.mark.parametrize(
    ("by", "why"), [(0.1, "its legs are no multiple of 5 cm"), (-0.5, "too few for arms and base")]
)
def test_a_fold_with_another_duration_is_caught(by: float, why: str) -> None:
    def change(plan: Json) -> None:
        nth(plan, "fold", 1)["duration_s"] += by
        retimed(plan)
        plan["statistics"]["bound_s"] = plan["cost_s"]  # above its bound a plan may have arms that are late

    assert why in refusal("hand-towel", change)


@pytest.mark.parametrize(("kind", "name"), [("drag", "t-shirt"), ("move", "jeans")])
def test_a_drag_or_move_with_another_duration_is_caught(kind: str, name: str) -> None:
    def change(plan: Json) -> None:
        nth(plan, kind)["duration_s"] += 0.2
        retimed(plan)

    assert "takes" in refusal(name, change)


def test_a_way_through_the_table_is_caught() -> None:
    message = refusal("jeans", lambda plan: nth(plan, "move")["waypoints"].__delitem__(slice(2, 6)))
    assert "turns while it drives" in message or "through" in message


def test_a_move_that_is_left_out_is_caught() -> None:
    assert "the base is at front_right" in refusal("jeans", lambda plan: drop(plan, "move"))


def test_a_base_that_ends_at_another_station_is_caught() -> None:
    message = refusal("hand-towel", lambda plan: nth(plan, "fold")["base"].update(station="left"))
    assert "the base is at left" in message


@pytest.mark.parametrize(
    ("place", "spoil"),
    [
        ("the cost", lambda plan: plan.update(cost_s=plan["cost_s"] + 1)),
        ("starts at", lambda plan: nth(plan, "fold", 1).update(start_s=0.0)),
        ("the plan is infeasible", lambda plan: plan.update(status="infeasible")),
        ("the garment ends", lambda plan: plan["final_placement"].update(x_m=0.0)),
        ("is another one", lambda plan: plan["final_layers"].reverse()),
        ("is another one", lambda plan: plan["final_layers"][-1].update(face="front")),
        ("of cloth became", lambda plan: plan["final_layers"].pop()),
        ("the DAG's edges", lambda plan: plan["dag"]["edges"].pop()),
        ("the DAG's edges", lambda plan: plan["dag"]["edges"].append([0, 2])),
    ],
)
def test_bookkeeping_that_does_not_add_up_is_caught(place: str, spoil: Callable[[Json], None]) -> None:
    assert place in refusal("hand-towel", spoil)


def test_cloth_that_slips_on_a_smoother_table_is_caught() -> None:
    assert "the cloth slips" in refusal("scarf", lambda plan: None, {"friction": 0.05})


def test_a_table_on_which_nothing_of_the_cloth_would_lie_is_caught() -> None:
    table = {"depth_m": 0.2, "width_m": 0.2, "height_m": 0.79}
    assert "nothing of the cloth lies" in refusal("hand-towel", lambda plan: None, {"table": table})


def numbers(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the paths of all numbers in JSON, except booleans and indices."""
    if isinstance(node, dict):
        for key, value in node.items():
            yield from numbers(value, (*path, key))
    elif isinstance(node, list):
        for key, value in enumerate(node):
            yield from numbers(value, (*path, key))
    elif isinstance(node, float):
        yield path


@pytest.mark.parametrize("name", ["jeans", "letter-towel", "vest"])
def test_no_number_of_a_primitive_can_be_wrong_by_three_hundredths_unnoticed(name: str) -> None:
    case = planned(name)
    for path in numbers(case.plan["primitives"]):
        plan = copy.deepcopy(case.plan)
        node: Any = plan["primitives"]
        for key in path[:-1]:
            node = node[key]
        node[path[-1]] += 0.03
        with pytest.raises(AssertionError):
            check(case.garment, case.scene, plan)
            pytest.fail(f"{path} was changed and nobody noticed", pytrace=False)
