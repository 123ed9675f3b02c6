"""Records a plan as one HTML file that plays in any browser, without a server or a network.

The recording uses a 3D view of its own, so that those on show are not disturbed. viser keeps the messages that it
would have sent to a browser, with their times, and embeds them in its client.
"""

from app.language import Language, translated
from app.step_kinds import step_caption
from app.ui.view_3d import View3D
from app.ui.viser_patches import recording_page
from app.ui.withdrawal import withdrawn
from planner.deadline import ShouldStop
from planner.motion.timeline import Timeline
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan

HOLD_S = 2.0
"""Time that the last frame stays before the player starts again (s)."""


def recording(plan: Plan, rate_hz: float, should_stop: ShouldStop, language: Language, *, is_dark: bool) -> bytes:
    """Return a solved plan as an HTML file; empty if stopped before the end.

    Args:
        plan: the plan.
        rate_hz: the frame rate, within `app.files.export.RATES_HZ`.
        should_stop: called before each frame.
        language: the language of the title and the captions.
        is_dark: whether the background is dark.

    Raises:
        UnsolvedPlanError: the plan is not solved, so there is nothing to play.
    """
    timeline = Timeline.of(plan)
    card = load_robot(plan.task.robot).card
    view = View3D(card, plan.scene)
    try:
        view.set_theme(is_dark=is_dark)
        view.show_plan(plan)
        view.show(timeline.at(0.0))
        recorder = view.record()
        before_s = 0.0
        for frame in timeline.samples(rate_hz):
            if should_stop():
                return b""
            recorder.insert_sleep(frame.t_s - before_s)
            view.show(frame)
            view.caption(step_caption(plan, frame.primitive, language))
            before_s = frame.t_s
        for count in range(1, round(HOLD_S * rate_hz) + 1):
            recorder.insert_sleep(1.0 / rate_hz)
            view.show(withdrawn(card, frame, count / rate_hz))
        page = recorder.as_html(dark_mode=is_dark)
    finally:
        view.close()
    return recording_page(page, translated(language, plan.garment.title)).encode("utf-8", "replace")
