"""The set of primitives. It is open: write a primitive's file and add its class here."""

from collections.abc import Callable

from planner.primitives.arm_drag import ArmDrag
from planner.primitives.base_move import BaseMove
from planner.primitives.context import Context
from planner.primitives.g_drag import GDrag
from planner.primitives.g_fold import GFold
from planner.primitives.primitive import Primitive

PRIMITIVES: tuple[Callable[[Context], Primitive], ...] = (GFold, GDrag, ArmDrag, BaseMove)
"""The constructors of all primitives."""
