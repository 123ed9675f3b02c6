"""Solving a solved drawing again changes nothing, whatever led to it: undo and restarts do so."""

from dataclasses import replace

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from app.drawing.drawing import Corner, Crease, End
from app.drawing.solve import solve
from planner.geometry.pose import Point2
from tests.app.drawing.drawings import pulled, towel_drawing
from tests.laws.law import LONG

CORNERS_MAX = 7
FOLDS_MAX = 3

numbers = st.integers(0, 6)
shares = st.floats(0.05, 0.95)
pulls_m = st.floats(-0.03, 0.03)


class SolvedAgain(RuleBasedStateMachine):
    """A towel under random edits."""

    def __init__(self) -> None:
        super().__init__()
        self.solution = solve(towel_drawing())
        self.names = 0

    @rule(which=numbers, dx_m=pulls_m, dy_m=pulls_m)
    def pull_a_corner(self, which: int, dx_m: float, dy_m: float) -> None:
        drawing = self.solution.drawing
        self.solution = solve(pulled(drawing, which % len(drawing.outline), dx_m, dy_m))

    @precondition(lambda self: len(self.solution.drawing.outline) < CORNERS_MAX)
    @rule(which=numbers, share=shares)
    def add_a_corner(self, which: int, share: float) -> None:
        corners = self.solution.drawing.outline
        edge = which % len(corners)
        at = _between(corners[edge].point, corners[(edge + 1) % len(corners)].point, share)
        added = Corner(self.new_name(), at)
        self.solution = solve(
            replace(self.solution.drawing, outline=(*corners[: edge + 1], added, *corners[edge + 1 :]))
        )

    @precondition(lambda self: len(self.solution.drawing.outline) > 3)
    @rule(which=numbers)
    def remove_a_corner(self, which: int) -> None:
        corners = self.solution.drawing.outline
        index = which % len(corners)
        self.solution = solve(replace(self.solution.drawing, outline=(*corners[:index], *corners[index + 1 :])))

    @precondition(lambda self: self.solution.steps and len(self.solution.drawing.folds) < FOLDS_MAX)
    @rule(first=numbers, second=numbers, from_share=shares, to_share=shares, is_red=st.booleans())
    def draw_a_fold(self, first: int, second: int, from_share: float, to_share: float, is_red: bool) -> None:
        """Draw a fold from edge to edge of the cloth as it lies; drop it if it is illegal."""
        rings = self.solution.steps[-1]["flap" if is_red else "silhouette"]
        if not rings:
            return
        start, end = (_on(rings[0], *place) for place in ((first, from_share), (second, to_share)))
        fold = Crease(self.new_name(), "", "red" if is_red else "blue", End(start), End(end))
        drawing = self.solution.drawing
        drawn = solve(replace(drawing, folds=(*drawing.folds, fold)))
        self.solution = self.solution if drawn.problems else drawn

    @precondition(lambda self: self.solution.drawing.folds)
    @rule(which=numbers)
    def remove_a_fold(self, which: int) -> None:
        folds = self.solution.drawing.folds
        index = which % len(folds)
        self.solution = solve(replace(self.solution.drawing, folds=(*folds[:index], *folds[index + 1 :])))

    @precondition(lambda self: self.solution.drawing.folds)
    @rule(which=numbers)
    def paint_a_fold(self, which: int) -> None:
        folds = list(self.solution.drawing.folds)
        index = which % len(folds)
        folds[index] = replace(folds[index], kind="blue" if folds[index].is_red else "red")
        self.solution = solve(replace(self.solution.drawing, folds=tuple(folds)))

    @invariant()
    def is_the_same(self) -> None:
        again = solve(self.solution.drawing)
        assert again.drawing == self.solution.drawing
        assert again.problems == self.solution.problems

    def new_name(self) -> str:
        self.names += 1
        return f"n{self.names}"


def _on(ring: list[list[float]], edge: int, share: float) -> Point2:
    (ax, ay), (bx, by) = ring[edge % len(ring)], ring[(edge + 1) % len(ring)]
    return _between((ax, ay), (bx, by), share)


def _between(start: Point2, end: Point2, share: float) -> Point2:
    return start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])


is_long = settings.get_current_profile_name() == LONG
SolvedAgain.TestCase.settings = settings(
    max_examples=1000 if is_long else 15, stateful_step_count=50 if is_long else 25, derandomize=True
)
TestSolvedAgain = SolvedAgain.TestCase
