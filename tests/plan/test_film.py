"""The joints of films between runs, where hands are free and the base drives: clear of everything, without a gap."""

from itertools import pairwise

import numpy as np
import pytest

from planner import Plan, Scene, make_plan
from planner.geometry.pose import Pose2
from planner.plan.cue import Cue
from planner.plan.film import Film, FilmMaker
from planner.plan.joint_track import CLOSED_M, OPEN_M, JointTrack
from planner.plan.timeline import standing
from planner.robot.pr2 import load_robot
from tests.builders import fold, garment, rectangle_points
from tests.replay.planned import planned

RATE_HZ = 25.0
ROBOT = load_robot("pr2")
HOME = np.array([ROBOT.home(0), ROBOT.home(1)])
NAMES = ("hand-towel", "t-shirt", "jeans")

each_name = pytest.mark.parametrize("name", NAMES)


def film_of(plan: Plan) -> Film:
    maker = FilmMaker(plan.problem.maker.transits, plan.problem.maker.collisions, plan.problem.maker.dwell_s)
    return maker.film(plan.acts, standing(plan.work, plan.problem.start))


def is_holding(cue: Cue, arm: int) -> bool:
    hand = cue.phase.hands[arm]
    return hand is not None and not hand.is_reaching


def base_at(film: Film, t_s: float):
    number = max(0, int(np.searchsorted(film.starts_s, t_s, side="right")) - 1)
    return film.cues[number].base_at(t_s - film.starts_s[number])


@pytest.mark.parametrize("name", NAMES[1:])
def test_between_some_runs_the_base_drives(name):
    # Else the tests that follow say little.
    plan = planned(name).answer
    assert any(cue.phase.motion is None and cue.phase.base[0] != cue.phase.base[1] for cue in film_of(plan).cues)


@each_name
def test_the_arms_touch_nothing_while_the_film_runs(name):
    plan = planned(name).answer
    film = film_of(plan)
    collisions = ROBOT.collisions(plan.scene.table, plan.scene.torso_m)
    times = np.arange(0.0, plan.cost_s, 1.0 / RATE_HZ)
    bases = [base_at(film, t) for t in times]
    joints = np.array([film.track.joints_at(t) for t in times])
    start = 0
    for end in range(1, len(times) + 1):
        if end == len(times) or bases[end] != bases[start]:
            is_free = collisions.free(bases[start], joints[start:end])
            assert is_free.all(), f"at {times[start + int(np.argmin(is_free))]:.2f} s"
            start = end


@each_name
def test_cues_follow_one_another_without_a_gap_and_last_as_long_as_the_plan(name):
    plan = planned(name).answer
    film = film_of(plan)
    for (cue, start), (after, begins) in pairwise(zip(film.cues, film.starts_s, strict=True)):
        assert begins == pytest.approx(start + cue.duration_s)
        assert after.primitive >= cue.primitive
        one, other = cue.base_at(cue.duration_s), after.base_at(0.0)
        assert (one.x_m, one.y_m) == pytest.approx((other.x_m, other.y_m), abs=1e-6)
    assert film.starts_s[-1] + film.cues[-1].duration_s == pytest.approx(plan.cost_s)
    assert film.track.times_s[-1] <= plan.cost_s + 1e-9


@each_name
def test_no_joint_is_faster_from_keyframe_to_keyframe_than_it_can_be(name):
    track = film_of(planned(name).answer).track
    limits = np.array([arm.speeds_rad_s for arm in ROBOT.card.arms])
    speeds = np.abs(np.diff(track.joints, axis=0)) / np.diff(track.times_s)[:, None, None]
    assert (speeds / limits).max() <= 1.0 + 1e-6


@each_name
def test_grippers_are_shut_while_they_hold_cloth_and_open_at_the_start_and_the_end(name):
    plan = planned(name).answer
    film = film_of(plan)
    for arm in (0, 1):
        ends = [film.track.opening_at(arm, t) for t in (0.0, plan.cost_s)]
        assert ends == pytest.approx([OPEN_M, OPEN_M])
    held = 0
    for (cue, after), start in zip(pairwise((*film.cues, None)), film.starts_s, strict=True):
        for arm in (0, 1):
            if is_holding(cue, arm):
                held += 1
                is_last = after is None or not is_holding(after, arm)
                lasts = cue.duration_s - plan.scene.grip_dwell_s if is_last else cue.duration_s
                for t in np.linspace(start, start + lasts, 5):
                    assert film.track.opening_at(arm, t) == pytest.approx(CLOSED_M)
    assert held >= len(plan.garment.folds)


@each_name
def test_arms_begin_at_home(name):
    assert film_of(planned(name).answer).track.joints_at(0.0) == pytest.approx(HOME)


def test_a_track_goes_evenly_from_keyframe_to_keyframe_and_rests_at_its_ends():
    track = JointTrack.at_rest(HOME)
    track.add(np.array([1.0, 2.0]), np.array([HOME + 0.4, HOME]))
    assert track.joints_at(0.25) == pytest.approx(HOME + 0.1)
    assert track.joints_at(1.5) == pytest.approx(HOME + 0.2)
    assert track.joints_at(-1.0) == pytest.approx(HOME) and track.joints_at(9.0) == pytest.approx(HOME)


def test_keyframes_that_come_too_late_are_left_out():
    track = JointTrack.at_rest(HOME)
    track.add(np.array([1.0, 1.0, 0.5]), np.array([HOME + 0.4, HOME + 0.8, HOME]))
    assert track.times_s == [0.0, 1.0]
    assert track.joints_at(1.0) == pytest.approx(HOME + 0.4)


def test_fingers_close_and_open_evenly_and_when_they_are_told():
    track = JointTrack.at_rest(HOME)
    track.close(1, 1.5, 2.0)
    track.open(1, 3.0, 3.5)
    found = [track.opening_at(1, t) for t in (1.5, 1.75, 2.0, 3.0, 3.25, 3.5)]
    middle = (OPEN_M + CLOSED_M) / 2
    assert found == pytest.approx([OPEN_M, middle, CLOSED_M, CLOSED_M, middle, OPEN_M])
    assert track.opening_at(0, 2.5) == OPEN_M


def test_cloth_that_lies_still_is_one_surface_and_what_is_folded_another():
    plan = planned("hand-towel").answer
    timeline = plan.timeline()
    moving = [primitive.start_s + 0.5 * primitive.duration_s for primitive in plan.primitives]
    still = timeline.at(0.0).cloth
    assert timeline.at(0.1).cloth is still
    surfaces = [timeline.at(t_s).cloth for t_s in moving]
    assert len({id(surface) for surface in [still, *surfaces]}) == len(moving) + 1


def test_hands_that_rest_through_a_phase_for_which_there_is_no_time_take_none():
    # The grips lie nearer to the fold line than the far corner does, so they rest while the cloth begins to rise; and
    # between two stands of the base that takes no time in a way that is tried, slower as a whole than 1 ms.
    towel = garment(
        rectangle_points(0.2, 0.4),
        fold((0.0, 0.39604646049498443), (0.2, 0.3877103804729817)),
        placement=Pose2(0.162323971451364, -0.025457994644062065, np.pi / 2),
    )
    plan = make_plan(towel, Scene(approach_cone_rad=0.0, arm_motion_s=0.001, base_speed_m_s=1000.0), time_limit_s=60.0)
    assert plan.is_solved
    film = film_of(plan)
    assert film.starts_s[-1] + film.cues[-1].duration_s == pytest.approx(plan.cost_s)
    assert [frame.t_s for frame in plan.timeline().samples(50.0)][-1] == plan.cost_s
