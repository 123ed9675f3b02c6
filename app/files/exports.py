"""All exports of a document: the kinds of file, and how each is made.

How a file is made is imported when it is made: a list of the kinds takes none of it.
"""

from __future__ import annotations

import json
from importlib import import_module
from typing import TYPE_CHECKING, Any

from app.files.export import Export, Make, as_drawn, garment_in, no_answer, no_outline, no_plan, not_legal, plan_in

if TYPE_CHECKING:
    from app.document_state import DocumentState
    from app.jobs.job_pool import ShouldStop


def find_export(what: str) -> Export | None:
    """Return the export with a name, in which a dash is as good as a dot; None if there is none."""
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

    return recording(plan_in(state), rate_hz, should_stop, is_dark=state.is_dark)


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


def _of_plan(module: str, function: str, *, may_stop: bool = False) -> Make:
    """Return what makes a file of a plan alone: a function of a module of `app.files`, which may be told to stop."""

    def make(state: DocumentState, _: float, should_stop: ShouldStop) -> bytes:
        told = (plan_in(state), should_stop) if may_stop else (plan_in(state),)
        made: bytes = getattr(import_module(f"app.files.{module}"), function)(*told)
        return made

    return make


EXPORTS = (
    Export("garment.json", ".json", "application/json", no_outline, _garment_json),
    Export("garment.svg", ".svg", "image/svg+xml", no_outline, _garment_svg),
    Export("garment.fold", ".fold", "application/json", not_legal, _garment_fold),
    Export("plan.json", ".plan.json", "application/json", no_answer, _plan_json),
    Export("plan.csv", "-plan.csv", "text/csv; charset=utf-8", no_plan, _plan_csv, group="robot"),
    Export("sheet.pdf", "-steps.pdf", "application/pdf", no_plan, _sheet_pdf, group="look", needs=("matplotlib",)),
    Export("sheet.svg", "-steps.svg", "image/svg+xml", no_plan, _sheet_svg, group="look"),
    Export("recording.html", ".html", "text/html; charset=utf-8", no_plan, _recording, group="look", is_slow=True),
    Export("mp4", ".mp4", "video/mp4", no_plan, _mp4, group="look", is_slow=True, needs=("matplotlib", "av")),
    Export("gif", ".gif", "image/gif", no_plan, _gif, group="look", is_slow=True, needs=("matplotlib",)),
    Export("picture.png", ".png", "image/png", no_plan, _picture, group="look", is_slow=True, needs=("matplotlib",)),
    Export(
        "mcap",
        ".mcap",
        "application/octet-stream",
        no_plan,
        _of_plan("ros_bag", "mcap_file"),
        group="robot",
        is_slow=True,
        needs=("rosbags",),
    ),
    Export(
        "rosbag2",
        "-rosbag2.zip",
        "application/zip",
        no_plan,
        _of_plan("ros_bag", "rosbag2_folder"),
        group="robot",
        is_slow=True,
        is_folder=True,
        needs=("rosbags",),
    ),
    Export(
        "poses.json", "-poses.json", "application/json", no_plan, _of_plan("grasp_poses", "poses_json"), group="robot"
    ),
    Export(
        "poses.yaml",
        "-poses.yaml",
        "application/yaml",
        no_plan,
        _of_plan("grasp_poses", "poses_yaml"),
        group="robot",
        needs=("ruamel",),
    ),
    Export(
        "glb",
        ".glb",
        "model/gltf-binary",
        no_plan,
        _of_plan("gltf_animation", "animation_glb", may_stop=True),
        group="look",
        is_slow=True,
    ),
    Export(
        "mjcf",
        "-mjcf.zip",
        "application/zip",
        no_plan,
        _of_plan("mujoco_scene", "mujoco_scene"),
        group="robot",
        is_slow=True,
        is_folder=True,
    ),
    Export(
        "usd",
        ".usd",
        "model/vnd.usd",
        no_plan,
        _of_plan("usd_scene", "usd_scene", may_stop=True),
        group="robot",
        is_slow=True,
        needs=("pxr",),
    ),
    Export(
        "lerobot",
        "-lerobot.zip",
        "application/zip",
        no_plan,
        _of_plan("lerobot_dataset", "lerobot_folder"),
        group="robot",
        is_slow=True,
        is_folder=True,
        needs=("pyarrow",),
    ),
)
"""All exports, in the order shown."""
