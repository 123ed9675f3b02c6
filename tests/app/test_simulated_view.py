"""The cloth of a rehearsed run in the 3D view: beside the plan, shaded where it is off it."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from app.document import Document
from app.drawing.draft import draft_of
from app.drawing.garment_drawing import drawing_of
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.trace import ClothAfter, RunTrace, rounded, traced
from app.rehearsal.world import Truth
from app.ui.view_3d import View3D
from planner import Plan, Scene, load_garment
from planner.geometry.woven_mesh import woven_mesh
from planner.motion.timeline import Timeline
from planner.robots.load_robot import load_robot
from tests.replay.planned import shipped_plan

SLID_M = 0.03


@pytest.fixture(scope="module")
def view() -> Iterator[View3D]:
    made = View3D(load_robot("pr2").card, Scene())
    yield made
    made.close()


@pytest.fixture(scope="module")
def plan() -> Plan:
    return shipped_plan("t-shirt")


@pytest.fixture(scope="module")
def trace(plan: Plan) -> RunTrace:
    """Return a run in which the cloth lies as planned after the first fold, half of it beside that after the last."""
    pattern, triangles = woven_mesh(plan.garment.pattern, 0.04, 1)
    folds = [number for number, step in enumerate(plan.steps) if step.fold is not None and not step.after.held]
    cloths = []
    for number in (folds[0], folds[-1]):
        after = plan.steps[number].after
        lies = planned_positions(plan.sequence, pattern, after.done, after.placement, plan.scene.table, 0.002)
        lies[pattern[:, 0] > np.median(pattern[:, 0]), 0] += 0.0 if number == folds[0] else SLID_M
        cloths.append(ClothAfter(number, lies))
    flat = planned_positions(plan.sequence, pattern, 0, plan.task.start.placement, plan.scene.table, 0.002)
    return traced(plan, Truth(pattern, flat, triangles), [(0.0, rounded(flat))], tuple(cloths), [])


def parts(view: View3D) -> list[Any]:
    return [view.server.scene.get_handle_by_name(f"/simulated/{name}") for name in ("near", "off")]


def test_cloth_that_is_off_its_plan_is_shaded_once_it_lies(view: View3D, plan: Plan, trace: RunTrace) -> None:
    line = Timeline.of(plan)
    first, last = (plan.steps[step.of_plan] for step in trace.steps)
    view.show_plan(plan)
    view.show(line.at(first.end_s), trace)
    near, off = parts(view)
    assert (near.visible, off.visible) == (True, False)
    assert len(near.faces) == len(trace.triangles)
    view.show(line.at(last.end_s), trace)
    assert (near.visible, off.visible) == (True, True)
    assert len(near.faces) + len(off.faces) == len(trace.triangles)
    assert len(off.faces) == pytest.approx(len(trace.triangles) / 2, rel=0.1)
    view.show(line.at(last.end_s - 0.5 * last.duration_s), trace)
    assert not off.visible, "while the plan moves the cloth there is nothing to compare with"
    view.show(line.at(last.end_s))
    assert (near.visible, off.visible) == (False, False)


def test_another_plan_has_no_run_yet(view: View3D, plan: Plan, trace: RunTrace) -> None:
    view.show_plan(plan)
    view.show(Timeline.of(plan).at(0.0), trace)
    assert parts(view)[0].visible
    view.show_plan(plan)
    assert not parts(view)[0].visible


def shown_run(document: Document) -> RunTrace | None:
    return document.state.trace


def test_a_run_is_shown_along_with_its_plan_alone(plan: Plan, trace: RunTrace) -> None:
    document = Document(draft_of(drawing_of(load_garment("t-shirt"))))
    document.show_trace(trace)
    assert shown_run(document) is None
    task = document.state.task
    assert task is not None
    document.settle(1, task, plan, "first")
    document.show_trace(trace)
    assert shown_run(document) is trace
    document.plan_from(lambda state: state.start_after(0))
    assert shown_run(document) is None
    document.plan_from(lambda _: None)
    document.settle(1, task, replace(plan), "again")
    assert shown_run(document) is None
    document.show_trace(trace)
    document.show_trace(None)
    assert shown_run(document) is None
