"""Make demonstrations side by side in workers until there are enough, in the order of their seeds."""

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor

from app.demonstrations.dataset import DemonstrationDataset
from app.files.lerobot_dataset import Episode
from app.rehearsal.rehearse import require_physics
from app.worker.process import Caller
from app.worker.stop import Stop
from app.worker.workers import Workers
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
        progress: is told how many episodes there are, and how many seeds were tried.
        has_wrists: whether there are cameras on the wrists.

    Raises:
        RequestError: MuJoCo or OpenCV is not installed.
        OSError: the system refuses to write.
    """
    require_physics()
    stop, last = Stop(), dataset.next_seed + TRIES_MAX * max(episodes - dataset.count, 0)
    first = dataset.next_seed
    with Workers(kept=workers) as team, ThreadPoolExecutor(workers) as threads:

        def begun(seed: int) -> Future[Episode | None]:
            return threads.submit(team.run, _made, stop, lambda _news: None, task, seed, has_wrists)

        running: deque[Future[Episode | None]] = deque()
        try:
            while dataset.count < episodes and dataset.next_seed < last:
                while len(running) < workers and dataset.next_seed + len(running) < last:
                    running.append(begun(dataset.next_seed + len(running)))
                dataset.tried(running.popleft().result())
                progress(dataset.count, dataset.next_seed - first)
        finally:
            stop.set()
            threads.shutdown(cancel_futures=True)
    return dataset.count >= episodes


def _made(caller: Caller, task: Task, seed: int, has_wrists: bool) -> Episode | None:
    """Make a demonstration, in a worker."""
    from app.demonstrations.episode import demonstration  # needs MuJoCo and the whole planner

    return demonstration(task, seed, caller.should_stop, has_wrists=has_wrists)
