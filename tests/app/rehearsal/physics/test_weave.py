"""The stiffness of woven cloth against MuJoCo's own, where the two agree."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.model import model_xml
from app.rehearsal.physics.weave import Weave
from planner.geometry.woven_mesh import woven_mesh
from tests.builders import rectangle

POINTS, TRIANGLES = woven_mesh(rectangle(0.1, 0.08), 0.03)
FLAT = np.column_stack([POINTS, np.zeros(len(POINTS))])
ALIKE = Fabric(stretch_n_m=300.0, push_n_m=300.0, shear_n_m=150.0)


def test_cloth_alike_in_all_directions_has_the_stiffness_that_mujoco_gives_it() -> None:
    model = mujoco.MjModel.from_xml_string(model_xml(FLAT, POINTS, TRIANGLES, ALIKE, Resolution(), None))
    own = model.flex_stiffness.reshape(len(TRIANGLES), -1)
    found = Weave.of(POINTS, TRIANGLES, ALIKE, 0.03).stiffness(1.1 * FLAT)
    assert found == pytest.approx(own[:, :6], rel=1e-6, abs=1e-6 * own.max())
    assert not own[:, 6:].any()


def test_the_stiffness_depends_on_how_threads_run_and_on_whether_they_are_pulled() -> None:
    turn = np.array([[0.8, -0.6], [0.6, 0.8]])
    fabric = replace(ALIKE, shear_n_m=30.0, push_n_m=60.0)
    woven = Weave.of(POINTS, TRIANGLES, fabric, 0.03)
    turned = Weave.of(POINTS @ turn, TRIANGLES, fabric, 0.03)
    pulled, pushed = (woven.stiffness(scale * FLAT) for scale in (1.01, 0.99))
    assert pulled != pytest.approx(turned.stiffness(1.01 * FLAT), rel=0.1)
    softer = Weave.of(POINTS, TRIANGLES, replace(ALIKE, shear_n_m=30.0, stretch_n_m=60.0), 0.03)
    assert pushed == pytest.approx(softer.stiffness(1.01 * FLAT))
    one_way = woven.stiffness(FLAT * np.array([1.01, 0.99, 1.0]))
    assert one_way != pytest.approx(pulled, rel=0.1)
    assert one_way != pytest.approx(pushed, rel=0.1)
