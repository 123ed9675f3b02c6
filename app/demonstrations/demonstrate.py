"""Make demonstrations side by side in workers until there are enough, in the order of their seeds."""

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future

from app.demonstrations.dataset import DemonstrationDataset
from app.files.lerobot_dataset import Episode
from app.rehearsal.rehearse import require_physics
from app.worker.process import Caller, ignore
from app.worker.workers import Team
from planner.task.task import Task

TRIES_MAX = 10
"""Seeds that are tried for each demonstration, at most."""


def demonstrate(
    task: Task,
    dataset: DemonstrationDataset,
    episodes: int,
    workers: int,
    progress: Callable[[int, int], None],
    *,
    has_wrists: bool = True,
) -> bool:
    """Add demonstrations to a dataset until it has so many; return whether it has.

    Args:
        task: what is demonstrated; each seed varies it.
        dataset: the dataset; whatever ends this early, it is whole.
        episodes: how many it is to have.
        workers: how many are made at once; the dataset is the same for any number.
        progress: called with how many episodes there are, and how many seeds were tried.
        has_wrists: whether there are cameras on the wrists.

    Raises:
        RequestError: MuJoCo or OpenCV is not installed.
        OSError: the system refuses to write.
    """
    require_physics()
    first = dataset.next_seed
    last = first + TRIES_MAX * max(episodes - dataset.count, 0)
    running: deque[Future[Episode | None]] = deque()
    with Team(workers) as team:
        while dataset.count < episodes and dataset.next_seed < last:
            while len(running) < workers and (seed := dataset.next_seed + len(running)) < last:
                running.append(team.start(team.run, _made, team.stop, ignore, task, seed, has_wrists))
            dataset.tried(running.popleft().result())
            progress(dataset.count, dataset.next_seed - first)
    return dataset.count >= episodes


def _made(caller: Caller, task: Task, seed: int, has_wrists: bool) -> Episode | None:
    """Make a demonstration, in a worker."""
    from app.demonstrations.episode import demonstration  # needs MuJoCo and the whole planner

    return demonstration(task, seed, caller.should_stop, has_wrists=has_wrists)
