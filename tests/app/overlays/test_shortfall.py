import math
from typing import Any

import httpx
import numpy as np
import pytest
import shapely

from app.overlays.shortfall import Lack, NearReach, ShortfallAnswer, near_reach
from planner import load_garment
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.reach_query import ReachQuery
from planner.robots.load_robot import load_robot
from planner.robots.pr2.robot import Pr2
from tests.app.document_requests import planned
from tests.patience import wait_until_async
from tests.replay.planned import planned as shipped
from tests.robots.model import can_reach

pytestmark = pytest.mark.anyio

TORSO_M, COMFORT_M = 0.29, 0.03
HERE = Pose2(0.0, 0.0, 0.0)

# Places of the left hand, base frame (m), and how it is turned (index into the approaches: 13 headings at each of four
# pitches, then straight down); the first two lack something along the table, the third is too high for its pitch.
FAR_AHEAD, FAR_ASIDE, TOO_HIGH = ((0.95, 0.15, 0.81), 6), ((0.5, 0.95, 0.81), 52), ((0.45, 0.3, 1.6), 32)


def lack(point: tuple[float, float, float], approach: int) -> Lack:
    place = ReachQuery(0, np.array([[point]]), np.array([approach]))
    found = load_robot("pr2").reach(TORSO_M, COMFORT_M).shortfall(place)
    assert found is not None and not found.is_at_least
    return Lack(0, point, load_robot("pr2").reach(TORSO_M, COMFORT_M).approaches[approach], found.short_by_m, HERE)


def towards(lacking: Lack) -> FloatArray:
    """Return the direction in which a point would have to be displaced, base frame."""
    reach = load_robot("pr2").reach(TORSO_M, COMFORT_M)
    approach = np.array([reach.approaches.index(lacking.approach)])
    found = reach.shortfall(ReachQuery(lacking.arm, np.array([[lacking.seen]]), approach))
    assert found is not None
    return np.array(found.towards)


def near(lacking: Lack) -> NearReach:
    return near_reach(load_robot("pr2"), TORSO_M, COMFORT_M, lacking)


@pytest.mark.parametrize(("point", "approach"), [FAR_AHEAD, FAR_ASIDE])
def test_the_edge_is_as_far_from_the_point_as_it_is_said_to_be_short(
    point: tuple[float, float, float], approach: int
) -> None:
    lacking = lack(point, approach)
    found = near(lacking)
    start, along = np.array(point[:2]), towards(lacking)[:2]
    assert np.hypot(*along) == pytest.approx(1.0)
    # The shortfall is known to 1 mm; the grid round the point is at most 1 cm wide, halved four times.
    on_way = [found.beyond.contains(tuple(start + share * lacking.short_by_m * along)) for share in (0.0, 0.5, 0.9)]
    assert on_way == [True, True, True]
    tip = tuple(start + (lacking.short_by_m + 0.002) * along)
    assert not found.beyond.contains(tip)
    gaps = [np.hypot(*(line - tip).T).min() for line in found.edge]
    assert min(gaps) < 0.01


def test_what_is_straight_too_high_has_no_reach_at_that_height_that_could_hide_it() -> None:
    point, approach = TOO_HIGH
    lacking = lack(point, approach)
    assert towards(lacking)[2] == -1.0
    found = near(lacking)
    assert found.beyond.contains(point[:2])
    assert found.edge == ()
    # A polygon of 96 corners on the circle.
    whole = 48 * lacking.radius_m**2 * math.sin(math.tau / 96)
    assert found.beyond.area == pytest.approx(whole, rel=1e-4)


def test_beyond_the_edge_the_hand_cannot_be_whatever_its_joints_and_before_it_it_can() -> None:
    point, approach = FAR_AHEAD
    robot = load_robot("pr2")
    assert isinstance(robot, Pr2)
    lacking = lack(point, approach)
    found = near(lacking)
    rng = np.random.default_rng(3)
    asked = rng.uniform(-lacking.radius_m, lacking.radius_m, (80, 2)) * math.sqrt(0.5) + np.array(point[:2])
    answers = set()
    for x, y in asked:
        is_beyond = found.beyond.contains((float(x), float(y)))
        if found.beyond.boundary_distance((float(x), float(y))) < 0.004:
            continue
        # Comfort: the place and four on the circle round it.
        ring = np.array([(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)]) * COMFORT_M + (x, y)
        tools = np.column_stack([ring, np.full(5, point[2])])
        rotations = np.repeat(lacking.approach.rotation[None], 5, axis=0)
        assert bool(can_reach(robot, 0, tools, rotations, TORSO_M).all()) is not is_beyond
        answers.add(is_beyond)
    assert answers == {True, False}


async def shortfall_of(client: httpx.AsyncClient, garment: str, **drawing: Any) -> dict[str, Any]:
    """Return the overlay of the reach where a document's hand falls short."""
    state = (await client.post("/api/documents", json={"garment": garment})).json()
    body = {"base_version": state["version"], "label": "Begin", "drawing": {**state["drawing"], **drawing}}
    await client.put(f"/api/documents/{state['id']}/drawing", json=body)

    async def told() -> dict[str, Any] | None:
        answer = await client.get(f"/api/documents/{state['id']}/overlays?show=shortfall")
        shortfall: dict[str, Any] | None = answer.json()["shortfall"]
        return shortfall

    return await wait_until_async(told)


async def test_where_the_table_is_too_deep_the_reach_ends_before_the_cross(client: httpx.AsyncClient) -> None:
    stations = {"front": {"x_m": -0.95, "y_m": 0.0, "yaw_rad": 0.0}}
    scene = {"stations": stations, "back_off_max_m": 0.0}
    told = await shortfall_of(client, "t-shirt", scene=scene)
    plan = (await client.post("/api/plans", json={"garment": "t-shirt", "scene": scene})).json()
    reason = next(reason for reason in plan["reasons"] if reason["point"])
    assert (told["arm"], told["station"], told["fold"]) == (reason["arm"], "front", reason["fold"])
    # The shirt lies unturned, so the garment's axes are the table's.
    placement = load_garment("t-shirt").placement
    x, y, z = reason["point"]
    assert told["point"] == pytest.approx([x - placement.x_m, y - placement.y_m, z])
    edge = np.vstack([np.array(line) for line in told["edge"]])
    assert np.hypot(*(edge - told["point"][:2]).T).min() == pytest.approx(reason["short_by_m"], abs=0.005)


@pytest.mark.long
async def test_after_a_drag_the_reach_is_shown_as_far_back_as_the_cloth_lies_on_the_board(
    client: httpx.AsyncClient,
) -> None:
    told = await shortfall_of(client, "scarf-halved")
    reason = next(reason for reason in shipped("scarf-halved").plan["reasons"] if reason["point"])
    assert math.hypot(*reason["offset_m"]) > 0.05
    # A hand takes the middle of the scarf's near end, 0.254 / 2 m from both corners, and lays it 1.524 m further on: it
    # rises as far as it has gone, until it is over the fold line, and comes down as far as it goes on.
    across, along, height = told["point"]
    assert across == pytest.approx(0.254 / 2)
    assert height == pytest.approx(reason["point"][2])
    overhang = 0.02 + min(along, 1.524 - along) - height  # over the edge a path sinks by as much as it is beyond it
    assert overhang > -1e-6
    assert (told["heading_rad"], told["pitch_rad"]) == tuple(reason["approach"].values())
    beyond = shapely.union_all([shapely.Polygon(region["outer"], region["holes"]) for region in told["beyond"]])
    assert beyond.contains(shapely.Point(across, along))
    edges = [math.hypot(x - across, y - along) for x, y in beyond.convex_hull.exterior.coords]
    assert max(edges) <= told["radius_m"] + 1e-6


async def test_a_document_that_is_planned_has_no_reach_to_show(client: httpx.AsyncClient) -> None:
    path = f"/api/documents/{await planned(client)}/overlays"
    for query in ("", "?station=front"):
        assert (await client.get(path + query)).json()["shortfall"] is None


def test_the_schema_tells_that_a_robot_without_a_station_is_not_at_one() -> None:
    parts = ShortfallAnswer.model_json_schema()["properties"]
    kinds = {name: [one["type"] for one in parts[name]["anyOf"]] for name in ("station", "back_off_m")}
    assert kinds == {"station": ["string", "null"], "back_off_m": ["number", "null"]}
