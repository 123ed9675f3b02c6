"""Carry out the messages that change a document, or how it is shown."""

from dataclasses import replace
from typing import TypeAlias

from app.api import document_messages as messages
from app.api.problems import LookOnlyError
from app.api.request_parsing import requested_garment, requested_start
from app.document import Document, Played
from app.document_state import DocumentState
from app.drawing.arcs import with_arcs
from app.drawing.drawing import Drawing
from app.drawing.drawing_json import drawing_from_dict
from app.drawing.edit import Edit, Phase
from app.drawing.garment_drawing import drawing_of, with_robot
from app.rehearsal.trace import RunTrace
from app.visitors_view import VisitorsView
from app.workspace import Workspace
from planner.cloth.garment import Garment
from planner.errors import FieldError, RequestError
from planner.robots.known_robots import require_name
from planner.robots.load_robot import robot_card_file

Wanted: TypeAlias = (
    messages.Command
    | messages.EditRequest
    | messages.GarmentRequest
    | messages.RobotRequest
    | messages.Undo
    | messages.Redo
)


def dispatch(wanted: Wanted, workspace: Workspace, document: Document) -> DocumentState:
    """Carry out a command or a change; return the state that it has led to.

    Raises:
        StaleVersionError: the change is based on a version that is no longer current.
        FoldingError: it cannot be done.
    """
    if _play(wanted, document):
        return document.state
    match wanted:
        case messages.EditRequest():
            return document.edit(_edit(wanted, document.state.drawing))
        case messages.GarmentRequest():
            garment = requested_garment(workspace, wanted.garment)
            return put_garment(document, garment, wanted.label, wanted.base_version, has_arcs=wanted.arcs)
        case messages.RobotRequest():
            return put_robot(document, wanted.robot, wanted.label, wanted.base_version)
        case messages.Undo():
            return document.undo(wanted.base_version)
        case messages.Redo():
            return document.redo(wanted.base_version)
        case messages.SetTheme(dark=is_dark):
            document.set_theme(is_dark=is_dark)
        case messages.SetLanguage(language=language):
            document.set_language(language)
        case messages.SetEffort(work_s=work_s):
            document.set_effort(work_s)
        case messages.Choose(garment=name):
            put_garment(document, workspace.garments.garment(name))
        case messages.PlanAgain():
            document.plan_again()
        case messages.LookLonger():
            document.look_longer()
        case messages.PlanFrom(step=None):
            document.plan_from(lambda _: None)
        case messages.PlanFrom(step=int(step)):
            document.plan_from(lambda state: state.start_after(step))
        case messages.PlanFromState(start=start):
            document.plan_from(lambda state: state.start_in(lambda task: requested_start(task, start)))
        case messages.Stop():
            document.stop_planning()
        case messages.Preview(plan=plan_id):
            document.preview(None if plan_id is None else workspace.plans.plan(plan_id))
        case messages.ShowTrace(trace=trace_id):
            content = None if trace_id is None else workspace.traces.content(trace_id)
            document.show_trace(None if content is None else RunTrace.unpacked(content))
    return document.state


def play(wanted: Wanted, visitors: VisitorsView) -> None:
    """Carry out a command by a link, for visitors alone; raise `LookOnlyError` if it does more than play."""
    if not _play(wanted, visitors):
        raise LookOnlyError


def _play(wanted: Wanted, played: Played) -> bool:
    """Carry out a command if it is one of playback; return whether it is."""
    match wanted:
        case messages.Play():
            played.play()
        case messages.Pause():
            played.pause()
        case messages.Seek(t_s=t_s):
            played.seek(t_s)
        case messages.SetSpeed(speed=speed):
            played.set_speed(speed)
        case _:
            return False
    return True


def put_garment(
    document: Document,
    garment: Garment,
    label: str | None = None,
    base_version: int | None = None,
    *,
    has_arcs: bool = False,
) -> DocumentState:
    """Put another garment into the scene, as one step, its arcs as curves if asked; raises `StaleVersionError`."""
    now = document.state.drawing
    drawn = drawing_of(garment, now.scene, now.robot)
    drawing = replace(
        with_arcs(drawn) if has_arcs else drawn, start_station=now.start_station, comfort_radius_m=now.comfort_radius_m
    )
    edit = Edit(label or f"Open {garment.title}", drawing, base_version=base_version, gesture="open")
    state = document.edit(edit)
    document.rewind()
    return state


def put_robot(
    document: Document, robot: str, label: str | None = None, base_version: int | None = None
) -> DocumentState:
    """Have another robot fold, with the scene, start and placement that suit it, as one step.

    Raises:
        StaleVersionError: the change is based on a version that is no longer current.
        RequestError: there is no such robot.
    """
    require_name(robot)
    before = document.state
    if before.drawing.robot == robot:
        return before
    past = (step.drawing for step in reversed(before.draft.history.past))
    drawing, title = with_robot(before.solution, robot, past), robot_card_file(robot).title
    base = before.version if base_version is None else base_version
    state = document.edit(Edit(label or f"Fold with {title}", drawing, base_version=base, gesture="robot"))
    document.rewind()
    return state


def _edit(wanted: messages.EditRequest, now: Drawing) -> Edit:
    phase = Phase(wanted.phase)
    if wanted.drawing is None and phase is not Phase.CANCEL:
        raise RequestError("drawing", "is missing")
    try:
        drawing = None if wanted.drawing is None else drawing_from_dict(wanted.drawing)
        if drawing is not None and drawing.robot != now.robot:
            require_name(drawing.robot)
    except FieldError as error:
        raise error.within("drawing") from None
    return Edit(wanted.label, drawing, phase, wanted.base_version, wanted.coalesce, wanted.gesture)
