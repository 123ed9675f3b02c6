"""The cloth of a rehearsed run in the 3D view: in its own tone over the planned cloth, shaded where it is off it."""

import numpy as np
import viser
from numpy.typing import NDArray

from app.rehearsal.judge import Gate
from app.rehearsal.trace import UNIT_M, RunTrace
from app.ui.colours import Palette
from app.ui.lighting import paint
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.task.plan import PlanStep

ROOT = "/simulated"

_OPACITY = 0.65
_OFF_M = Gate().mean_mm / 1000.0
"""The distance from where it is planned from which cloth is shaded (m): the mean error up to which a step holds."""

_ABOVE = np.array([0.0, 0.0, 0.003])
"""How much higher it is drawn (m), so that planned cloth at the same place does not hide it."""

_NO_POINTS = np.zeros((3, 3))
_NO_TRIANGLES = np.zeros((1, 3), dtype=np.int64)


class SimulatedView:
    """Shows the cloth of one run at a time: nodes ``near`` and ``off``, triangles near to their plan and off it."""

    def __init__(self, scene: viser.SceneApi) -> None:
        """Build the nodes, without cloth at first."""
        self._near, self._off = (
            scene.add_mesh_simple(
                f"{ROOT}/{name}",
                _NO_POINTS,
                _NO_TRIANGLES,
                side="double",
                opacity=_OPACITY,
                cast_shadow=False,
                visible=False,
            )
            for name in ("near", "off")
        )
        self._shown: tuple[RunTrace, FloatArray, int | None] | None = None

    def recolour(self, palette: Palette) -> None:
        """Change to other colours."""
        self._near.color, self._off.color = paint(palette.cloth_simulated), paint(palette.cloth_off)

    def show(self, trace: RunTrace | None, steps: tuple[PlanStep, ...], t_s: float) -> None:
        """Show a run at a time of its plan (s); None shows none.

        It is compared with the plan where this has the cloth lie still after a step that was judged.
        """
        if trace is None or not len(trace.frames):
            self._near.visible = self._off.visible = False
            self._shown = None
            return
        positions, step = trace.at(t_s), _lying_after(trace, steps, t_s)
        shown, self._shown = self._shown, (trace, positions, step)
        if shown is not None and (shown[0], shown[2]) == (trace, step) and np.array_equal(shown[1], positions):
            return
        is_off = _is_off(trace, positions, step)
        for mesh, triangles in ((self._near, trace.triangles[~is_off]), (self._off, trace.triangles[is_off])):
            mesh.visible = len(triangles) > 0
            if len(triangles):
                mesh.vertices = (positions + _ABOVE).astype(np.float32)
                mesh.faces = triangles.astype(np.uint32)


def _lying_after(trace: RunTrace, steps: tuple[PlanStep, ...], t_s: float) -> int | None:
    """Return the number of the judged step after which the plan has the cloth lie as at a time; None if it moves."""
    begun = next((number for number, step in enumerate(steps) if step.grips and step.end_s > t_s + TIME_S), len(steps))
    if begun < len(steps) and steps[begun].start_s < t_s - TIME_S:
        return None
    judged = {step.of_plan: number for number, step in enumerate(trace.steps)}
    moved = [number for number in range(begun) if steps[number].grips]
    return judged.get(moved[-1]) if moved else None


def _is_off(trace: RunTrace, positions: FloatArray, step: int | None) -> NDArray[np.bool_]:
    """Return which triangles are off their plan, shape (m,)."""
    if step is None:
        return np.zeros(len(trace.triangles), dtype=np.bool_)
    apart = np.linalg.norm(positions - UNIT_M * trace.steps[step].planned, axis=1)
    return np.asarray(apart[trace.triangles].mean(axis=1) > _OFF_M)
