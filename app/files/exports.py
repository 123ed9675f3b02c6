"""All exports of a document: the kinds of file, and how each is made.

How a file is made is imported when it is made: a list of the kinds takes none of it.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from app.files.export import Export, as_drawn, garment_in, no_answer, no_outline, no_plan, not_legal, plan_in

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
    from app.files.sheet_svg import page_svg

    return page_svg(instruction_sheet(plan_in(state), state.language))


def _poses_json(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    from app.files.grasp_poses import poses_json

    return poses_json(plan_in(state))


def _poses_yaml(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    from app.files.grasp_poses import poses_yaml

    return poses_yaml(plan_in(state))


def _mcap(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    from app.files.ros_bag import mcap_file

    return mcap_file(plan_in(state))


def _rosbag2(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    from app.files.ros_bag import rosbag2_folder

    return rosbag2_folder(plan_in(state))


def _glb(state: DocumentState, _: float, should_stop: ShouldStop) -> bytes:
    from app.files.gltf_animation import animation_glb

    return animation_glb(plan_in(state), should_stop)


def _mjcf(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    from app.files.mujoco_scene import mujoco_scene

    return mujoco_scene(plan_in(state))


def _usd(state: DocumentState, _: float, should_stop: ShouldStop) -> bytes:
    from app.files.usd_scene import usd_scene

    return usd_scene(plan_in(state), should_stop)


def _lerobot(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    from app.files.lerobot_dataset import lerobot_folder

    return lerobot_folder(plan_in(state))


EXPORTS = (
    Export(
        "garment.json",
        "Garment (JSON)",
        "Outline, folds and placement; Pleat opens it again.",
        ".json",
        "application/json",
        no_outline,
        _garment_json,
    ),
    Export(
        "garment.svg",
        "Drawing (SVG)",
        "The outline and the fold lines in centimetres, for any drawing program; Pleat reads it again.",
        ".svg",
        "image/svg+xml",
        no_outline,
        _garment_svg,
    ),
    Export(
        "garment.fold",
        "Folding (FOLD)",
        "The crease pattern and the cloth after each fold, for origami programs.",
        ".fold",
        "application/json",
        not_legal,
        _garment_fold,
    ),
    Export(
        "plan.json",
        "Plan (JSON)",
        "What was asked, what the robot does at every moment, or why it cannot; Pleat reads it again.",
        ".plan.json",
        "application/json",
        no_answer,
        _plan_json,
    ),
    Export(
        "plan.csv",
        "Plan (CSV)",
        "A row for each step: times, the base, and each hand's points as table and base see them.",
        "-plan.csv",
        "text/csv; charset=utf-8",
        no_plan,
        _plan_csv,
        group="robot",
    ),
    Export(
        "sheet.pdf",
        "Instruction sheet (PDF)",
        "The steps on one page to print: a numbered picture each, where the hands go, and from where.",
        "-steps.pdf",
        "application/pdf",
        no_plan,
        _sheet_pdf,
        group="look",
        needs=("matplotlib",),
    ),
    Export(
        "sheet.svg",
        "Instruction sheet (SVG)",
        "The same page for any drawing program.",
        "-steps.svg",
        "image/svg+xml",
        no_plan,
        _sheet_svg,
        group="look",
    ),
    Export(
        "recording.html",
        "Recording (HTML)",
        "The animation in one file that plays in any browser, without a server.",
        ".html",
        "text/html; charset=utf-8",
        no_plan,
        _recording,
        group="look",
        is_slow=True,
    ),
    Export(
        "mp4",
        "Film (MP4)",
        "The animation with title and captions as a video, painted without a browser.",
        ".mp4",
        "video/mp4",
        no_plan,
        _mp4,
        group="look",
        is_slow=True,
        needs=("matplotlib", "av"),
    ),
    Export(
        "gif",
        "Film (GIF)",
        "The same in small as a GIF, for pages and messages.",
        ".gif",
        "image/gif",
        no_plan,
        _gif,
        group="look",
        is_slow=True,
        needs=("matplotlib",),
    ),
    Export(
        "picture.png",
        "Picture (PNG)",
        "Robot and cloth in the middle of the last fold, with title, time and the packet's size.",
        ".png",
        "image/png",
        no_plan,
        _picture,
        group="look",
        is_slow=True,
        needs=("matplotlib",),
    ),
    Export(
        "mcap",
        "Robot motion (ROS 2, MCAP)",
        "A joint trajectory for each step and controller, its speeds and accelerations bounded; opens in Foxglove.",
        ".mcap",
        "application/octet-stream",
        no_plan,
        _mcap,
        group="robot",
        is_slow=True,
        needs=("rosbags",),
    ),
    Export(
        "rosbag2",
        "Robot motion (ROS 2 bag)",
        "The same messages as a folder for ros2 bag play.",
        "-rosbag2.zip",
        "application/zip",
        no_plan,
        _rosbag2,
        group="robot",
        is_slow=True,
        is_folder=True,
        needs=("rosbags",),
    ),
    Export(
        "poses.json",
        "Pick and place poses (JSON)",
        "Position and quaternion of each grip before, at and after grasp and release, in the frames of base and table.",
        "-poses.json",
        "application/json",
        no_plan,
        _poses_json,
        group="robot",
    ),
    Export(
        "poses.yaml",
        "Pick and place poses (YAML)",
        "The same poses as YAML.",
        "-poses.yaml",
        "application/yaml",
        no_plan,
        _poses_yaml,
        group="robot",
        needs=("ruamel",),
    ),
    Export(
        "glb",
        "Animation (glTF)",
        "Robot, table and cloth in motion, for any viewer of 3-D models.",
        ".glb",
        "model/gltf-binary",
        no_plan,
        _glb,
        group="look",
        is_slow=True,
    ),
    Export(
        "mjcf",
        "Scene (MuJoCo)",
        "Robot, table and cloth as MuJoCo's XML, and the joints over time beside it, for simulations of your own.",
        "-mjcf.zip",
        "application/zip",
        no_plan,
        _mjcf,
        group="robot",
        is_slow=True,
        is_folder=True,
    ),
    Export(
        "usd",
        "Animation (USD)",
        "Robot, table and cloth in motion, the cloth one mesh whose points move, for Isaac Sim, Omniverse and Blender.",
        ".usd",
        "model/vnd.usd",
        no_plan,
        _usd,
        group="robot",
        is_slow=True,
        needs=("pxr",),
    ),
    Export(
        "lerobot",
        "Episode (LeRobot)",
        "States and actions at 30 frames a second as a LeRobot 3.0 dataset, for learning from demonstrations.",
        "-lerobot.zip",
        "application/zip",
        no_plan,
        _lerobot,
        group="robot",
        is_slow=True,
        is_folder=True,
        needs=("pyarrow",),
    ),
)
"""All exports, in the order shown."""
