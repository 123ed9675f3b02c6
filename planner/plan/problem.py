"""One planning problem: a garment on a table, a robot, where it starts."""

from dataclasses import dataclass
from functools import lru_cache

from planner.cloth.cloth_state import spread_out
from planner.cloth.garment import Garment
from planner.errors import RequestError
from planner.folds.fold_cloth import fold_cloth
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Pose2
from planner.plan.machine import Machine
from planner.plan.run_maker import RunMaker
from planner.primitives.reach import Reach
from planner.primitives.state import State
from planner.primitives.unlimited_reach import UnlimitedReach
from planner.primitives.work import Work
from planner.robot.pr2 import load_robot
from planner.task.scene import Scene

COMFORT_MAX_M = 0.1

_GARMENTS = 8
"""So many are not replayed again when somebody plans for them once more."""


@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """What is to be planned.

    Attributes:
        work: the garment's folds, the scene, the robot's reach, where the article lies.
        robot: the robot.
        maker: what finds its joint paths.
        start: the state before the first primitive.
    """

    work: Work
    robot: Machine
    maker: RunMaker
    start: State

    def is_goal(self, state: State) -> bool:
        """Whether all folds are done."""
        return state.done == (1 << len(self.work.sequence.folds)) - 1

    def varied(
        self,
        garment: Garment | None = None,
        scene: Scene | None = None,
        placement: Pose2 | None = None,
        comfort_m: float | None = None,
        behind_max_m: float | None = None,
        grips_apart_m: float | None = None,
    ) -> "Problem":
        """The same with some of it changed, for the same robot, what is known of its reach shared; raises as `of` does.

        So both are for one thread.
        """
        work = self.work
        wanted = scene or work.scene
        machine, comfort = self.robot, work.reach.comfort_m if comfort_m is None else comfort_m
        sequence = work.sequence if garment is None else replayed(garment)
        is_alike = (wanted.torso_m, comfort) == (work.scene.torso_m, work.reach.comfort_m)
        reach = work.reach if is_alike else machine.reach(wanted.torso_m, comfort)
        behind = work.behind_max_m if behind_max_m is None else behind_max_m
        apart = work.grips_apart_m if grips_apart_m is None else grips_apart_m
        changed = Work(sequence, wanted, reach, placement or work.placement, work.circle_m, behind, apart)
        return Problem(changed, machine, RunMaker(changed, machine), self.start)

    def with_long_arms(self, more_hands: int = 0) -> "Problem":
        """The same for a robot whose hands reach every place, and some more; joint paths are not to be asked for."""
        return self._with_reach(UnlimitedReach(self.work.reach, more_hands))

    def anew(self) -> "Problem":
        """The same with nothing worked out yet, for somebody else's use: a problem is not shared between threads."""
        return self._with_reach(self.robot.reach(self.work.scene.torso_m, self.work.reach.comfort_m))

    def _with_reach(self, reach: Reach) -> "Problem":
        work = self.work
        limits = (work.circle_m, work.behind_max_m, work.grips_apart_m)
        fresh = Work(work.sequence, work.scene, reach, work.placement, *limits)
        return Problem(fresh, self.robot, RunMaker(fresh, self.robot), self.start)

    @staticmethod
    def of(
        garment: Garment,
        scene: Scene,
        placement: Pose2 | None,
        start_station: str,
        robot: str,
        comfort_radius_m: float,
    ) -> "Problem":
        """A problem; the attributes are those of `make_plan`.

        Raises:
            FoldError: a fold is not legal on the cloth as it is then.
            RequestError: an option is out of range.
        """
        names = [name for name, _ in scene.stations]
        if start_station not in names:
            raise RequestError("start_station", f"{start_station!r} is none of {', '.join(names)}")
        require_between("comfort_radius_m", comfort_radius_m, 0.0, COMFORT_MAX_M)
        machine = load_robot(robot)
        reach = machine.reach(scene.torso_m, comfort_radius_m)
        work = Work(replayed(garment), scene, reach, placement or garment.placement, machine.card.base_radius_m)
        start = State(0, (0.0, 0.0), names.index(start_station), 0)
        return Problem(work, machine, RunMaker(work, machine), start)


def require_between(field: str, value: float, low: float, high: float) -> None:
    """Raise `RequestError` for an option that is out of range."""
    if not low <= value <= high:
        raise RequestError(field, f"{value} is not between {low:g} and {high:g}")


replayed = lru_cache(_GARMENTS)(FoldSequence.of)
"""A garment with its folds made legal. The latest are remembered, with what was worked out about their cloth."""


def forget_garments() -> None:
    """Forget all cloth that is remembered, folded or not: whoever measures wants it worked out anew."""
    for remembered in (replayed, fold_cloth, spread_out):
        remembered.cache_clear()
