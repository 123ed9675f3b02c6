import threading

import pytest

from app.worker.process import ignore
from app.worker.stop import StoppedError
from app.worker.workers import Team
from tests.app.worker.test_workers import count, run_for_ever
from tests.patience import PATIENCE_S


def test_a_team_that_is_left_stops_what_it_has_begun_and_begins_nothing_more() -> None:
    begun = threading.Event()
    with Team(1) as team:
        running = team.start(team.run, run_for_ever, team.stop, lambda _: begun.set())
        waiting = team.start(team.run, count, team.stop, ignore, 1)
        assert begun.wait(PATIENCE_S)
    with pytest.raises(StoppedError):
        running.result()
    assert waiting.cancelled()
