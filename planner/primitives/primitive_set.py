"""The set of primitives, by which the kinds of steps are found. It is open: write a file and add its class here."""

from planner.primitives.arm_drag import ArmDrag
from planner.primitives.base_move import BaseMove
from planner.primitives.g_drag import GDrag
from planner.primitives.g_fold import GFold
from planner.primitives.primitive import Primitive

PRIMITIVES: tuple[type[Primitive], ...] = (GFold, GDrag, ArmDrag, BaseMove)
"""The classes of all primitives."""
