"""URDFs of arms made of boxes, with grippers of two fingers that slide: nothing in them says which joints are what."""

_LINK = """<link name="{name}"><collision><origin xyz="{at}"/>
  <geometry><box size="{size}"/></geometry></collision></link>"""
_JOINT = """<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{at}"/>
  <axis xyz="{axis}"/><limit lower="{low}" upper="{high}" velocity="{speed}" effort="1"/></joint>"""

TOOL_AHEAD_M = 0.06 + 0.04 + 0.06
"""How far the fingertips are ahead of an arm's last joint (m): the hand, the fingers' place in it, their length."""


def arm(before: str, parent: str, y_m: float, z_m: float, *, fingers: str = "{}finger_{}", speed: float = 2.0) -> str:
    """Return the links and joints of an arm of six joints that hangs from a link, and of its gripper.

    At 0 it points straight up. Its fingers are 10 mm thick, touch at 0 and slide apart along x by 40 mm each.
    """
    joints = (
        ("pan", f"0 {y_m} {z_m}", "0 0 1"),
        ("lift", "0 0 0.08", "0 1 0"),
        ("bow", "0 0 0.35", "0 1 0"),
        ("bend", "0 0 0.3", "0 1 0"),
        ("tilt", "0 0 0.08", "1 0 0"),
        ("roll", "0 0 0.08", "0 0 1"),
    )
    sizes = (0.06, 0.31, 0.26, 0.05, 0.05, 0.06)
    made, inner = [], parent
    for (name, at, axis), size in zip(joints, sizes, strict=True):
        link = f"{before}{name}_part"
        numbers = {"low": -2.9, "high": 2.9, "speed": speed, "axis": axis}
        made.append(_JOINT.format(name=before + name, kind="revolute", parent=inner, child=link, at=at, **numbers))
        made.append(_LINK.format(name=link, at=f"0 0 {size / 2}", size=f"0.05 0.05 {size}"))
        inner = link
    for side, along in (("a", 1), ("b", -1)):
        link, numbers = f"{before}{side}_part", {"low": 0.0, "high": 0.04, "speed": 0.1, "axis": f"{along} 0 0"}
        name, at = fingers.format(before, side), "0 0 0.1"
        made.append(_JOINT.format(name=name, kind="prismatic", parent=inner, child=link, at=at, **numbers))
        made.append(_LINK.format(name=link, at=f"{along * 0.005} 0 0.03", size="0.01 0.02 0.06"))
    return "".join(made)


def pair_urdf() -> str:
    """Return a column on the floor, a lift that ends 1 cm over its foot, and two arms on it, the right one first."""
    column = _LINK.format(name="column", at="0 0 0.4", size="0.2 0.2 0.8")
    numbers = {"axis": "0 0 1", "low": 0.01, "high": 0.3, "speed": 0.1}
    lift = _JOINT.format(name="rise", kind="prismatic", parent="column", child="torso", at="0 0 0.8", **numbers)
    torso = _LINK.format(name="torso", at="0 0 0.05", size="0.2 0.2 0.1")
    arms = arm("r_", "torso", -0.25, 0.05) + arm("l_", "torso", 0.25, 0.05)
    return f'<robot name="pair">{column}{lift}{torso}{arms}</robot>'


def single_urdf(*, fingers: str = "{}slide_{}", speed: float = 2.0, before: str = "") -> str:
    """Return one arm on a plate."""
    plate = _LINK.format(name="plate", at="0 0 -0.01", size="0.1 0.1 0.02")
    return f'<robot name="one"{before}>{plate}{arm("", "plate", 0.0, 0.0, fingers=fingers, speed=speed)}</robot>'
