"""Compose one URDF from a card: its description on every mount, with the tools on it."""

from collections import Counter
from copy import deepcopy
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, tostring

from planner.errors import RobotError
from planner.robots.card_file import CardFile
from planner.robots.card_parts import Mount
from planner.robots.urdf_reader import locate, read_urdf

BASE_LINK = "pleat_base"
"""The composed URDF's root: the base frame."""


def composed_urdf(card: CardFile, folder: Path) -> str:
    """Return the URDF of a card's robot, its root the base frame, the paths of its meshes absolute.

    Args:
        card: the card.
        folder: the card's folder.

    Raises:
        RobotError: a URDF is missing or refused (see `planner.robots.urdf_reader`), or the link that a tool is fixed to
            is missing, or two links or joints have one name.
    """
    body = read_urdf(locate(card.urdf, folder, "urdf"), "urdf")
    for number, tool in enumerate(card.tools):
        field = f"tools[{number}]"
        links = {link.get("name") for link in body.findall("link")}
        if tool.link not in links:
            raise RobotError(f"{field}.link", f"there is no link {tool.link!r}")
        _join(body, read_urdf(locate(tool.urdf, folder, f"{field}.urdf"), f"{field}.urdf"), tool.link, tool.mount)
    whole = Element("robot", name=card.name)
    SubElement(whole, "link", name=BASE_LINK)
    for mount in card.mounts:
        _join(whole, deepcopy(body), BASE_LINK, mount)
    _drop_prefixed(whole)
    for tag in ("link", "joint"):
        ((twice, times),) = Counter(one.get("name") for one in whole.iterfind(tag)).most_common(1) or (("", 0),)
        if times > 1:
            raise RobotError("mounts", f"two {tag}s are called {twice!r}: mounts and tools need names of their own")
    return tostring(whole, encoding="unicode")


def _drop_prefixed(element: Element) -> None:
    """Drop elements and attributes with prefixes that nothing declares: they are another program's, and no XML."""
    for name in [name for name in element.attrib if ":" in name]:
        del element.attrib[name]
    for child in list(element):
        if ":" in child.tag:
            element.remove(child)
        else:
            _drop_prefixed(child)


def _join(whole: Element, part: Element, parent: str, mount: Mount) -> None:
    """Add a URDF's links and joints to another, prefixed by the mount's name, its root fixed to a link."""
    prefix = f"{mount.name}_" if mount.name else ""
    children = {child.get("link") for child in part.findall("joint/child")}
    roots = [link for link in part.findall("link") if link.get("name") not in children]
    if len(roots) != 1:
        raise RobotError("urdf", f"the URDF has {len(roots)} root links, not one")
    materials = {one.get("name") for one in whole.findall("material")}
    whole.extend(one for one in part.findall("material") if one.get("name") not in materials)
    joint = SubElement(whole, "joint", name=f"{parent}_carries_{prefix}{roots[0].get('name')}", type="fixed")
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=f"{prefix}{roots[0].get('name')}")
    place = (mount.x_m, mount.y_m, mount.z_m)
    turn = (mount.roll_rad, mount.pitch_rad, mount.yaw_rad)
    SubElement(joint, "origin", xyz=" ".join(map(repr, place)), rpy=" ".join(map(repr, turn)))
    for one in (*part.findall("link"), *part.findall("joint")):
        one.set("name", f"{prefix}{one.get('name')}")
        for tag, key in (("parent", "link"), ("child", "link"), ("mimic", "joint")):
            for reference in one.findall(tag):
                reference.set(key, f"{prefix}{reference.get(key)}")
        whole.append(one)
