"""Pleat plans how a robot can really fold a garment.

from planner import Scene, load_garment, make_plan

plan = make_plan(load_garment("t-shirt"), Scene())

Names are imported when they are first used: the values (`Plan`, `Task`, `Scene`) come without the compiled kernels that
planning needs.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from planner.kernel_cache import use_kernel_cache

if TYPE_CHECKING:
    from planner.cloth.garment import DrawnFold, Garment
    from planner.cloth.garment_files import load_garment, shipped_garment_names
    from planner.explain.garment_check import check_garment
    from planner.explain.suggestion import Suggestion
    from planner.explain.suggestions import suggestions
    from planner.folds.fold_sequence import FoldSequence, fold_dag
    from planner.motion.timeline import Sample, Timeline
    from planner.plans import find_plan, make_plan, quick_plan
    from planner.proposals.proposals import Proposal, propose_folds
    from planner.task.plan import Plan, PlanStep
    from planner.task.reason import Reason
    from planner.task.scene import Scene
    from planner.task.task import Limits, Task, TaskOptions
    from planner.task.world_state import WorldState

__all__ = [
    "DrawnFold",
    "FoldSequence",
    "Garment",
    "Limits",
    "Plan",
    "PlanStep",
    "Proposal",
    "Reason",
    "Sample",
    "Scene",
    "Suggestion",
    "Task",
    "TaskOptions",
    "Timeline",
    "WorldState",
    "check_garment",
    "find_plan",
    "fold_dag",
    "load_garment",
    "make_plan",
    "propose_folds",
    "quick_plan",
    "shipped_garment_names",
    "suggestions",
]

_HOMES = {
    "planner.cloth.garment": ("DrawnFold", "Garment"),
    "planner.cloth.garment_files": ("load_garment", "shipped_garment_names"),
    "planner.folds.fold_sequence": ("FoldSequence", "fold_dag"),
    "planner.explain.garment_check": ("check_garment",),
    "planner.plans": ("find_plan", "make_plan", "quick_plan"),
    "planner.proposals.proposals": ("Proposal", "propose_folds"),
    "planner.explain.suggestion": ("Suggestion",),
    "planner.explain.suggestions": ("suggestions",),
    "planner.motion.timeline": ("Sample", "Timeline"),
    "planner.task.plan": ("Plan", "PlanStep"),
    "planner.task.reason": ("Reason",),
    "planner.task.scene": ("Scene",),
    "planner.task.task": ("Limits", "Task", "TaskOptions"),
    "planner.task.world_state": ("WorldState",),
}
use_kernel_cache()
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> Any:  # noqa: ANN401
    """Import a name from the room where it lives."""
    if name not in _HOME_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOME_OF[name]), name)
