import math

import numpy as np
import pytest

from app.document import Document
from app.drawing.draft import draft_of
from app.drawing.garment_drawing import drawing_of
from app.overlays.moment import Moment, moment_as_drawn, moment_of_plan
from app.overlays.motions import base_overlay, paths_overlay
from app.overlays.overlays import OVERLAYS, overlays
from app.overlays.reach_region import reach_regions
from planner import load_garment
from planner.errors import RequestError
from planner.task.plan import Plan
from tests.replay.planned import shipped_plan
from tests.required import required


def planned(name: str) -> tuple[Document, Plan]:
    """Return a document with its plan and trajectory, without a planner of its own."""
    document = Document(draft_of(drawing_of(load_garment(name))))
    state = document.state
    plan = shipped_plan(name)
    document.settle(state.version, required(state.task), plan, "p")
    return document, plan


@pytest.fixture(scope="module")
def towel() -> tuple[Document, Plan]:
    return planned("hand-towel")


@pytest.fixture(scope="module")
def shirt() -> tuple[Document, Plan]:
    return planned("t-shirt")


@pytest.fixture(scope="module")
def jeans() -> tuple[Document, Plan]:
    """Plan the jeans; the plan begins with a drive round the table."""
    return planned("jeans")


def at(document: Document, t_s: float) -> Moment:
    return moment_of_plan(document.state, t_s)


def test_a_fold_takes_its_grips_from_corner_to_corner_of_the_cloth(towel: tuple[Document, Plan]) -> None:
    # The towel is 0.686 m by 0.419 m; its near corners (0, 0) and (0.686, 0) come onto the far ones. On the way they
    # stand 0.2095 m over the line, and the tools 2 cm more.
    half = required(paths_overlay(at(towel[0], 0.0)))[0]
    left = next(grip for grip in half.grips if grip.arm == "left")
    assert (half.primitive, half.kind, half.fold) == (0, "fold", 0)
    assert np.allclose([left.pick, required(left.apex), left.place], [(0, 0), (0, 0.2095), (0, 0.419)], atol=1e-6)
    assert np.allclose(left.points, [(0, 0, 0.02), (0, 0.2095, 0.2295), (0, 0.419, 0.02)], atol=1e-6)


def test_the_bases_way_begins_where_the_robot_starts_and_ends_where_the_plan_leaves_it(
    shirt: tuple[Document, Plan],
) -> None:
    document, plan = shirt
    moment = at(document, 0.0)
    told = required(base_overlay(moment))
    way = moment.placement.to_outer(np.array(told.way))
    last = plan.primitives[-1].base.pose
    assert np.allclose(way[0], (-0.95, 0.0), atol=1e-6)
    assert np.allclose(way[-1], (last.x_m, last.y_m), atol=1e-6)
    assert len(told.stands) == len(plan.primitives)
    assert told.gone == 1


def test_more_and_more_of_the_way_is_gone(shirt: tuple[Document, Plan]) -> None:
    document, plan = shirt
    times_s = np.linspace(0.0, required(plan.cost_s), 40)
    gone = [required(base_overlay(at(document, t_s))).gone for t_s in times_s]
    assert gone == sorted(gone)
    assert gone[-1] >= len(required(base_overlay(at(document, 0.0))).way) - 1


def test_the_base_is_between_the_points_gone_and_the_next(jeans: tuple[Document, Plan]) -> None:
    document, plan = jeans
    move = next(primitive for primitive in plan.primitives if primitive.kind == "move")
    moment = at(document, move.start_s + 0.5 * move.duration_s)
    told = required(base_overlay(moment))
    base = np.array([moment.base_in_garment.x_m, moment.base_in_garment.y_m])
    before, after = np.array(told.way[told.gone - 1]), np.array(told.way[told.gone])
    assert math.dist(before, base) + math.dist(base, after) == pytest.approx(math.dist(before, after), abs=1e-4)


def test_a_moment_knows_the_folds_done_and_the_station(shirt: tuple[Document, Plan]) -> None:
    document, plan = shirt
    start, end = at(document, 0.0), at(document, required(plan.cost_s))
    assert (start.done, start.station, start.back_off_m) == ((), "front", 0.0)
    assert end.done == (0, 1, 2, 3, 4)
    assert end.station == plan.primitives[-1].base.station
    assert end.back_off_m == pytest.approx(plan.primitives[-1].base.back_off_m)
    assert len(start.cloth.layers) == 1
    assert len(end.cloth.layers) == len(plan.final_layers)


def test_a_base_on_its_way_round_the_table_is_at_no_station(jeans: tuple[Document, Plan]) -> None:
    document, plan = jeans
    assert plan.primitives[0].kind == "move"
    assert at(document, 0.6 * plan.primitives[0].duration_s).station is None


def test_the_cloth_goes_along_with_a_drag() -> None:
    document, plan = planned("big-towel")
    drag = plan.primitives[0]
    assert drag.kind == "drag"
    before, after = at(document, 0.0), at(document, drag.duration_s)
    assert before.placement.x_m - after.placement.x_m == pytest.approx(drag.to_dict()["distance_m"])


def test_without_a_plan_the_garment_lies_as_drawn_and_the_robot_waits() -> None:
    document = Document(draft_of(drawing_of(load_garment("t-shirt"))))
    moment = moment_of_plan(document.state, 5.0)
    assert (moment.plan, moment.station, moment.placement) == (None, "front", load_garment("t-shirt").placement)
    assert base_overlay(moment) is None
    assert paths_overlay(moment) is None


def test_a_robot_backs_off_from_a_station_against_where_it_looks() -> None:
    document = Document(draft_of(drawing_of(load_garment("t-shirt"))))
    moment = moment_as_drawn(document.state, "left", 0.2)
    # `left` is at (0.45, 0.64) and looks towards -y.
    assert (moment.base.x_m, moment.base.y_m) == pytest.approx((0.45, 0.84))
    with pytest.raises(RequestError, match="back_off_m"):
        moment_as_drawn(document.state, "left", 0.9)
    with pytest.raises(RequestError, match=r"expected one of front.*got 'attic'"):
        moment_as_drawn(document.state, "attic", 0.0)


def test_where_an_arm_reaches_is_worked_out_once_for_all_moments(shirt: tuple[Document, Plan]) -> None:
    document, plan = shirt
    overlays(document.state, at(document, 0.0), OVERLAYS)
    before = reach_regions.cache_info()
    for t_s in np.linspace(1.0, required(plan.cost_s), 6):
        overlays(document.state, at(document, float(t_s)), OVERLAYS)
    after = reach_regions.cache_info()
    assert after.misses == before.misses and after.hits > before.hits
