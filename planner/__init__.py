"""Pleat plans how a robot can really fold a garment.

from planner import Scene, load_garment, make_plan

plan = make_plan(load_garment("t-shirt"), Scene())
"""

from planner.cloth.garment import Garment
from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.folds.fold_sequence import FoldSequence, fold_dag
from planner.plan.garment_check import check_garment
from planner.plan.make_plan import make_plan, quick_plan
from planner.plan.plan import Plan
from planner.plan.suggestions import suggestions
from planner.task.scene import Scene

__all__ = [
    "FoldSequence",
    "Garment",
    "Plan",
    "Scene",
    "check_garment",
    "fold_dag",
    "load_garment",
    "make_plan",
    "quick_plan",
    "shipped_garment_names",
    "suggestions",
]
