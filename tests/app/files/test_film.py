"""Films of a plan: MP4, GIF and a still picture, painted without a browser."""

import io
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image, ImageSequence

from app.files import film as film_module
from app.files.film import GIF_PX, HOLD_S, STILL_PX, gif_film, mp4_film, still
from app.language import ENGLISH
from app.ui.colours import LIGHT
from app.ui.scene_picture import Part, ScenePainter
from app.ui.viewpoint import Viewpoint
from app.ui.weave import woven
from planner.geometry.pose import FloatArray
from planner.motion.timeline import Timeline
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan
from tests.replay.planned import shipped_plan
from tests.required import required

RATE_HZ = 1.0


@pytest.fixture(scope="module")
def plan() -> Plan:
    return shipped_plan("hand-towel")


def frames_of(plan: Plan) -> float:
    return RATE_HZ * (required(plan.cost_s) + HOLD_S)


def test_a_gif_lasts_as_long_as_the_plan_and_shows_another_picture_each_second(plan: Plan) -> None:
    film = Image.open(io.BytesIO(gif_film(plan, RATE_HZ, lambda: False, ENGLISH, is_dark=False)))
    assert film.size == GIF_PX
    pictures = [np.asarray(one.convert("L"), float) for one in ImageSequence.Iterator(film)]
    lasted_s = sum(one.info["duration"] for one in ImageSequence.Iterator(film)) / 1000.0
    assert lasted_s == pytest.approx(frames_of(plan) / RATE_HZ, abs=1.5)
    changes = [np.abs(one - other).max() for one, other in pairwise(pictures)]
    assert sum(change > 20.0 for change in changes) > 0.8 * required(plan.cost_s)


def test_an_mp4_has_the_frames_asked_for(plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    av = pytest.importorskip("av")
    monkeypatch.setattr(film_module, "FILM_PX", (320, 180))
    film = mp4_film(plan, RATE_HZ, lambda: False, ENGLISH, is_dark=True)
    with av.open(io.BytesIO(film)) as file:
        frames = [frame.to_ndarray(format="rgb24") for frame in file.decode(video=0)]
    assert len(frames) == pytest.approx(frames_of(plan), abs=1.5)
    assert frames[0].shape == (180, 320, 3)


def test_a_film_that_nobody_wants_any_more_is_empty(plan: Plan) -> None:
    assert gif_film(plan, RATE_HZ, lambda: True, ENGLISH, is_dark=False) == b""


def test_a_still_has_the_size_of_pictures_beside_links(plan: Plan) -> None:
    assert Image.open(io.BytesIO(still(plan, ENGLISH, is_dark=False))).size == STILL_PX


def seen_from_above(plan: Plan, t_s: float, height_m: float = 6.0) -> FloatArray:
    painter = ScenePainter(load_robot(plan.task.robot).card, plan.scene, LIGHT)
    above = Viewpoint((0.0, -0.001, height_m), (0.0, 0.0, 0.0))
    picture = painter.picture(Timeline.of(plan).at(t_s), plan.garment.layer_m, above, (600, 600))
    return np.asarray(picture, float)


def test_cloth_is_painted_with_threads_along_its_pattern(plan: Plan) -> None:
    picture = seen_from_above(plan, 0.0, 2.0)
    is_cloth = np.abs(picture - LIGHT.cloth_front).max(axis=2) < 20.0
    assert picture[is_cloth].mean(axis=1).std() > 1.0
    near, far = (woven(np.random.default_rng(1).uniform(0.0, 1.0, (2000, 2)), np.full(2000, m)) for m in (1e-4, 0.1))
    assert near.mean() == pytest.approx(1.0, abs=0.01)
    assert 0.03 < near.std() < 0.1
    assert np.all(far == 1.0)


def test_cloth_is_painted_in_its_colour_as_large_as_it_is(plan: Plan) -> None:
    picture = seen_from_above(plan, 0.0)
    m_per_px = 2.0 * 6.0 * np.tan(Viewpoint((0.0, 0.0, 1.0), (0.0, 0.0, 0.0)).fov_rad / 2.0) / 600
    is_cloth = np.abs(picture - LIGHT.cloth_front).max(axis=2) < 20.0
    assert is_cloth.sum() * m_per_px**2 == pytest.approx(plan.garment.pattern.area, rel=0.1)


def test_cloth_of_many_pieces_faces_up_on_a_table_below_the_origin_too() -> None:
    corners = np.array([[0.0, 0.0, -1.0], [0.1, 0.0, -1.0], [0.0, 0.1, -1.0]])
    many = np.concatenate([corners + np.array([0.1 * count, 0.0, 0.0]) for count in range(200)])
    cloth = Part.of(many, np.arange(600).reshape(-1, 3), LIGHT.cloth_front)
    assert cloth.normals == pytest.approx(np.tile([0.0, 0.0, 1.0], (600, 1)))
