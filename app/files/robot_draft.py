"""A robot drafted of a file that its maker gives out."""

import json
import re
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from zipfile import ZipFile

from app.files.robot_description import robot_description
from planner.errors import RobotError
from planner.robots.drafting.draft import Draft, draft_robot
from planner.robots.own_robots import CARD

ENDINGS = (".urdf", ".xacro", ".xml", ".zip")
"""Endings of the files that are read."""


def drafted(file: Path, title: str, folder: Path, *, may_expand: bool = True) -> Draft:
    """Write the card that a robot's description lets guess, with its URDF and its meshes, into an empty folder.

    Args:
        file: a URDF, xacro, MuJoCo's XML, or a zip archive of one with its meshes.
        title: the robot's name for people; its name is made of it.
        folder: the folder.
        may_expand: whether xacro is expanded, which does what the file says.

    Raises:
        RobotError: the file is no description of a robot, or of none with an arm that ends in a gripper.
        OSError: the system refuses to read or write.
    """
    with TemporaryDirectory() as scratch:
        source = robot_description(file, Path(scratch), may_expand=may_expand)
        draft = draft_robot(source, _robot_name(title), title, folder)
    (folder / CARD).write_text(json.dumps(draft.card.to_dict(), indent=2) + "\n", encoding="utf-8")
    return draft


def drafted_alone(filename: str, data: bytes, folder: Path) -> Draft:
    """Draft a robot, as `drafted` does, of another machine's file: what is beside it here is not read, nor expanded."""
    name = PurePath(filename).name
    if not name.lower().endswith(ENDINGS):
        raise RobotError("filename", f"expected one that ends in {', '.join(ENDINGS)}; got {name[:80]!r}")
    with TemporaryDirectory() as scratch:
        packed = Path(scratch, "robot.zip")
        if name.lower().endswith(".zip"):
            packed.write_bytes(data)
        else:
            with ZipFile(packed, "w") as archive:
                archive.writestr(name, data)
        return drafted(packed, name.partition(".")[0] or "robot", folder, may_expand=False)


def _robot_name(title: str) -> str:
    """Return a name that a card may have."""
    return re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-")[:64] or "robot"
