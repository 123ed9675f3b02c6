"""Replay a solved plan from its JSON alone, and fail at the first violation of the mathematics.

It shares no code with the planner: garment, scene and plan come in as plain JSON, and shapely does the geometry. What
it holds a plan to: the clock adds up, folds come in an order that the Fold-DAG allows, every grip is where it must be,
the cloth is at rest after every primitive, the base goes where it can, and the stack at the end is as promised.
"""

import math
from typing import Any

import numpy as np
import shapely
from shapely import MultiPoint, Point
from shapely.geometry.base import BaseGeometry

from tests.replay import flat
from tests.replay.flat import NEAR_M, Place
from tests.replay.folding import require_same_stack
from tests.replay.table_side import REST_M, Space
from tests.replay.way_round import DRIVE_M_S2, from_rest_to_rest_s, require_way_round
from tests.replay.world import ARMS, GRID_M, SECOND, Way, World

DRAG_M = 0.10
FIRM_M = 0.08


def check(
    garment: dict[str, Any], scene: dict[str, Any], plan: dict[str, Any], start: str = "front"
) -> list[dict[str, Way]]:
    """Replay a plan that starts at a station with the garment at its placement.

    Returns for each primitive the way of each arm that holds cloth.
    """
    assert plan["status"] == "solved", f"the plan is {plan['status']}"
    checker = Checker(garment, scene, start)
    checker.run(plan)
    return checker.ways


class Checker(World):
    """A replay of a plan's primitives one by one on the world."""

    def run(self, plan: dict[str, Any]) -> None:
        self._require_dag(plan["dag"])
        self.is_late = plan["cost_s"] > plan["statistics"]["bound_s"] + SECOND
        self.table.require_rest(self._on_table(), "at the start")
        for number, primitive in enumerate(plan["primitives"]):
            kind = primitive["kind"]
            self._require_clock(primitive, number)
            self.ways.append({})
            assert not self.held_from or kind == "fold", f"{number}: a {kind} while the hands hold cloth"
            {"fold": self._fold, "drag": self._drag, "move": self._move}[kind](primitive)
            self._require_base(primitive, number)
            self.table.require_rest(self._on_table(), f"after {kind} {number}")
            self.now += primitive["duration_s"]
        assert not self.held_from, "the plan ends with cloth in the hands"
        assert sorted(self.done) == list(range(len(self.folds))), f"only the folds {self.done} were done"
        assert abs(plan["cost_s"] - self.now) < SECOND, f"the cost is {plan['cost_s']} s, the clock {self.now} s"
        require_same_stack(self.stack, plan["final_layers"])
        self._require_placement(plan["final_placement"])

    def _fold(self, primitive: dict[str, Any]) -> None:
        index = primitive["fold"]
        name, line, is_red = self.folds.names[index], self.folds.lines[index], self.folds.is_red[index]
        self._require_turn(index, primitive)
        spots = [self._picked(grip, name) for grip in primitive["grips"]]
        self._require_arms(primitive["grips"], name, are_new=not self.held)
        placed_line = (self._outer(line[0]), self._outer(line[1]))
        assert shapely.LineString(placed_line).distance(self.table.top) < 1e-5, f"{name}: the line is off the table"
        moving = self.stack.moving_part(line, is_red)
        vertices = flat.must_hold(moving, flat.left_normal(line), [line], self.table.support_rad)
        self._require_cover(moving, vertices, spots, self.folds.radii[index], name, line)
        self._require_path(primitive["grips"], spots, name, line)
        self._note_ways(primitive["grips"], spots, [self._sweep(spot, line) for spot in spots])
        self._require_fold_time(primitive, name)
        follows = index + 1 < len(self.folds) and self.folds.is_red[index + 1]
        assert primitive["holds"] == follows, f"{name}: holds on without a red fold to follow, or lets go before one"
        kept = {g["arm"]: flat.mirror(line, s) for g, s in zip(primitive["grips"], spots, strict=True)}
        self.held, self.held_from = (kept, "fold") if follows else ({}, "")
        self.stack = self.stack.folded(line, is_red)
        self.done.append(index)

    def _require_turn(self, index: int, primitive: dict[str, Any]) -> None:
        name, is_red = self.folds.names[index], self.folds.is_red[index]
        assert index not in self.done, f"{name}: folded twice"
        missing = self.folds.before()[index] - set(self.done)
        assert not missing, f"{name}: waits for the folds {sorted(missing)}"
        if is_red:
            assert self.held_from == "fold" and self.done[-1] == index - 1, f"{name}: its chain was interrupted"
        else:
            assert self.held_from != "fold", f"{name}: interrupts a chain of red folds"

    def _picked(self, grip: dict[str, Any], name: str) -> Place:
        """Return the point of the garment that a grip takes, or holds already."""
        pick, arm = tuple(grip["pick"]), grip["arm"]
        if self.held:
            assert arm in self.held, f"{name}: the {arm} arm holds nothing, and there is no time to reach"
            x, y = self._outer(self.held[arm])
            at = (x, y, REST_M) if self.held_from == "drag" else self.table.over_edge((x, y), REST_M)
            assert math.dist(at, pick) < NEAR_M, f"{name}: the {arm} arm holds {at}, not {pick}"
            return self.held[arm]
        place = self.table.unrolled(pick)
        rest = self.table.over_edge(place, REST_M)
        assert math.dist(rest, pick) < NEAR_M, f"{name}: {pick} is not where cloth rests, that would be {rest}"
        return self._inner(place)

    def _require_cover(
        self,
        piece: BaseGeometry,
        vertices: list[Place],
        spots: list[Place],
        radius_m: float,
        name: str,
        still: flat.Line | None = None,
    ) -> None:
        """Require every vertex to be held, with grips on the cloth.

        They are the fewest and nearest possible, within the radius or firmly, or the nearest of as many as there are.
        """
        assert 1 <= len(spots) <= len(ARMS), f"{name}: {len(spots)} grips for two arms"
        for spot in spots:
            gap = piece.distance(Point(spot)) if self.held else piece.boundary.distance(Point(spot))
            assert gap < NEAR_M, f"{name}: the grip at {spot} is {gap:.4f} m from the edge of the moving part"
            is_still = still is not None and shapely.LineString(still).distance(Point(spot)) < 1e-5
            assert not is_still, f"{name}: the grip at {spot} is on the fold line and lifts nothing"
        found = flat.reach_of(spots, vertices)
        assert found[0] <= radius_m + 1e-4, f"{name}: a vertex is {found[0]:.4f} m from the nearest grip"
        if self.held:
            alone = [flat.reach_of([spot], vertices)[0] <= radius_m for spot in self.held.values()]
            is_nearer = all(found[0] < flat.reach_of([spot], vertices)[0] for spot in self.held.values())
            assert len(spots) == 1 or is_nearer or not any(alone), f"{name}: one of the grips held would do"
            return
        radii_m = (radius_m, min(FIRM_M, radius_m))
        best = [flat.best_cover(piece, vertices, within_m, len(ARMS), still) for within_m in radii_m]
        best.append(flat.nearest_cover(piece, vertices, len(ARMS), still))
        is_best = any(one is not None and np.allclose(found, one, atol=NEAR_M) for one in best)
        assert is_best, f"{name}: {found} m, best {best[0]} m, firmly {best[1]} m, nearest {best[2]} m"

    def _require_path(self, grips: list[dict[str, Any]], spots: list[Place], name: str, line: flat.Line) -> None:
        for grip, spot in zip(grips, spots, strict=True):
            distance = flat.distance_left(line, spot)
            nx, ny = flat.left_normal(line)
            foot = (spot[0] - distance * nx, spot[1] - distance * ny)
            apex = self.table.over_edge(self._outer(foot), distance + REST_M)
            place = self.table.over_edge(self._outer(flat.mirror(line, spot)), REST_M)
            gaps = math.dist(apex, grip["apex"]), math.dist(place, grip["place"])
            assert gaps[0] < NEAR_M, f"{name}: the apex is {gaps[0]:.4f} m off {apex}"
            assert gaps[1] < NEAR_M, f"{name}: the place is {gaps[1]:.4f} m off {place}"

    def _sweep(self, spot: Place, line: flat.Line) -> tuple[Space, ...]:
        """Return the path of a grip: up along (b, d - b) to the apex, down along (-b, d - b), taken over the edges."""
        distance, (nx, ny) = flat.distance_left(line, spot), flat.left_normal(line)
        points = []
        for share in np.linspace(1.0, -1.0, 201):
            back = distance * (1.0 - share)
            place, height = self._outer((spot[0] - back * nx, spot[1] - back * ny)), distance * (1.0 - abs(share))
            is_held_out = self.held_from == "drag" and share > 0.0
            over = (*place, height + REST_M) if is_held_out else self.table.over_edge(place, height + REST_M)
            points.append(over)
        return tuple(points)

    def _note_ways(self, grips: list[dict[str, Any]], spots: list[Place], ways: list[tuple[Space, ...]]) -> None:
        silhouette = flat.together(self._on_table())
        for grip, spot, way in zip(grips, spots, ways, strict=True):
            inwards = flat.bisector(silhouette, self._outer(spot))
            self.ways[-1][grip["arm"]] = Way(way, not self.held, inwards)

    def _require_fold_time(self, primitive: dict[str, Any], name: str) -> None:
        """Require two or three arm motions, and base legs on the grid that lead from one standoff to the other.

        Where the arms cannot keep up with the base it drives a little slower: by half a step of the grid at most. A
        plan that takes longer than its bound may have arms that are later than that.
        """
        arms_s = (2 if self.held else 3) * self.scene["arm_motion_s"]
        steps = (primitive["duration_s"] - arms_s) * self.scene["base_speed_m_s"] / GRID_M
        least = abs(primitive["base"]["back_off_m"] - self.standoff) / GRID_M
        assert steps >= least - 1e-5, f"{name}: takes {primitive['duration_s']} s, too few for arms and base"
        if self.is_late:
            return
        driven = math.floor(steps + 1e-5)
        assert steps - driven < 0.5 - 1e-5, f"{name}: its legs are no multiple of 5 cm"
        assert (driven - round(least)) % 2 == 0, f"{name}: {steps} steps do not lead to its end"

    def _drag(self, primitive: dict[str, Any]) -> None:
        distance, yaw = primitive["distance_m"], self.scene["stations"][self.station]["yaw_rad"]
        drags = distance / DRAG_M
        assert drags > 0.5 and abs(drags - round(drags)) < 1e-6, f"a drag of {distance} m is no multiple of 0.10 m"
        rectangle = shapely.minimum_rotated_rectangle(MultiPoint(self.garment["outline"])).exterior.coords
        length = max(math.dist(rectangle[i], rectangle[i + 1]) for i in (0, 1))
        assert distance <= length + 1e-5, f"a drag of {distance} m, the garment is {length:.3f} m long"
        towards = (-math.cos(yaw), -math.sin(yaw))
        silhouette = flat.together(self._on_table())
        assert not self.table.hangs_towards(silhouette, towards), "a drag towards an edge from which cloth hangs"
        spots = [self._picked(grip, "drag") for grip in primitive["grips"]]
        self._require_arms(primitive["grips"], "drag", are_new=True)
        lying = silhouette.intersection(self.table.top)
        vertices = flat.must_hold(lying, towards, [], self.table.support_rad)
        outer = [self._outer(spot) for spot in spots]
        self._require_cover(lying, vertices, outer, self.garment["grip_radius_m"], "drag")
        shift = (distance * towards[0], distance * towards[1], 0.0)
        for grip in primitive["grips"]:
            wanted = [a + b for a, b in zip(grip["pick"], shift, strict=True)]
            assert abs(grip["pick"][2] - REST_M) < NEAR_M, "a drag holds cloth at the height of the table"
            assert math.dist(wanted, grip["place"]) < NEAR_M, f"a drag's hand ends at {grip['place']}, not {wanted}"
            assert grip["apex"] is None, "a drag has no apex"
        self._note_ways(primitive["grips"], spots, [(tuple(g["pick"]), tuple(g["place"])) for g in primitive["grips"]])
        first = primitive["base"]["back_off_m"] - distance
        assert first >= -1e-9, f"a drag of {distance} m ends {primitive['base']['back_off_m']} m from the station"
        driving_s = abs(first - self.standoff) / self.scene["base_speed_m_s"]
        dragging_s = from_rest_to_rest_s(distance, self.scene["base_speed_m_s"], DRIVE_M_S2)
        wanted_s = self.scene["arm_motion_s"] + driving_s + dragging_s
        assert abs(primitive["duration_s"] - wanted_s) < SECOND, f"a drag takes {wanted_s} s, not as the plan says"
        self.x, self.y = self.x + shift[0], self.y + shift[1]
        kept = {g["arm"]: s for g, s in zip(primitive["grips"], spots, strict=True)}
        self.held, self.held_from = (kept, "drag") if primitive["holds"] else ({}, "")

    def _move(self, primitive: dict[str, Any]) -> None:
        assert primitive["from"] == self.station, f"a move from {primitive['from']}, the base is at {self.station}"
        assert primitive["to"] != self.station, "a move to where the base is"
        assert not primitive["grips"], "a move with cloth in the hands"
        yaw = self.scene["stations"][self.station]["yaw_rad"]
        start = (*self._base_xy(self.station, self.standoff), yaw)
        goal = tuple(self.scene["stations"][primitive["to"]][k] for k in ("x_m", "y_m", "yaw_rad"))
        require_way_round(primitive, start, goal, self.scene)
        assert abs(primitive["base"]["back_off_m"]) < 1e-9, "a move ends at the station, not backed off"
        self.station, self.standoff = primitive["to"], 0.0
