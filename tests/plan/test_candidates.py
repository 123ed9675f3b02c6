"""What is looked at before arms are led: whether they can be where a run begins, ends, and goes."""

import numpy as np
import pytest

from planner.plan.moments import moments_of
from tests.replay.planned import planned


@pytest.mark.parametrize("name", ["t-shirt", "tie", "letter-towel", "big-towel"])
def test_a_run_begins_and_ends_where_its_extremes_are(name: str):
    plan = planned(name).answer
    for act in (act for act in plan.acts if act.run is not None):
        whole = plan.problem.maker.candidate(act.steps).moments
        phases = [phase for step in act.steps for phase in step.extremes()]
        ends = moments_of(phases, plan.scene.table.height_m)
        for moment in (0, -1):
            np.testing.assert_allclose(ends.bases[moment], whole.bases[moment], atol=1e-9)
            np.testing.assert_allclose(ends.positions[:, moment], whole.positions[:, moment], atol=1e-9)
            np.testing.assert_allclose(ends.rotations[:, moment], whole.rotations[:, moment], atol=1e-9)


def test_what_was_made_real_is_a_candidate():
    plan = planned("t-shirt").answer
    runs = [act.steps for act in plan.acts if act.run is not None]
    assert [candidate.steps for candidate in plan.problem.maker.candidates(runs)] == runs
