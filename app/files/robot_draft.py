"""A robot drafted of a file that its maker gives out."""

import json
import re
from collections.abc import Iterable
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from typing import Any
from zipfile import ZipFile

from app.distribution import missing
from app.files.mjcf import urdf_of_mjcf
from app.files.robot_archive import unpack_archive
from planner.errors import RobotError
from planner.robots.drafting.draft import Draft, draft_robot
from planner.robots.own_robots import CARD
from planner.robots.urdf_shapes import Source

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


_XACRO = ".xacro"

_MACROS = re.compile(r"<xacro:(?!arg|property)|\$[({]")
"""What a URDF that needs no expansion does not have."""

_LEVELS = 4
"""How many folders above a description its packages and meshes are looked for."""

_MESH = re.compile(r"""(<mesh\s[^>]*?\bfilename=)("[^"]*"|'[^']*')""")
"""A mesh and its file's name; plugins and textures have files too, which nothing here needs."""


def robot_description(path: Path, folder: Path, *, may_expand: bool = True) -> Source:
    """Return the URDF in a file, which may be an archive or xacro.

    Args:
        path: the file.
        folder: an empty folder for what is unpacked or expanded.
        may_expand: whether xacro is expanded, which does what the file says.

    Raises:
        RobotError: it is no description of a robot, or one that has to be expanded or converted first.
        OSError: the system refuses to read or write.
    """
    path = path.resolve()
    if path.suffix.lower() == ".zip":
        unpack_archive(path.read_bytes(), folder / "unpacked")
        path = _only_description(folder / "unpacked")
    above = [one for one in list(path.parents)[:_LEVELS] if one != Path(one.anchor)]
    tops = [one for one in above if one.is_relative_to(folder / "unpacked")] or above
    text = path.read_text(encoding="utf-8", errors="replace")
    is_xacro = path.suffix == _XACRO or _MACROS.search(text) is not None
    if is_xacro and not may_expand:
        raise RobotError("file", f"{path.name} has to be expanded by xacro first; `pleat robot draft` does so")
    text = _expanded(path, tops) if is_xacro else text
    if re.search(r"<mujoco[\s>]", text):
        return Source(urdf_of_mjcf(path, folder), folder)
    root = _root(path.parent, tops, [name.strip("\"'") for _, name in _MESH.findall(text)])
    if not is_xacro:
        return Source(path, root)
    urdf = folder / f"{path.name.removesuffix(_XACRO).removesuffix('.urdf')}.urdf"
    urdf.write_text(_MESH.sub(lambda found: found[1] + _below(root, path.parent, found[2]), text), encoding="utf-8")
    return Source(urdf, root)


def _only_description(folder: Path) -> Path:
    """Return the URDF in a folder, or the xacro where there is none; raise `RobotError` unless there is one."""
    for ending in (".urdf", ".urdf.xacro", _XACRO, ".xml"):
        found = [one for one in sorted(folder.rglob(f"*{ending}")) if one.name != "package.xml"]
        if len(found) == 1:
            return found[0]
        if found:
            names = ", ".join(str(one.relative_to(folder)) for one in found[:5])
            raise RobotError("file", f"has {len(found)} descriptions of robots, not one: {names}")
    raise RobotError("file", "has no .urdf and no .xacro in it")


def _root(beside: Path, tops: Iterable[Path], names: list[str]) -> Path:
    """Return the nearest folder that has all meshes below it as a robot's folder has them; else that of the URDF."""

    def has(top: Path, name: str) -> bool:
        scheme, _, rest = name.rpartition("://")
        inner = Path(rest.lstrip("/"))
        tries = (top / inner, top.joinpath(*inner.parts[1:])) if scheme == "package" else (beside / rest,)
        return any(one.is_file() and one.resolve().is_relative_to(top) for one in tries)

    return next((top for top in tops if all(has(top, name) for name in names)), beside)


def _below(root: Path, beside: Path, quoted: str) -> str:
    """Return the name of a mesh as one below the robot's folder: xacro writes paths of this machine."""
    quote, name = quoted[0], quoted[1:-1]
    scheme, _, rest = name.rpartition("://")
    path = (beside / rest).resolve()
    is_below = scheme in ("", "file") and path.is_relative_to(root)
    return f"{quote}package://{path.relative_to(root).as_posix()}{quote}" if is_below else quoted


def _expanded(path: Path, tops: Iterable[Path]) -> str:
    """Return what xacro makes of a file; packages are looked for above it."""
    if (lacking := missing("xacro")) is not None:
        raise RobotError("file", f"{path.name} must be expanded by xacro. {lacking.text}")
    import xacro
    from xacro import substitution_args

    folders = list(tops)

    def find(package: str) -> str:
        for top in folders:
            for one in (top, top / package):
                if one.name == package and one.is_dir():
                    return str(one)
        raise RobotError("file", f"{path.name}: the package {package!r} is in none of the folders above it")

    asked: Any = substitution_args
    asked._eval_find = find  # its own asks an installation of ROS
    asked._eval_dict["find"] = find
    try:
        return str(xacro.process_file(str(path)).toxml())
    except RobotError:
        raise
    except Exception as error:  # xacro evaluates what the file says, which may raise anything
        causes = [str(one) for one in (error, getattr(error, "exc", None)) if one is not None and str(one)]
        raise RobotError("file", f"{path.name} cannot be expanded: {causes[0] if causes else error!r}") from None
