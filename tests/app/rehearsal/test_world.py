import re
from pathlib import Path

import pytest

from app.rehearsal.judge import Gate
from app.rehearsal.perform import Performer
from app.rehearsal.replay_world import Recorded, ReplayWorld
from app.rehearsal.step_motions import step_motions
from app.rehearsal.world import Observation, Performed
from tests.app.rehearsal.towel import towel_plan

DOCS = Path(__file__).parents[3] / "docs" / "rehearsal.md"


def test_the_world_in_the_docs_performs_a_plan(capsys: pytest.CaptureFixture[str]) -> None:
    found = re.search(r"```python\n(.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)
    assert found is not None
    exec(compile(found.group(1), "rehearsal.md", "exec"), {"__name__": "example"})
    assert "fold: left from" in capsys.readouterr().out


def test_a_record_is_played_step_by_step_and_ends() -> None:
    said = Performed({"left": True, "right": False})
    before, after = Observation(), Observation()
    world = ReplayWorld(before, [Recorded(said, after)])
    (motion,) = step_motions(towel_plan())
    assert world.observe() is before
    assert world.perform(motion) is said
    assert said.missing == {"right"}
    assert world.observe() is after
    with pytest.raises(LookupError):
        world.perform(motion)


def test_steps_of_which_nobody_knows_the_truth_are_performed_and_not_judged() -> None:
    world = ReplayWorld(Observation(), [Recorded(Performed(), Observation())])
    told: list[float] = []
    assert Performer(towel_plan(), world, Gate(), progress=told.append).performed().steps == ()
    assert told == [1.0]
