"""A tiny robot made of boxes, and archives of it."""

import io
import zipfile
from collections.abc import Mapping
from typing import TypeVar

from planner.robots.known_robots import shipped_card

Name = TypeVar("Name", bound=str | zipfile.ZipInfo)

_LINK = """<link name="{name}"><visual><geometry>{shape}</geometry></visual>
  <collision><geometry>{shape}</geometry></collision></link>"""

_JOINT = """<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>
  <origin xyz="{xyz}"/><axis xyz="{axis}"/><limit lower="{lower}" upper="2.5" velocity="2.0" effort="1"/></joint>"""

_JOINTS = (
    ("shoulder_pan", "0 0 0.1", "0 0 1"),
    ("shoulder_lift", "0 0 0.05", "0 1 0"),
    ("elbow_flex", "0.15 0 0", "0 1 0"),
    ("wrist_flex", "0.15 0 0", "0 1 0"),
    ("wrist_roll", "0.05 0 0", "1 0 0"),
)

BOX = '<box size="0.04 0.04 0.04"/>'


def box_urdf(shape: str = BOX, lower: str = "-2.5", before: str = "", last: str = "wrist_roll") -> str:
    """Return the URDF of an arm of five joints with a gripper."""
    links = [_LINK.format(name="base", shape=shape)]
    joints = []
    parent = "base"
    for name, xyz, axis in (*_JOINTS[:-1], (last, *_JOINTS[-1][1:])):
        links.append(_LINK.format(name=f"{name}_link", shape=BOX))
        joints.append(_JOINT.format(name=name, parent=parent, child=f"{name}_link", xyz=xyz, axis=axis, lower=lower))
        parent = f"{name}_link"
    links.append(_LINK.format(name="finger", shape=BOX))
    joints.append(
        _JOINT.format(name="gripper", parent=parent, child="finger", xyz="0.03 0 0", axis="0 0 1", lower="-2.5")
    )
    links.append('<link name="gripper_frame_link"/>')
    joints.append(
        f'<joint name="tip" type="fixed"><parent link="{parent}"/><child link="gripper_frame_link"/>'
        '<origin xyz="0.08 0 0" rpy="0 1.5707963 0"/></joint>'
    )
    return f'<?xml version="1.0"?>{before}<robot name="box">{"".join(links)}{"".join(joints)}</robot>'


def box_card(**changes: object) -> dict[str, object]:
    """Return the card of a pair of these arms: that of the shipped pair, with another URDF."""
    return {**shipped_card("so101-pair").to_dict(), "name": "bench", "title": "My bench", **changes} | {
        "urdf": changes.get("urdf", {"path": "urdf/box.urdf"})
    }


def archive(files: Mapping[Name, bytes | str]) -> bytes:
    """Return a zip archive of files."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as whole:
        for name, content in files.items():
            whole.writestr(name, content)
    return packed.getvalue()
