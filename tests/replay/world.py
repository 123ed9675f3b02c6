"""The world between two primitives of a plan that is replayed, and the rules of every primitive."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from tests.replay.flat import NEAR_M, Place
from tests.replay.folding import Folds
from tests.replay.table_side import Space, TableSide

SECOND = 1e-6
GRID_M, APART_M = 0.05, 0.10
ARMS = ("left", "right")


@dataclass(frozen=True)
class Way:
    """The pose of a tool that holds cloth, table frame."""

    points: tuple[Space, ...]
    is_new_grip: bool
    into_cloth: Place


class World:
    """Cloth, placement, base, hands and clock."""

    def __init__(self, garment: dict[str, Any], scene: dict[str, Any], start: str) -> None:
        self.garment, self.scene, self.table = garment, scene, TableSide(scene)
        self.folds = Folds(garment)
        self.stack = self.folds.start
        self.done: list[int] = []
        placement = garment["placement"]
        self.x, self.y, self.yaw = placement["x_m"], placement["y_m"], placement["yaw_rad"]
        self.station, self.standoff = start, 0.0
        self.held: dict[str, Place] = {}
        self.held_from = ""
        self.now = 0.0
        self.ways: list[dict[str, Way]] = []

    def _outer(self, point: Place) -> Place:
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return self.x + cos * point[0] - sin * point[1], self.y + sin * point[0] + cos * point[1]

    def _inner(self, point: Place) -> Place:
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        dx, dy = point[0] - self.x, point[1] - self.y
        return cos * dx + sin * dy, cos * dy - sin * dx

    def _placed(self, shape: BaseGeometry) -> BaseGeometry:
        return shapely.transform(shape, lambda rows: np.array([self._outer(tuple(row)) for row in rows]))

    def _on_table(self) -> list[BaseGeometry]:
        return [self._placed(shape) for shape in self.stack.shapes]

    def _base_xy(self, station: str, standoff: float) -> Place:
        pose = self.scene["stations"][station]
        yaw = pose["yaw_rad"]
        return pose["x_m"] - standoff * math.cos(yaw), pose["y_m"] - standoff * math.sin(yaw)

    def _require_dag(self, dag: dict[str, Any]) -> None:
        assert dag["folds"] == len(self.folds), f"the DAG has {dag['folds']} folds, not {len(self.folds)}"
        edges = self.folds.edges()
        assert sorted(dag["edges"]) == edges, f"the DAG's edges are {dag['edges']}, by overlap {edges}"

    def _require_clock(self, primitive: dict[str, Any], number: int) -> None:
        start, duration = primitive["start_s"], primitive["duration_s"]
        assert abs(start - self.now) < SECOND, f"{number}: starts at {start} s, the one before ends at {self.now} s"
        assert duration >= 0, f"{number}: takes {duration} s"

    def _require_base(self, primitive: dict[str, Any], number: int) -> None:
        base = primitive["base"]
        assert base["station"] == self.station, f"{number}: the base is at {base['station']}, not {self.station}"
        standoff, most = base["back_off_m"], self.scene["back_off_max_m"]
        steps = standoff / GRID_M
        assert abs(steps - round(steps)) < 1e-6, f"{number}: a standoff of {standoff} m is off the 5 cm grid"
        assert -1e-9 <= standoff <= most + 1e-9, f"{number}: a standoff of {standoff} m is not within 0..{most} m"
        x, y = self._base_xy(self.station, standoff)
        assert math.dist((x, y), (base["x_m"], base["y_m"])) < NEAR_M, f"{number}: the base's place is another"
        turn = base["yaw_rad"] - self.scene["stations"][self.station]["yaw_rad"]
        assert abs(math.remainder(turn, math.tau)) < 1e-6, f"{number}: the base looks another way"
        self.standoff = standoff

    def _require_placement(self, placement: dict[str, Any]) -> None:
        gap = math.dist((self.x, self.y), (placement["x_m"], placement["y_m"]))
        assert gap < NEAR_M, f"the garment ends {gap:.4f} m from where the plan says"
        assert abs(math.remainder(placement["yaw_rad"] - self.yaw, math.tau)) < 1e-6, "the garment was turned"

    def _require_arms(self, grips: list[dict[str, Any]], what: str, *, are_new: bool) -> None:
        arms = [grip["arm"] for grip in grips]
        assert set(arms) <= set(ARMS) and len(set(arms)) == len(arms), f"{what}: the arms are {arms}"
        if len(grips) == 2 and are_new:
            spots = {g["arm"]: self.table.unrolled(tuple(g["pick"])) for g in grips}
            apart = math.dist(spots["left"], spots["right"])
            assert apart >= APART_M - 1e-5, f"{what}: the grips are {apart:.3f} m apart, less than {APART_M} m"
            yaw = self.scene["stations"][self.station]["yaw_rad"]
            lateral = {arm: -math.sin(yaw) * x + math.cos(yaw) * y for arm, (x, y) in spots.items()}
            assert lateral["left"] >= lateral["right"] - 2e-5, f"{what}: the left arm takes the grip on the right"
