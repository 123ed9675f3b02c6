"""A world simulated in MuJoCo: the garment as a flex on a table, grips that move its vertices."""

from collections.abc import Callable, Iterable, Mapping

import numpy as np

from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.fingers import Box, FingerSize, Leaving, lowest
from app.rehearsal.physics.hand_way import HandWay, pinched_by
from app.rehearsal.physics.held_cloth import HeldCloth
from app.rehearsal.physics.pinch import OPENING_M, PAD_M, fingertip
from app.rehearsal.physics.simulation import ClothSimulation
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.world import GripMotion, Observation, Performed, StepMotion, Truth
from planner.folds.fold_sequence import replayed
from planner.geometry.pose import Pose2
from planner.geometry.table import TableTop
from planner.geometry.woven_mesh import woven_mesh
from planner.robots.load_robot import robot_card_file
from planner.task.task import Task

_REST_M_S = 0.005
"""The speed below which no point of cloth at rest moves (m/s)."""

_CLOSING_S = 0.1
"""The time in which fingers press the layers between them on one another (s)."""

_RESTED_S = 0.1
"""The time after which cloth that has not moved is taken to be at rest (s)."""


class PhysicsWorld:
    """A garment on a table, simulated.

    Time passes only while hands hold cloth, and until what they let go has come to rest: between the steps nothing
    moves the cloth.

    Attributes:
        resolution: mesh, time step and effort.
        simulation: the cloth.
        elapsed_s: the time that has passed (s).
    """

    def __init__(
        self,
        task: Task,
        fabric: Fabric,
        resolution: Resolution,
        seed: int = 0,
        placement: Pose2 | None = None,
        tick: Callable[[], None] = lambda: None,
    ) -> None:
        """Lay the garment on the table as a task begins.

        Args:
            task: garment, table and the state at the start.
            fabric: the cloth.
            resolution: mesh, time step and effort.
            seed: of the mesh.
            placement: where the garment really lies; None for where the task says.
            tick: called after every time step; may raise to end the simulation.
        """
        self.resolution = resolution
        self._top = TableTop.of(task.scene.table)
        self._clear_m = task.scene.edge_clear_m
        self._tick = tick
        self.elapsed_s = 0.0
        lies = placement or task.start.placement
        self._pattern, triangles = woven_mesh(task.garment.pattern, resolution.edge_m, seed)
        self._thickness_m = fabric.layer_m
        ball = fabric.layer_m / 2.0
        rest = np.column_stack([lies.to_outer(self._pattern), np.full(len(self._pattern), ball)])
        arms = robot_card_file(task.robot).arms
        self._fingers = {arm.name: FingerSize.of(arm.gripper) for arm in arms}
        self._hands = {arm.name: number for number, arm in enumerate(arms)}
        sizes, table = list(self._fingers.values()), task.scene.table
        self.simulation = ClothSimulation(rest, self._pattern, triangles, fabric, resolution, table, sizes)
        self._grips: dict[str, HeldCloth] = {}
        self._under: dict[str, list[Box]] = {}
        self._leaving: dict[str, Leaving] = {}
        if task.start.done or not self._top.covers(rest):
            sequence = replayed(task.garment)
            gap_m = fabric.layer_m
            self.simulation.put(planned_positions(sequence, self._pattern, task.start.done, lies, table, gap_m))
            self._settle()

    def observe(self) -> Observation:
        """Return nothing: this world has no camera (see `app.rehearsal.camera_world`)."""
        return Observation()

    def perform(self, motion: StepMotion) -> Performed:
        """Close the fingers, move them along their paths, open them, and let the cloth come to rest."""
        if not motion.grips:
            return Performed()
        held = set(self._grips)
        found = {grip.arm: self._take(grip) for grip in motion.grips}
        self._press({grip.arm: grip for grip in motion.grips if grip.arm in self._grips.keys() - held})
        if all(found.values()) or not motion.needs_all:
            self._follow(motion)
        else:
            self._let_go(motion.grips)
        if not self._grips:
            self._settle()
        return Performed(found)

    def truth(self) -> Truth:
        """Return where the cloth is."""
        held = {arm: len(grip.vertices) for arm, grip in self._grips.items()}
        return Truth(self._pattern, self.simulation.positions, self.simulation.triangles, held)

    def _take(self, grip: GripMotion) -> bool:
        """Close a hand on the cloth; return whether it holds some."""
        if grip.arm in self._grips and not grip.closes:
            return True
        tool, now = grip.at(grip.times_s[0]), self.simulation.positions
        found, tip = pinched_by(grip, now, self.simulation.triangles, self._top, self._clear_m), fingertip(tool)
        taken = {vertex: point for vertex, point in found.items() if vertex not in self.simulation.held}
        if not taken:
            return False
        hangs = not self._top.covers(tool[None])
        held = HeldCloth.of(taken, now, tip, hangs=hangs)
        if held.stack_m(self._thickness_m) > self._fingers[grip.arm].stack_max_m:
            return False  # too much is between the fingers to be held: it slips out of them
        self._grips[grip.arm] = held
        self.simulation.hold(held.at(tip))
        return True

    def _press(self, grips: Mapping[str, GripMotion]) -> None:
        """Press the layers between fingers that have just closed on one another, where they lie on the table.

        The finger under them lifts them by its thickness.
        """
        opened = {
            arm: self._grips[arm] for arm, grip in grips.items() if self._top.covers(grip.at(grip.times_s[0])[None])
        }
        count = round(_CLOSING_S / self.simulation.step_s) if opened else 0
        for number in range(count):
            share = (number + 1) / count
            for arm, cloth in opened.items():
                grip, size = grips[arm], self._fingers[arm]
                lift_m = 0.0 if grip.heading_rad is None else share * size.thickness_m
                self._grips[arm] = pressed = cloth.pressed(self._thickness_m, share).raised(lift_m)
                way = HandWay(grip, pressed, is_fold=False, top=self._top)
                self.simulation.hold(way.at(grip.times_s[0]))
                self._put_fingers(arm, way.fingers_at(grip.times_s[0], size, (1.0 - share) * OPENING_M))
            self._step()

    def _put_fingers(self, arm: str, boxes: list[Box]) -> None:
        self._under[arm] = boxes
        self._leaving.pop(arm, None)
        self.simulation.put_fingers(self._hands[arm], boxes)

    def _follow(self, motion: StepMotion) -> None:
        """Move the hands along their paths; each opens at the end of its own, if it opens at all."""
        grips = motion.grips
        now_s, last_s = min(g.times_s[0] for g in grips), max(g.times_s[-1] for g in grips)
        ways = [self._way(grip, motion.is_fold) for grip in grips if grip.arm in self._grips]
        while now_s < last_s:
            now_s = min(now_s + self.simulation.step_s, last_s)
            for way in ways:
                if way.grip.arm in self._grips:
                    self.simulation.hold(way.at(now_s))
                    self._put_fingers(way.grip.arm, way.fingers_at(now_s, self._fingers[way.grip.arm]))
            self._let_go(grip for grip in grips if grip.opens and grip.times_s[-1] <= now_s)
            self._step()
        self._grips |= {way.grip.arm: way.held_at(last_s) for way in ways if way.grip.arm in self._grips}

    def _way(self, grip: GripMotion, is_fold: bool) -> HandWay:
        """Return the way of a hand and the cloth in it; in a fold it ends on top of the cloth that lies there."""
        way, positions = self._new_way(grip, is_fold), self.simulation.positions
        if not is_fold:
            return way
        apart = np.linalg.norm(positions[:, :2] - np.array(grip.points[-1][:2]), axis=1)
        apart[list(self.simulation.held)] = np.inf
        below = positions[apart <= self.resolution.edge_m, 2]
        return way.landing_on(float(below.max()) + self._thickness_m) if len(below) else way

    def _new_way(self, grip: GripMotion, is_fold: bool) -> HandWay:
        return HandWay(grip, self._grips[grip.arm], is_fold, self._top, self._fingers[grip.arm].thickness_m)

    def _let_go(self, grips: Iterable[GripMotion]) -> None:
        """Open hands; the upper finger is out of the way then, the one under the cloth goes on and is drawn out."""
        for grip in grips:
            cloth = self._grips.pop(grip.arm, None)
            if cloth is not None:
                self.simulation.release(frozenset(cloth.vertices))
                boxes = self._under.pop(grip.arm, [])
                if boxes:
                    back_m = self._fingers[grip.arm].length_m + PAD_M + grip.goes_on_m
                    self._leaving[grip.arm] = Leaving(lowest(boxes), grip.goes_on_m, back_m)

    def _draw_back(self) -> None:
        """Move the fingers of open hands on by one time step, and put them away once they are out."""
        for arm, leaving in list(self._leaving.items()):
            later = leaving.after(self.simulation.step_s)
            if later is None:
                del self._leaving[arm]
            else:
                self._leaving[arm] = later
            self.simulation.put_fingers(self._hands[arm], [] if later is None else [later.finger])

    def _settle(self) -> None:
        """Simulate until the cloth that was let go rests; cloth at rest is not simulated."""
        rested_s, left = 0.0, round(self.resolution.settle_s / self.simulation.step_s)
        self.simulation.solve_to(self.resolution.rest_tolerance)
        while left and rested_s < _RESTED_S:
            self._step()
            is_at_rest = not self._leaving and float(self.simulation.speeds.max()) < _REST_M_S
            rested_s = rested_s + self.simulation.step_s if is_at_rest else 0.0
            left -= 1
        self.simulation.solve_to(self.resolution.tolerance)

    def _step(self) -> None:
        self._draw_back()
        self.simulation.step()
        self.elapsed_s += self.simulation.step_s
        self._tick()
