"""A planning problem: a task made ready for planning."""

from dataclasses import dataclass, replace
from typing import Any

from planner.cloth.cloth_state import spread_out
from planner.cloth.g_state import StabilityViolation
from planner.cloth.garment import Garment
from planner.deadline import ENDLESS, Deadline
from planner.errors import RequestError
from planner.folds.fold_cloth import fold_cloth
from planner.folds.fold_sequence import FoldSequence, replayed
from planner.geometry.driving import STANDOFFS_PER_M
from planner.geometry.pose import Pose2
from planner.geometry.tolerance import LENGTH_M, nearest_whole
from planner.motion.transfer_candidate import KnownTransfers
from planner.motion.transfer_planner import TransferPlanner
from planner.primitives.context import DRAGS_PER_M, Context, cloth_memory
from planner.primitives.reach import UnlimitedReach
from planner.primitives.state import Held, State
from planner.robots.armed_robot import ArmedRobot
from planner.robots.load_robot import load_robot
from planner.task.scene import Scene
from planner.task.task import Task
from planner.task.world_state import WorldState


@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """A task with the data and the robot that planning needs.

    A problem is not shared between threads.

    Attributes:
        task: the task.
        context: the garment's folds, the scene, the robot's reach, where the garment lies.
        robot: the robot.
        maker: plans the robot's transfers.
    """

    task: Task
    context: Context
    robot: ArmedRobot
    maker: TransferPlanner

    @property
    def start(self) -> State:
        """The state before the first primitive."""
        return self.context.start

    @property
    def stability_violation(self) -> StabilityViolation | None:
        """The reason why the cloth would not stay where it lies at the start; None if it stays."""
        found = self.context.stability_violation(self.start.done, self.start.offset)
        self.context.obstacles.note_violation(found)
        return found

    def state_of(self, world: WorldState) -> State:
        """Return a state of the world as the search represents it.

        Raises:
            RequestError: the base stands at no station, or the robot has no arm of that name.
        """
        names = [name for name, _ in self.context.scene.stations]
        is_fixed = self.robot.card.is_fixed
        station = "" if is_fixed else world.base.station or ""
        if station not in names:
            raise RequestError("base.station", f"expected one of {', '.join(names)}; got {station!r}")
        here, there = self.context.placement, world.placement
        return State(
            world.done,
            (there.x_m - here.x_m, there.y_m - here.y_m),
            names.index(station),
            0 if is_fixed else nearest_whole(world.base.back_off_m * STANDOFFS_PER_M),
            _held(world, self.robot),
            nearest_whole(world.dragged_m * DRAGS_PER_M),
        )

    def is_goal(self, state: State) -> bool:
        """Return whether all folds are done."""
        return state.done == (1 << len(self.context.sequence.folds)) - 1

    def varied(
        self,
        garment: Garment | None = None,
        scene: Scene | None = None,
        placement: Pose2 | None = None,
        comfort_m: float | None = None,
        behind_max_m: float | None = None,
        grips_apart_m: float | None = None,
        *,
        minds_arms: bool = False,
    ) -> "Problem":
        """Return this problem with some values changed, for the same robot; raises as `of` does.

        The two problems share what is known of the robot's reach, so one thread must use both.
        """
        task, context, machine = self.task, self.context, self.robot
        comfort = context.reach.comfort_m if comfort_m is None else comfort_m
        moved = replace(task, garment=garment or task.garment).at(placement or task.start.placement).within(comfort)
        changed = moved if scene is None else moved.in_scene(_as_given(scene, task.scene))
        sequence = context.sequence if garment is None else replayed(garment)
        wanted, start = _searched(changed, sequence, machine)
        is_alike = (wanted.torso_m, comfort) == (context.scene.torso_m, context.reach.comfort_m) and not minds_arms
        reach = context.reach if is_alike else machine.reach(wanted.torso_m, comfort, minds_arms=minds_arms)
        fresh = context.anew(
            sequence=sequence,
            scene=wanted,
            reach=reach,
            placement=changed.start.placement,
            behind_max_m=context.behind_max_m if behind_max_m is None else behind_max_m,
            grips_apart_m=context.grips_apart_m if grips_apart_m is None else grips_apart_m,
            start=start,
        )
        known = KnownTransfers(sampling=self.maker.known.sampling)
        return Problem(changed, fresh, machine, TransferPlanner(fresh, machine, known))

    def restricted(
        self, scene: Scene | None = None, comfort_m: float | None = None, *, minds_arms: bool = False
    ) -> "Problem":
        """Return this problem with a narrower approach cone, a larger comfort radius, or arms that stay apart.

        There are fewer ways to do the steps. A narrower cone leaves each of them as it is, so that what is known of
        their transfers is shared. With less reach the base may have to drive elsewhere meanwhile.
        """
        changed = self.varied(scene=scene, comfort_m=comfort_m, minds_arms=minds_arms)
        if comfort_m is not None or minds_arms:
            return changed
        return replace(changed, maker=TransferPlanner(changed.context, self.robot, self.maker.known))

    @property
    def may_let_go(self) -> bool:
        """Whether the hands may let go at no cost: something is held at the start that no red fold needs."""
        return bool(self.start.held) and self.context.sequence.dag.last_of_begun_chain(self.start.done) is None

    def let_go(self) -> "Problem":
        """Return this problem with free hands at the start and nothing computed yet."""
        return self.anew(start=replace(self.start, held=(), dragged=0))

    def firm(self) -> "Problem":
        """Return this problem for hands that hold firmly wherever they can, with nothing computed yet."""
        return self.anew(is_firm=True)

    def without_arm_drags(self) -> "Problem":
        """Return this problem for arms that do not drag, with nothing computed yet."""
        return self.anew(is_fixed=False)

    def with_long_arms(self, more_hands: int) -> "Problem":
        """Return this problem for a robot with unlimited reach and more hands; it has no joint paths."""
        return self._with(self.context.anew(reach=UnlimitedReach(self.context.reach, more_hands)))

    def anew(self, **changes: Any) -> "Problem":  # noqa: ANN401
        """Return this problem with changes to its context, with nothing computed yet but answers to reach queries."""
        self.context.reach.memory.share()
        reach = self.robot.reach(self.context.scene.torso_m, self.context.reach.comfort_m)
        return self._with(self.context.anew(reach=reach, **changes))

    def _with(self, context: Context) -> "Problem":
        return replace(self, context=context, maker=TransferPlanner(context, self.robot))

    @staticmethod
    def of(task: Task, deadline: Deadline = ENDLESS) -> "Problem":
        """Make a task ready for planning until some deadline.

        Raises:
            FoldError: a fold is not legal on the cloth as the folds before it leave it.
            RequestError: the robot is unknown, or the folds do not allow the start.
        """
        machine, sequence = load_robot(task.robot), replayed(task.garment)
        scene, start = _searched(task, sequence, machine)
        reach = machine.reach(scene.torso_m, task.limits.comfort_radius_m)
        card = machine.card
        context = Context(
            sequence,
            scene,
            reach,
            task.start.placement,
            card.base_radius_m,
            start=start,
            is_fixed=card.is_fixed,
            base_acceleration_m_s2=card.base_acceleration_m_s2,
            deadline=deadline,
        )
        return Problem(task, context, machine, TransferPlanner(context, machine))


def _searched(task: Task, sequence: FoldSequence, machine: ArmedRobot) -> tuple[Scene, State]:
    """Return the scene and the start state for the search; a base at no station gets a station without a name.

    A base that does not move stands at no other.
    """
    start, scene = task.start, task.scene
    _require_folds_in_order(start, sequence)
    station, standoff = _stand(task)
    if machine.card.is_fixed:
        scene, station, standoff = replace(scene, stations=(("", start.base.pose),), back_off_max_m=0.0), 0, 0
    elif station is None:
        scene = replace(scene, stations=(*scene.stations, ("", start.base.pose)))
        station = len(scene.stations) - 1
    dragged = nearest_whole(start.dragged_m * DRAGS_PER_M)
    return scene, State(start.done, (0.0, 0.0), station, standoff, _held(start, machine), dragged)


def _as_given(scene: Scene, given: Scene) -> Scene:
    """Return the scene without the nameless station that stands for a base away from all stations.

    The base that does not move has that one alone; it gets the stations of the task's scene back.
    """
    named = tuple((name, pose) for name, pose in scene.stations if name)
    return replace(scene, stations=named or given.stations)


def _stand(task: Task) -> tuple[int | None, int]:
    """Return the base's station and standoff on its grid; the station is None where the base stands elsewhere."""
    base, scene = task.start.base, task.scene
    standoff = nearest_whole(base.back_off_m * STANDOFFS_PER_M)
    for number, (name, pose) in enumerate(scene.stations):
        at = pose.ahead(-standoff / STANDOFFS_PER_M)
        is_there = max(abs(at.x_m - base.x_m), abs(at.y_m - base.y_m)) <= LENGTH_M
        if name == base.station and is_there and standoff / STANDOFFS_PER_M <= scene.back_off_max_m + LENGTH_M:
            return number, standoff
    return None, 0


def _held(start: WorldState, machine: ArmedRobot) -> tuple[Held, ...]:
    names = [arm.name for arm in machine.card.arms]
    for number, held in enumerate(start.held):
        if held.arm not in names:
            raise RequestError(f"start.held[{number}].arm", f"expected one of {', '.join(names)}; got {held.arm!r}")
    found = [Held(names.index(held.arm), held.point) for held in start.held]
    if len({held.arm for held in found}) < len(found):
        raise RequestError("start.held", "an arm holds two points")
    return tuple(sorted(found, key=lambda held: held.arm))


def _require_folds_in_order(start: WorldState, sequence: FoldSequence) -> None:
    """Raise `RequestError` unless the dependencies allow the folds done in this order."""
    done = 0
    for number, fold in enumerate(start.folds_done):
        if fold not in (next_ones := sequence.dag.available(done)):
            expected = f"one of folds {', '.join(map(str, next_ones))}" if next_ones else "no more folds"
            raise RequestError(f"start.folds_done[{number}]", f"expected {expected}; got {fold}")
        done |= 1 << fold


def forget_garments() -> None:
    """Clear the caches of folded and unfolded cloth, so that benchmarks measure their computation."""
    for remembered in (replayed, fold_cloth, spread_out, cloth_memory):
        remembered.cache_clear()
