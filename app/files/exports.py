"""All exports of a document: the kinds of file, and how each is made.

How a file is made is imported when it is made: a list of the kinds takes none of it.
"""

from __future__ import annotations

import json
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

from app.files.export import Export, Make, as_drawn, garment_in, no_answer, no_outline, no_plan, not_legal, plan_in

if TYPE_CHECKING:
    from app.document_state import DocumentState
    from planner.deadline import ShouldStop


def find_export(what: str) -> Export | None:
    """Return the export with a name, in which a dash may stand for a dot; None if there is none."""
    return next((export for export in EXPORTS if export.what == what.replace("-", ".")), None)


def _json(data: Any) -> bytes:  # noqa: ANN401
    return (json.dumps(data, indent=1) + "\n").encode("ascii")


def _garment_json(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    return _json(as_drawn(state).to_dict())


def _garment_svg(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    from app.files.svg_drawing import svg_drawing

    return svg_drawing(as_drawn(state), state.drawing.outline).encode("utf-8", "replace")


def _garment_fold(state: DocumentState, _: float, should_stop: ShouldStop) -> bytes:
    from app.files.fold_format import fold_format

    return _json(fold_format(garment_in(state), state.solution.cloths, should_stop))


def _plan_json(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    return (json.dumps(plan_in(state).to_dict()) + "\n").encode("ascii")


def _plan_csv(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    from app.files.plan_table import plan_table

    return plan_table(plan_in(state)).encode("utf-8", "replace")


def _recording(state: DocumentState, rate_hz: float, should_stop: ShouldStop) -> bytes:
    from app.files.recording import recording

    return recording(plan_in(state), rate_hz, should_stop, state.language, is_dark=state.is_dark)


def _mp4(state: DocumentState, rate_hz: float, should_stop: ShouldStop) -> bytes:
    from app.files.film import mp4_film

    return mp4_film(plan_in(state), rate_hz, should_stop, state.language, is_dark=state.is_dark)


def _gif(state: DocumentState, rate_hz: float, should_stop: ShouldStop) -> bytes:
    from app.files.film import gif_film

    return gif_film(plan_in(state), rate_hz, should_stop, state.language, is_dark=state.is_dark)


def _picture(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    from app.files.film import still

    return still(plan_in(state), state.language, is_dark=state.is_dark)


def _sheet_pdf(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    from app.files.instruction_sheet import instruction_sheet
    from app.files.sheet_pdf import page_pdf

    return page_pdf(instruction_sheet(plan_in(state), state.language))


def _sheet_svg(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    from app.files.instruction_sheet import instruction_sheet
    from app.files.sheet_page import page_svg

    return page_svg(instruction_sheet(plan_in(state), state.language))


def _of_plan(name: str, *, may_stop: bool = False) -> Make:
    """Return the maker of a file that needs only the plan, given a function's module in `app.files` and its name."""
    module, _, function = name.partition(".")

    def make(state: DocumentState, _: float, should_stop: ShouldStop) -> bytes:
        arguments = (plan_in(state), should_stop) if may_stop else (plan_in(state),)
        made: bytes = getattr(import_module(f"app.files.{module}"), function)(*arguments)
        return made

    return make


_to_look_at = partial(Export, why_not=no_plan, group="look")
_for_robots = partial(Export, why_not=no_plan, group="robot")
_HTML, _ZIP, _BYTES = "text/html; charset=utf-8", "application/zip", "application/octet-stream"
_PICTURES = ("matplotlib",)

EXPORTS = (
    Export("garment.json", ".json", "application/json", no_outline, _garment_json),
    Export("garment.svg", ".svg", "image/svg+xml", no_outline, _garment_svg),
    Export("garment.fold", ".fold", "application/json", not_legal, _garment_fold),
    Export("plan.json", ".plan.json", "application/json", no_answer, _plan_json),
    _for_robots("plan.csv", "-plan.csv", "text/csv; charset=utf-8", make=_plan_csv),
    _to_look_at("sheet.pdf", "-steps.pdf", "application/pdf", make=_sheet_pdf, needs=_PICTURES),
    _to_look_at("sheet.svg", "-steps.svg", "image/svg+xml", make=_sheet_svg),
    _to_look_at("recording.html", ".html", _HTML, make=_recording, is_slow=True),
    _to_look_at("mp4", ".mp4", "video/mp4", make=_mp4, is_slow=True, needs=(*_PICTURES, "av")),
    _to_look_at("gif", ".gif", "image/gif", make=_gif, is_slow=True, needs=_PICTURES),
    _to_look_at("picture.png", ".png", "image/png", make=_picture, is_slow=True, needs=_PICTURES),
    _for_robots("mcap", ".mcap", _BYTES, make=_of_plan("ros_bag.mcap_file"), is_slow=True, needs=("rosbags",)),
    _for_robots(
        "rosbag2",
        "-rosbag2.zip",
        _ZIP,
        make=_of_plan("ros_bag.rosbag2_folder"),
        is_slow=True,
        is_folder=True,
        needs=("rosbags",),
    ),
    _for_robots("poses.json", "-poses.json", "application/json", make=_of_plan("grasp_poses.poses_json")),
    _for_robots(
        "poses.yaml", "-poses.yaml", "application/yaml", make=_of_plan("grasp_poses.poses_yaml"), needs=("ruamel",)
    ),
    _to_look_at(
        "glb", ".glb", "model/gltf-binary", make=_of_plan("gltf_animation.animation_glb", may_stop=True), is_slow=True
    ),
    _for_robots("mjcf", "-mjcf.zip", _ZIP, make=_of_plan("mujoco_scene.mujoco_scene"), is_slow=True, is_folder=True),
    _for_robots(
        "usd",
        ".usd",
        "model/vnd.usd",
        make=_of_plan("usd_scene.usd_scene", may_stop=True),
        is_slow=True,
        needs=("pxr",),
    ),
    _for_robots(
        "lerobot",
        "-lerobot.zip",
        _ZIP,
        make=_of_plan("lerobot_dataset.lerobot_folder"),
        is_slow=True,
        is_folder=True,
        needs=("pyarrow",),
    ),
)
"""All exports, in the order shown."""
