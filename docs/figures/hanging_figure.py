"""The big towel from the side: dragged beyond the table's edge, held out there, and brought back by a fold."""

from docs.figures.drawing import FAINT, INK, NONE, RED, TABLE, Drawing, Style, View
from planner import load_garment, make_plan
from planner.geometry.pose import Point2
from planner.task.plan import Plan
from planner.task.world_state import Grip, WorldState

_SCALE = 152.0
_PANEL_PX, _FIRST_PX, _HEIGHT_PX = 296.0, 152.0, 110.0
_LAYER_PX = 5.0
_FAR_M = 0.62
_MIDDLE_M = -0.28
_FACES = {"front": "#c9b48a", "back": "#8fa6c2"}


def draw() -> Drawing:
    """The towel at the start, and after each of the plan's first two primitives, with the way of a hand."""
    sheet = Drawing(900, 220, "A big towel dragged beyond the table's edge and folded from there, from the side")
    plan = make_plan(load_garment("big-towel"), time_limit_s=60.0)
    drag, fold = plan.steps[:2]
    _panel(sheet, plan, 0, plan.task.start, ())
    _caption(sheet, 0, "At the start")
    _panel(sheet, plan, 1, drag.after, drag.grips[:1])
    _caption(sheet, 1, f"Dragged by {drag.details['distance_m']:g} m and held out")
    _panel(sheet, plan, 2, fold.after, fold.grips[:1])
    _caption(sheet, 2, f"Brought back: {plan.garment.folds[fold.details['fold']].name}")
    return sheet


def _panel(sheet: Drawing, plan: Plan, number: int, state: WorldState, grips: tuple[Grip, ...]) -> None:
    view = sheet.view((_FIRST_PX + _PANEL_PX * number, _HEIGHT_PX), _SCALE, (_MIDDLE_M, 0.0))
    edge = -plan.scene.table.depth_m / 2
    view.polygon("table", ((edge, 0), (_FAR_M, 0), (_FAR_M, -0.04), (edge, -0.04)), Style(NONE, TABLE))
    layers = plan.sequence.cloth(state.done).layers
    for level, (layer, (low, high)) in enumerate(zip(layers, _profile(plan, state), strict=True)):
        height = (level + 0.5) * _LAYER_PX / _SCALE
        view.line("layer", ((low, height), (high, height)), Style(_FACES[layer.face], width=_LAYER_PX - 1.0))
    depth = edge - min(low for low, _ in _profile(plan, state))
    if depth > 0.0:
        _let_go(view, edge, depth)
    for grip in grips:
        _way(view, grip)


def _let_go(view: View, edge: float, depth: float) -> None:
    """Where what is held out would hang."""
    view.line("would-hang", ((edge, 0.0), (edge, -depth)), Style(FAINT, width=2.0, dash="3 3"))
    view.text((edge, -depth), f"let go, {depth:.2f} m would hang", shift=(8, 0), size=12)


def _caption(sheet: Drawing, number: int, words: str) -> None:
    sheet.text((_FIRST_PX + _PANEL_PX * number, 205), words, anchor="middle")


def _way(view: View, grip: Grip) -> None:
    """From where a hand takes the cloth, or holds it, to where the primitive leaves it."""
    places = [grip.pick, *([] if grip.apex is None else [grip.apex]), grip.place]
    view.line("way", [_side(place) for place in places], Style(RED, width=1.8, dash="5 3"), arrow=True)
    view.dot("grip", _side(grip.pick), 4.0, Style(INK, INK))


def _side(place: tuple[float, float, float]) -> Point2:
    return (place[0], place[2])


def _profile(plan: Plan, state: WorldState) -> list[tuple[float, float]]:
    """From where to where each layer reaches along the table's x (m), bottom to top."""
    layers = plan.sequence.cloth(state.done).layers
    xs = [state.placement.to_outer(layer.region.ring)[:, 0] for layer in layers]
    return [(float(x.min()), float(x.max())) for x in xs]
