"""The trace of a run: the cloth along the plan's time, beside the cloth as planned."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal import trace as trace_module
from app.rehearsal.filmed_world import FilmedWorld, Tick
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.rehearse import RehearsalOptions, rehearse
from app.rehearsal.step_motions import step_motions
from app.rehearsal.trace import UNIT_M, ClothAfter, RunTrace, counterpart, looked_before, rounded, traced
from app.rehearsal.world import Observation, Performed, StepMotion, Truth
from planner import Plan, make_plan
from planner.geometry.woven_mesh import woven_mesh
from tests.app.rehearsal.towel import COARSE, towel_plan
from tests.replay.planned import shipped_plan
from tests.required import required


@pytest.fixture(scope="module")
def letter() -> Plan:
    """Return the plan of two folds: by hands that hold on, and by those."""
    return shipped_plan("letter-towel")


class Lifted:
    """Cloth that rises by a centimetre in each second in which hands hold it."""

    def __init__(self, plan: Plan, tick: Tick) -> None:
        self.elapsed_s = 0.0
        self._tick = tick
        pattern, triangles = woven_mesh(plan.garment.pattern, 0.05, 1)
        lies = planned_positions(plan.sequence, pattern, 0, plan.task.start.placement, plan.scene.table, 0.002)
        self._truth = Truth(pattern, lies, triangles)

    def observe(self) -> Observation:
        return Observation()

    def perform(self, motion: StepMotion) -> Performed:
        spent_s = max(grip.times_s[-1] - grip.times_s[0] for grip in motion.grips)
        for _ in range(round(spent_s / 0.01)):
            self.elapsed_s += 0.01
            self._truth = replace(self._truth, positions=self._truth.positions + np.array([0.0, 0.0, 1e-4]))
            self._tick()
        return Performed()

    def truth(self) -> Truth:
        return self._truth


def filmed(plan: Plan, progress: Callable[[float], None] = lambda _: None) -> FilmedWorld:
    return FilmedWorld(plan, lambda tick: Lifted(plan, tick), progress)  # type: ignore[arg-type, return-value]


def height_m(frame: np.ndarray) -> float:
    return UNIT_M * float(frame[:, 2].mean())


def test_a_film_runs_along_the_plan_and_is_still_while_nothing_is_held(letter: Plan) -> None:
    told: list[float] = []
    world = filmed(letter, told.append)
    for motion in step_motions(letter):
        world.perform(motion)
    assert told == sorted(told) and 0.0 < told[0] < 0.5 < told[-1] <= 1.0
    times = [t_s for t_s, _ in world.frames]
    assert times == sorted(set(times)) and times[0] == 0.0 and times[-1] <= required(letter.cost_s)
    first = step_motions(letter)[0].grips[0].times_s[0]
    lies = height_m(world.frames[0][1])
    for t_s, frame in world.frames:
        if t_s <= first:
            assert height_m(frame) == pytest.approx(lies)
        elif t_s < letter.steps[0].end_s:
            assert height_m(frame) == pytest.approx(lies + 0.01 * (t_s - first), abs=2e-3)
    assert height_m(world.frames[-1][1]) > lies + 0.05


def test_of_a_step_that_is_tried_again_the_last_time_is_kept_and_nothing_after_another_plan(letter: Plan) -> None:
    world, motion = filmed(letter), step_motions(letter)[0]
    world.perform(motion)
    once, ends = len(world.frames), height_m(world.frames[-1][1])
    world.perform(motion)
    assert len(world.frames) == pytest.approx(once, abs=1)
    assert height_m(world.frames[-1][1]) > ends + 0.05
    kept = len(world.frames)
    world.end()
    world.perform(motion)
    assert len(world.frames) == kept


def test_a_run_of_a_towel_is_traced_from_where_it_lies_to_where_the_plan_has_it() -> None:
    plan = towel_plan()
    options = RehearsalOptions(1, resolution=COARSE, workers=1, traced=1)
    (run,) = rehearse(plan, options).runs
    trace = run.trace
    assert trace is not None and run.steps[0].of_plan == 0
    (step,) = trace.steps
    assert step.of_plan == 0
    apart = np.linalg.norm(UNIT_M * (step.found.astype(float) - step.planned), axis=1)
    assert 1000.0 * apart.mean() < run.steps[0].mean_mm + run.steps[0].slid_mm + 1.0
    for name, within in (("planned", 0.01), ("found", 0.2)):  # rows of the coarse mesh are 35 mm apart
        xs, ys = np.array(step.outlines[name][0]).T
        assert abs(np.dot(xs, np.roll(ys, 1)) - np.dot(ys, np.roll(xs, 1))) / 2 == pytest.approx(0.06, rel=within)
    cost_s = required(plan.cost_s)
    middle = trace.at(0.5 * cost_s)
    assert middle[:, 2].max() > 0.05 > trace.at(0.0)[:, 2].max()
    np.testing.assert_array_equal(trace.at(cost_s + 1.0), UNIT_M * step.found)
    look, *after = trace.pictures  # before the fold, and after it
    assert after
    assert look["of_plan"] == 0 and look["known"] and len(look["expected_px"]) == len(look["fitted_px"]) == 4
    assert look["start"]["placement"] == look["fit"]["placement"]
    again = RunTrace.unpacked(trace.packed())
    for t_s in (0.0, 3.3, cost_s):
        np.testing.assert_array_equal(again.at(t_s), trace.at(t_s))
    np.testing.assert_array_equal(again.triangles, trace.triangles)
    assert (again.pictures, again.steps[0].outlines) == (trace.pictures, step.outlines)


@pytest.mark.long
def test_runs_beyond_those_that_are_traced_have_no_trace() -> None:
    options = RehearsalOptions(2, resolution=replace(COARSE, edge_m=0.06, settle_s=0.1), workers=1, traced=1)
    assert [run.trace is None for run in rehearse(towel_plan(), options).runs] == [False, True]


def test_a_step_of_another_plan_stands_for_the_one_that_leaves_the_same_folded(letter: Plan) -> None:
    assert [counterpart(letter, step) for step in letter.steps] == list(range(len(letter.steps)))
    again = make_plan(replace(letter.task, start=letter.state_after(-1)))
    assert [counterpart(letter, step) for step in again.steps] == [
        number for number, step in enumerate(letter.steps) if step.fold is not None
    ]
    assert looked_before(letter, letter.steps[0].before) == 0
    assert looked_before(letter, replace(letter.steps[0].before, placement=letter.garment.placement.moved(1, 1))) == 0
    assert looked_before(letter, letter.end) is None


def test_of_long_runs_frames_are_left_out_evenly(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = towel_plan()
    lies = Lifted(plan, lambda: None).truth()
    film = [(float(t_s), rounded(lies.positions + np.array([0.0, 0.0, 0.01 * t_s]))) for t_s in range(9)]
    monkeypatch.setattr(trace_module, "_NUMBERS_MAX", 5 * lies.positions.size)
    trace = traced(plan, lies, film, (ClothAfter(0, lies.positions),), [])
    assert trace.times_s.tolist() == pytest.approx([0.0, 2.0, 4.0, 7.0, plan.steps[0].end_s])
