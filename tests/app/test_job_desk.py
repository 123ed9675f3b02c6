import threading
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
from sqlalchemy import text

from app.jobs.job_desk import BEGUN_MAX, OPEN_OF_CLIENT_MAX
from app.jobs.job_pool import BusyError
from app.jobs.limits import TooManyError
from app.store.database import Database
from app.store.job_repository import JobRepository, UnknownJobError
from planner.errors import RequestError
from tests.app.job_works import desk, ended, submitted, told
from tests.app.processes import is_alive
from tests.patience import wait_until


def test_a_job_is_done_apart_and_its_result_is_kept(tmp_path: Path) -> None:
    with desk(tmp_path) as jobs:
        heard = threading.Event()
        job = submitted(jobs, "halve", 7)
        jobs.subscribe(job.id, heard.set)
        assert (job.status, job.progress, jobs.result(job.id)) in (("queued", 0.0, None), ("running", 0.0, None))
        done = ended(jobs, job)
        assert (done.status, done.progress, jobs.result(job.id)) == ("done", 1.0, 3.5)
        assert heard.is_set()
        assert done.started_s is not None and done.ended_s is not None
        assert done.created_s <= done.started_s <= done.ended_s
    with desk(tmp_path) as jobs:
        assert jobs.job(job.id) == done
        assert jobs.result(job.id) == 3.5


@pytest.mark.parametrize(
    ("name", "why"), [("fail", "number: 1 does not please"), ("crash", "process ended"), ("not-json", "log says why")]
)
def test_a_job_that_fails_says_why(tmp_path: Path, name: str, why: str) -> None:
    with desk(tmp_path) as jobs:
        job = ended(jobs, submitted(jobs, name))
        assert job.status == "failed"
        assert why in job.message


def test_a_bad_request_is_refused_before_there_is_a_job(tmp_path: Path) -> None:
    with desk(tmp_path) as jobs:
        with pytest.raises(RequestError, match="below zero"):
            submitted(jobs, "halve", -1)
        assert jobs.newest(10) == []


def test_cancelling_kills_the_work_with_the_processes_it_has_started(tmp_path: Path) -> None:
    with desk(tmp_path) as jobs:
        running = told(jobs, submitted(jobs, "wait"))
        assert is_alive(int(running.message))
        assert jobs.cancel(running.id).status == "cancelled"
        wait_until(lambda: not is_alive(int(running.message)))
        assert jobs.cancel(running.id).status == "cancelled"


def test_a_job_that_waits_can_be_cancelled_and_one_that_has_ended_stays_as_it_is(tmp_path: Path) -> None:
    with desk(tmp_path, workers=1) as jobs:
        running, waiting = submitted(jobs, "wait"), submitted(jobs, "halve")
        assert jobs.cancel(waiting.id).status == "cancelled"
        jobs.cancel(running.id)
        done = ended(jobs, submitted(jobs, "halve"))
        assert jobs.cancel(done.id) == done


def test_a_search_is_listed_until_it_is_cancelled(tmp_path: Path) -> None:
    with desk(tmp_path, workers=1) as jobs:
        first, look, last = submitted(jobs, "wait"), submitted(jobs, "look"), submitted(jobs, "halve")
        assert [job.id for job in jobs.newest(10)] == [last.id, look.id, first.id]
        assert jobs.cancel(look.id).status == "cancelled"
        assert jobs.cancel(first.id).status == "cancelled"
        assert [job.id for job in jobs.newest(10)] == [last.id, first.id]
        assert [job.id for job in jobs.newest(1, before=last.id)] == [first.id]
        assert jobs.job(look.id).status == "cancelled"


def test_jobs_that_the_end_of_the_server_interrupted_are_begun_anew_or_marked(tmp_path: Path) -> None:
    with desk(tmp_path, workers=1) as jobs:
        running, waiting = told(jobs, submitted(jobs, "wait")), submitted(jobs, "halve", 9)
    wait_until(lambda: not is_alive(int(running.message)))
    with desk(tmp_path) as jobs:
        assert jobs.job(running.id).status == "running"
        jobs.resume()
        marked = jobs.job(running.id)
        assert (marked.status, marked.message) == ("failed", "the server stopped")
        assert ended(jobs, waiting).status == "done"
        assert jobs.result(waiting.id) == 4.5


def test_a_job_that_ended_the_server_again_and_again_is_given_up(tmp_path: Path) -> None:
    database = Database(tmp_path / "pleat.db")
    repository = JobRepository(database)
    job = repository.add("halve", "me", "", {"number": 1})
    repository.keep(replace(job, status="running", begun=BEGUN_MAX))
    database.close()
    with desk(tmp_path) as jobs:
        jobs.resume()
        assert jobs.job(job.id).status == "failed"


@pytest.mark.parametrize("progress", ["'a half'", "x'00'", "9e999"])
def test_a_progress_that_is_no_number_is_read_as_none_done(tmp_path: Path, progress: str) -> None:
    with closing(Database(tmp_path / "pleat.db")) as database:
        repository = JobRepository(database)
        bad, good = (repository.add("halve", "me", "", {"number": 1}) for _ in range(2))
        with database.writing("the row could not be written") as session:
            session.execute(text(f"UPDATE jobs SET progress = {progress} WHERE id = :id"), {"id": bad.id})
        assert repository.job(bad.id) == bad
        assert repository.newest(10) == [good, bad]
        assert repository.interrupted() == [bad, good]


def test_an_interrupted_job_whose_request_cannot_be_read_is_marked(tmp_path: Path) -> None:
    with desk(tmp_path) as jobs, closing(Database(tmp_path / "pleat.db")) as database:
        repository = JobRepository(database)
        bad, good = (repository.add("halve", "me", "", {"number": 1}) for _ in range(2))
        with database.writing("the row could not be written") as session:
            session.execute(text("UPDATE jobs SET body = '{x' WHERE id = :id"), {"id": bad.id})
        jobs.resume()
        assert jobs.job(bad.id).status == "failed"
        assert ended(jobs, good).status == "done"


def test_a_full_queue_and_a_client_with_too_many_jobs_are_refused(tmp_path: Path) -> None:
    with desk(tmp_path, workers=1, waiting_max=OPEN_OF_CLIENT_MAX) as jobs:
        told(jobs, submitted(jobs, "wait", client="other"))
        for _ in range(OPEN_OF_CLIENT_MAX - 1):
            submitted(jobs, "wait")
        last = submitted(jobs, "wait")
        with pytest.raises(TooManyError) as refused:
            submitted(jobs, "halve")
        assert refused.value.retry_after_s >= 1
        with pytest.raises(BusyError):
            submitted(jobs, "halve", client="third")
        jobs.cancel(last.id)
        submitted(jobs, "halve")


def test_the_list_is_newest_first_and_goes_on_where_a_page_ended(tmp_path: Path) -> None:
    with desk(tmp_path) as jobs:
        asked = [ended(jobs, submitted(jobs, "halve", number)) for number in range(5)]
        assert jobs.newest(2) == [asked[4], asked[3]]
        assert jobs.newest(9, before=asked[3].id) == [asked[2], asked[1], asked[0]]
        with pytest.raises(UnknownJobError):
            jobs.newest(1, before="nothing")
        with pytest.raises(UnknownJobError):
            jobs.job("nothing")
