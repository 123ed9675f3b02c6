"""Detect a red fold's line that crosses the cloth, but not the layers that a red fold takes."""

from planner.cloth.cloth_state import ClothState
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.geometry.segment import Segment


def is_flap_missed(cloth: ClothState, line: Segment) -> bool:
    """Return whether a line runs through cloth, but through nothing that the last fold moved."""
    flap, whole = FOLD_KINDS["red"].silhouette(cloth), cloth.silhouette
    return whole.runs_inside(line) and not flap.runs_inside(line)


def flap_missed(name: str) -> str:
    """Return the message about such a line, given the name of the fold before it, if it has one."""
    before = f"'{name}'" if name else "the fold before it"
    return f"the line crosses the cloth, but not the flap of {before}, which is all that a red fold takes"
