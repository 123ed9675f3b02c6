from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from app.studies import workers as study_workers
from app.studies.fields import StudyError
from app.studies.workers import ExecutorWorkers, InProcess, LocalWorkers, Workers, cluster
from tests.app.studies.planners import deadly, deadly_once, fake_plan, hanging, raising
from tests.app.studies.study_samples import study

MANY = study(table={"height_m": {"from": 0.5, "to": 1.0, "count": 51}})


def answers(workers: Workers, asked: Any = None) -> dict[int, Any]:
    cells = (asked or study()).cells((asked or study()).indices())
    found = list(workers.answers(cells))
    assert len(found) == len({answer.index for answer in found})
    return {answer.index: answer.row for answer in found}


def test_a_worker_that_dies_is_replaced_and_its_cell_begun_once_more(tmp_path: Path) -> None:
    marker = tmp_path / "died"
    assert answers(LocalWorkers(1, partial(deadly_once, marker))) == answers(InProcess(fake_plan))
    assert marker.exists()


def test_a_cell_that_kills_its_worker_twice_is_a_row_and_the_others_are_answered() -> None:
    found = answers(LocalWorkers(2, deadly), MANY)
    assert found[25]["status"] == "failed"
    assert "-9" in found[25]["error"]
    expected = answers(InProcess(raising), MANY)
    assert found | {25: expected[25]} == expected


def test_a_cell_that_hangs_is_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study_workers, "_GRACE_S", 0.0)
    found = answers(LocalWorkers(2, hanging), study(limits={"time_limit_s": 0.5}))
    assert [found[index]["status"] for index in range(4)] == ["solved", "failed", "infeasible", "infeasible"]
    assert "time limit" in found[1]["error"]


def test_cells_are_made_only_as_they_are_needed() -> None:
    taken = []

    def cells() -> Any:
        for cell in MANY.cells(MANY.indices()):
            taken.append(cell.index)
            yield cell

    running = LocalWorkers(1, fake_plan).answers(cells())
    next(running)
    assert len(taken) <= 2 + study_workers.AHEAD
    running.close()


def test_workers_that_all_die_end_the_study(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study_workers, "LOST_MAX", 2)
    with pytest.raises(study_workers.WorkersLostError, match="-9"):
        answers(LocalWorkers(1, deadly), study(table={"height_m": 0.75}, scene={"friction": [0.1, 0.2, 0.3]}))


def test_an_executor_answers_as_one_process_does() -> None:
    with ThreadPoolExecutor(2) as executor:
        assert answers(ExecutorWorkers(executor, 2, raising), MANY) == answers(InProcess(raising), MANY)


def test_a_batch_whose_worker_is_lost_comes_back_cell_by_cell() -> None:
    class Losing(ThreadPoolExecutor):
        """Loses every batch with the second cell in it."""

        def submit(self, work: Any, /, *arguments: Any, **options: Any) -> Any:
            if any(cell.index == 1 for cell in arguments[0]):
                return super().submit(_lose)
            return super().submit(work, *arguments, **options)

    with Losing(2) as executor:
        found = answers(ExecutorWorkers(executor, 2, fake_plan))
    assert "lost" in found[1]["error"]
    assert [found[index]["status"] for index in (0, 2, 3)] == ["solved", "infeasible", "infeasible"]


def test_a_scheduler_that_does_not_answer_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study_workers, "_CONNECT_S", 0.1)
    with pytest.raises(StudyError, match=r"127\.0\.0\.1:1"), cluster("tcp://127.0.0.1:1"):
        pass


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_a_dask_cluster_answers_as_one_process_does() -> None:
    from distributed import LocalCluster

    asked = study(table={"height_m": [0.7, 5.0]})
    with (
        LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as local,
        cluster(local.scheduler_address) as workers,
    ):
        assert answers(workers, asked) == answers(InProcess(), asked)


def _lose() -> None:
    raise ConnectionError("the worker is gone")
